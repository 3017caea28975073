#include "api/render.h"

#include <utility>

#include "api/automatic.h"
#include "api/comparison.h"
#include "api/film_keeper.h"
#include "api/render_plan.h"
#include "render/shared_samples.h"

namespace montelux {

namespace {

// Of the scene, without the files that its renders write.
std::uint64_t fingerprint_of(const LoadedScene::Parts& parts, const RenderOptions& options) {
  std::vector<std::string> written;
  const auto add = [&](const std::filesystem::path& file) { written.push_back(file.filename().string()); };
  add(parts.info.picture_file);
  for (const auto& file : options.files.paths) add(file);
  if (options.checkpoint) add(options.checkpoint->file);
  return scene_fingerprint(parts.info.file, parts.load.environment, written);
}

// Over all tiles.
std::size_t passes_in(const Film& film) {
  std::size_t passes = 0;
  for (const auto& [index, tile] : film.tiles()) passes += tile.passes.size();
  return passes;
}

// Saves the snapshots of a film in a file, and reports the first failure to the user.
class Checkpoint {
 public:
  Checkpoint(const FilmCheckpoint& checkpoint, const SavedFilm& film, RenderObserver& observer)
      : checkpoint_(checkpoint), film_(film), observer_(observer) {}
  FilmKeeping keeping() {
    return {checkpoint_.every, [this](FilmSnapshot snapshot) { save(std::move(snapshot)); }};
  }
  // Of the last snapshot.
  const Status& status() const { return status_; }

 private:
  void save(FilmSnapshot snapshot) {
    snapshot.seconds += film_.begun.seconds;
    const bool was_saved(status_);
    status_ = save_snapshot(checkpoint_.file, film_, snapshot);
    if (!status_ && was_saved) observer_.announce(status_.error());
  }

  const FilmCheckpoint& checkpoint_;
  const SavedFilm& film_;
  RenderObserver& observer_;
  Status status_{Done{}};
};

}  // namespace

SavedFilm description_of(const LoadedScene::Parts& parts, const RenderPlan& plan, const RenderOptions& options) {
  const ImageSettings& image = plan.settings.image;
  const PassPlan& passes = plan.settings.plan;
  LoadOptions load = parts.load;
  load.resolution = {image.width, image.height}, load.resolution_scale.reset();
  SavedFilm film{std::filesystem::absolute(parts.info.file),
                 load,
                 fingerprint_of(parts, options),
                 {plan.integrator_text, std::string(name_of(image.sampler)),
                  options.all_layers() ? to_text(*options.all_layers()) : "", image.seed, passes.samples_per_pass,
                  image.width, image.height, image.bounds, filters_share_samples(image, plan.chosen.any())},
                 options,
                 {},
                 facts_of(parts, plan, plan.settings),
                 {Film({}), {}, 0}};
  const bool has_number = !options.target || (options.resume && options.passes);
  if (!options.seconds && has_number) film.wanted = PassRange{passes.first_pass, passes.first_pass + passes.passes - 1};
  return film;
}

Result<Rendering> render_scene(const LoadedScene& scene, const RenderOptions& options, RenderObserver& observer) {
  const LoadedScene::Parts& parts = scene.parts();
  Result<RenderPlan> plan = plan_render(parts, options);
  if (!plan) return plan.failure();
  if (Status good = choose_automatically(parts, *plan, observer); !good) return good.failure();
  if (!options.checkpoint && !options.resume) return render_picture(parts, *plan, plan->settings, observer);

  if (options.budget) return Failure{"a picture within a time budget is not saved, and continues no saved film"};
  RenderSettings settings = plan->settings;
  SavedFilm film = description_of(parts, *plan, options);
  std::optional<std::size_t> begun_passes;
  if (options.resume) {
    if (Status good = check_continues(*options.resume, film); !good) return good.failure();
    begun_passes = passes_in(options.resume->begun.film);
    settings.begun = &options.resume->begun;
    film.adaptive = options.resume->adaptive;
  }
  std::optional<Checkpoint> checkpoint;
  if (options.checkpoint) {
    checkpoint.emplace(*options.checkpoint, film, observer);
    settings.keeping = checkpoint->keeping();
  }
  Rendering rendering = render_picture(parts, *plan, std::move(settings), observer, &film);
  if (checkpoint) rendering.saved = checkpoint->status();
  if (begun_passes == passes_in(rendering.result.film) && !rendering.result.interrupted)
    rendering.notes.push_back("the saved film has all of this already: no pass was added");
  return rendering;
}

}  // namespace montelux
