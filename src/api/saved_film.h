// Films in files: renders that are interrupted and resumed, cut into ranges of passes, and merged.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "api/render.h"

namespace montelux {

// What a picture is, besides its film: what its header and its notes state.
struct PictureFacts {
  std::string scene, integrator, sampler;
  std::uint32_t seed = 0;
  int samples_per_pass = 1;
  std::vector<std::string> biases, notes, missing, left_out;
  std::vector<Replacement> replaced;
  Content content = Content::light;
  bool states_exposure = false;
  bool shared_filters = false;  // as FilmSettings has it
  std::optional<LayerPlan> layers;
  std::optional<TargetRequest> target{};
  std::optional<AutomaticChoice> choice{};
  Rgb max_chance_radiance{};  // as Film has it
};

// What decides the passes of a film, besides its scene. Films can only be continued or merged where all of it agrees.
struct FilmSettings {
  std::string integrator;  // with its settings
  std::string sampler, layers;
  std::uint32_t seed = 0;
  int samples_per_pass = 1, width = 0, height = 0;
  PixelBounds crop;
  bool shared_filters = false;  // samples count for all pixels whose filters contain them
};

// How the passes of an adaptive film are divided among its tiles.
struct AdaptiveFilm {
  int first_passes = 0;        // which all tiles have, and which decide the shares
  std::vector<double> shares;  // of the tiles, in their order, as AdaptivePlan has them; empty until they are decided
};

// A film in a file: what it is of, its passes, and what has been requested.
struct SavedFilm {
  std::filesystem::path scene;
  LoadOptions load;
  std::uint64_t fingerprint = 0;  // of the scene's files
  FilmSettings settings;
  RenderOptions options;            // those that decide the settings, as they were given
  std::optional<PassRange> wanted;  // passes; none where a time was set
  PictureFacts facts;
  BegunFilm begun;
  std::optional<AdaptiveFilm> adaptive{};  // none: all tiles have the same passes
};

// Fails where the file is damaged or no saved film.
Result<SavedFilm> load_film(const std::filesystem::path& file);
Status save_film(const std::filesystem::path& file, const SavedFilm& film);
// Whether the file claims to be a saved film.
bool is_saved_film(const std::filesystem::path& file);
// Why a film could not be saved to this file: its name is that of a picture or a scene, there is a file of another
// kind, or it cannot be written. To be called before a render, so that the work is not lost.
Status check_film_file(const std::filesystem::path& file);

// Options that a saved film decides and that are not given take its values.
void take_options(const SavedFilm& film, LoadOptions& load, RenderOptions& options);

// The film of all passes. Fails where scenes or settings differ, or where two films have the same pass; `names` are
// those of the files, for messages.
Result<SavedFilm> merge_films(std::vector<SavedFilm> films, const std::vector<std::string>& names);

// The picture of a film, without its scene.
Rendering rendering_of(SavedFilm film);

}  // namespace montelux
