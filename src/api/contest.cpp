#include "api/contest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "api/checksum.h"
#include "api/compare.h"
#include "api/parts.h"
#include "api/render.h"
#include "image/output_file.h"
#include "integrator/catalogue.h"
#include "lab/compare/report.h"
#include "lab/report/write.h"

namespace montelux {

namespace {

namespace fs = std::filesystem;

// A method as it was typed: the integrator and the point set.
struct MethodText {
  ChoiceText integrator;
  std::optional<PointSetKind> sampler;
};

Result<MethodText> read_method(const std::string& text) {
  auto choice = parse_choice(text);
  if (!choice) return choice.failure();
  MethodText method{*choice, {}};
  std::erase_if(method.integrator.settings, [](const Setting& s) { return s.first == "sampler"; });
  for (const auto& [name, value] : choice->settings) {
    if (name != "sampler") continue;
    method.sampler = point_set_named(value);
    if (method.sampler) continue;
    std::vector<std::string_view> names;
    const auto samplers = sampler_names();
    for (const auto& [known, description] : samplers) names.push_back(known);
    return unknown_name("sampler", value, names);
  }
  if (Status known = check_integrator(method.integrator); !known) return known.failure();
  return method;
}

// The families of layers that variance is attributed to.
LayerPlan attribution_layers(const Scene& scene) {
  LayerPlan plan;
  plan.bounces = 4;
  plan.techniques = true;
  plan.group_of_light = scene.lights.groups();
  plan.group_names = scene.lights.group_names();
  plan.light_groups = !plan.group_names.empty();
  return plan;
}

// The methods of one comparison with all that they need.
struct Field {
  std::vector<ChosenIntegrator> integrators;
  std::vector<lab::Contestant> contestants;
};

Result<Field> make_field(const LoadedScene::Parts& parts, const ContestOptions& options) {
  Field field;
  for (const std::string& text : options.methods) {
    auto method = read_method(text);
    if (!method) return method.failure();
    auto chosen = choose_integrator(
        method->integrator,
        {parts.picture.max_depth, parts.picture.max_component, parts.picture.width, parts.picture.height}, parts.scene,
        *parts.accel);
    if (!chosen) return Failure{text + ": " + chosen.error()};
    const PointSetKind sampler = method->sampler.value_or(parts.picture.sampler);
    note_sampler(*chosen, sampler);
    field.integrators.push_back(*std::move(chosen));
    lab::Contestant contestant;
    contestant.label = std::string(1, char('a' + int(field.contestants.size())));
    contestant.text = text;
    contestant.integrator = field.integrators.back().any();
    contestant.sampler = sampler;
    contestant.biases = field.integrators.back().biases;
    const PixelIntegrator* pixels = contestant.integrator.pixel();
    if (options.attribution && pixels && pixels->has_layers()) contestant.layers = attribution_layers(parts.scene);
    field.contestants.push_back(std::move(contestant));
  }
  return field;
}

// Who may make the reference: the unbiased methods; where there are none, all of them if their biases are alike.
Result<std::vector<std::size_t>> who_may_serve(const std::vector<lab::Contestant>& contestants) {
  std::vector<std::size_t> unbiased, all;
  bool alike = true;
  for (std::size_t i = 0; i < contestants.size(); ++i) {
    all.push_back(i);
    if (contestants[i].biases.empty()) unbiased.push_back(i);
    alike = alike && contestants[i].biases == contestants.front().biases;
  }
  if (!unbiased.empty()) return unbiased;
  if (alike) return all;
  return Failure{
      "every method is biased, each in another way, so none of them can make the reference; name one by --reference"};
}

Result<lab::Reference> read_reference(const fs::path& file, const PixelBounds& bounds) {
  auto picture = read_estimate({file, {}, {}});
  if (!picture) return picture.failure();
  if (picture->color.width != bounds.width() || picture->color.height != bounds.height())
    return Failure{fmt::format("{}: the reference has {} x {} pixels, the picture {} x {}", file.string(),
                               picture->color.width, picture->color.height, bounds.width(), bounds.height())};
  lab::Reference reference;
  reference.mean = picture->color;
  reference.variance = make_pixel_buffer(bounds.width(), bounds.height(), {"R", "G", "B"});
  reference.origin = file.string();
  reference.degrees_of_freedom = std::numeric_limits<double>::infinity();
  if (picture->bars) {
    for (std::size_t i = 0; i < reference.variance.values.size(); ++i)
      reference.variance.values[i] = picture->bars->standard_error.values[i] * picture->bars->standard_error.values[i];
    reference.degrees_of_freedom = picture->bars->degrees_of_freedom;
    if (const auto& error = picture->bars->error_of_mean) {
      reference.variance_of_image.emplace();
      for (std::size_t c = 0; c < 3; ++c) (*reference.variance_of_image)[c] = std::pow(double(error->values[c]), 2);
    }
  }
  return reference;
}

// ---- the cache of references ----------------------------------------------------------------------------------------

// What the picture is of, of all that the scene's files may hold.
std::string view_of(const LoadOptions& load) {
  return fmt::format(
      "camera {}, animation {}, shutter {}, lenient {}", load.camera.value_or("-"), load.animation.value_or("-"),
      load.shutter ? fmt::format("{} to {}", load.shutter->open, load.shutter->close) : "-", load.lenient);
}

// Changes with any file beside the scene or below, with the camera, the moment and the size of the picture, and with
// what biases it.
std::uint64_t scene_hash(const LoadedScene::Parts& parts, const PixelBounds& b, const std::string& biases) {
  std::vector<std::string> files;
  std::error_code ignored;
  const fs::path folder = fs::absolute(parts.info.file, ignored).parent_path();
  for (const auto& entry :
       fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, ignored)) {
    if (!entry.is_regular_file(ignored)) continue;
    files.push_back(fmt::format("{} {} {}", entry.path().string(), entry.file_size(ignored),
                                entry.last_write_time(ignored).time_since_epoch().count()));
    if (files.size() > 20000) break;
  }
  std::ranges::sort(files);
  const std::string what =
      fmt::format("{}\n{} {} {} {} {} {} {}\n{}\n{}{}", fmt::join(files, "\n"), parts.info.file, parts.picture.width,
                  parts.picture.height, b.x0, b.y0, b.x1, b.y1, view_of(parts.load), version(), biases);
  return checksum(what);
}

std::optional<fs::path> cache_folder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return fs::path(cache) / "montelux";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache/montelux";
  return std::nullopt;
}

void keep_reference(const fs::path& file, const lab::Reference& reference) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) return;
  PixelBuffer picture = reference.mean, bars = reference.variance;
  for (float& v : bars.values) v = std::sqrt(v);
  append_layer(picture, "stderr", bars);
  std::vector<Attribute> header{{"montelux:passes", std::int32_t(reference.degrees_of_freedom) + 1}};
  for (std::size_t c = 0; reference.variance_of_image && c < 3; ++c) {
    double mean = 0;
    for (std::size_t p = c; p < reference.mean.values.size(); p += 3) mean += double(reference.mean.values[p]);
    header.push_back({fmt::format("montelux:mean{}", "RGB"[c]), mean / double(reference.mean.pixel_count())});
    header.push_back(
        {fmt::format("montelux:meanStandardError{}", "RGB"[c]), std::sqrt((*reference.variance_of_image)[c])});
  }
  // A cache that cannot be written only costs time later.
  if (Status kept = write_image(file, picture, {std::move(header), {}}); !kept) return;
}

// The kept reference if it is as good as asked for.
std::optional<lab::Reference> kept_reference(const fs::path& file, const PixelBounds& bounds) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  auto reference = read_reference(file, bounds);
  if (!reference) return std::nullopt;
  return *reference;
}

// How many times the time, in whole numbers where there are many.
std::string times_text(double times) {
  if (!std::isfinite(times)) return "many";
  return times < 10 ? fmt::format("{:.2g}", times) : fmt::format("{:.0f}", times);
}

}  // namespace

namespace {

// "a is 2.31 times as efficient as b (95 % between 2.10 and 2.55)", or that nothing is decided.
std::string sentence_of_ratio(const Contest& contest, const lab::PairVerdict& v, double confidence) {
  const std::string& a = contest.result.methods[v.first].contestant.label;
  const std::string& b = contest.result.methods[v.second].contestant.label;
  const bool first_wins = v.ratio.mean >= 1;
  const double factor = first_wins ? v.ratio.mean : 1 / v.ratio.mean;
  const double low = first_wins ? v.ratio.low : 1 / v.ratio.high, high = first_wins ? v.ratio.high : 1 / v.ratio.low;
  const std::string interval = fmt::format("{:g} % between {:.3g} and {:.3g}", 100 * confidence, low, high);
  if (!contest.refusal.empty()) return fmt::format("{} and {}: no verdict by this reference", a, b);
  if (v.ratio.count < 2) return fmt::format("{} and {}: not decided, there are too few repeats", a, b);
  if (!v.decided)
    return fmt::format(
        "{} and {}: not decided: the ratio of efficiencies is {:.3g} ({}); {} times the time may decide it", a, b,
        factor, interval, times_text(v.times_longer));
  const bool biased = lab::differs_from_reference(contest.result.methods[v.first]) ||
                      lab::differs_from_reference(contest.result.methods[v.second]);
  const lab::Measured& relative = v.relative_ratio;
  const double by_relative = first_wins ? relative.mean : 1 / relative.mean;
  return fmt::format("{} is {:.3g} times as efficient as {} ({}), by relMSE {:.3g} times{}", first_wins ? a : b, factor,
                     first_wins ? b : a, interval, by_relative,
                     biased ? "; one of them is biased, so this holds for this time alone" : "");
}

}  // namespace

std::string sentence_of(const Contest& contest, const lab::PairVerdict& v, double confidence) {
  const std::string sentence = sentence_of_ratio(contest, v, confidence);
  const lab::MethodResult &a = contest.result.methods[v.first], &b = contest.result.methods[v.second];
  if (contest.result.warm_up_counts || !contest.refusal.empty() || v.ratio.count < 2) return sentence;
  std::string warmed;
  for (const lab::MethodResult* m : {&a, &b})
    if (m->warm_up.mean > 0) warmed += (warmed.empty() ? "" : " and ") + m->contestant.label;
  if (warmed.empty()) return sentence;
  const bool first_wins = v.ratio.mean >= 1;
  const lab::Measured& whole = v.whole_ratio;
  return fmt::format("{}; the warm-up of {} is not counted: with it {:.3g} times (between {:.3g} and {:.3g})", sentence,
                     warmed, first_wins ? whole.mean : 1 / whole.mean, first_wins ? whole.low : 1 / whole.high,
                     first_wins ? whole.high : 1 / whole.low);
}

Status write_contest(const std::filesystem::path& file, const Contest& contest, const std::string& scene,
                     double confidence, const std::vector<std::string>& commands) {
  lab::ContestWords words;
  words.scene = "`" + scene + "`";
  for (const lab::PairVerdict& v : contest.result.verdicts)
    words.sentences.push_back(sentence_of(contest, v, confidence));
  if (!contest.refusal.empty()) words.notes.push_back(contest.refusal);
  if (!contest.result.warm_up_counts)
    words.notes.push_back(
        "frames of a sequence: where a method has frames of warm-up, these have been shown anyway, and seconds and "
        "efficiencies are without their time, unless another is said");
  if (contest.saved.options.processor_time)
    words.notes.push_back("seconds are those of all threads together on processors");
  words.notes.insert(words.notes.end(), contest.notes.begin(), contest.notes.end());
  words.commands = commands;
  Result<std::string> page = lab::to_html(lab::report_of(contest.result, words));
  if (!page) return page.failure();
  return write_file(file, *page);
}

Status check_methods(const std::vector<std::string>& methods) {
  for (const std::string& text : methods)
    if (auto method = read_method(text); !method) return Failure{text + ": " + method.error()};
  return Done{};
}

namespace {

Result<lab::ContestSettings> settings_of(const LoadedScene::Parts& parts, const ContestOptions& options) {
  lab::ContestSettings settings;
  RenderSettings& r = settings.render;
  r.width = parts.picture.width, r.height = parts.picture.height;
  r.bounds = options.crop.value_or(parts.picture.crop);
  const PixelBounds& b = r.bounds;
  if (b.x0 < 0 || b.y0 < 0 || b.x1 > r.width || b.y1 > r.height || b.x0 >= b.x1 || b.y0 >= b.y1)
    return Failure{fmt::format("the crop is not inside the picture of {} x {} pixels", r.width, r.height)};
  r.seed = options.seed, r.threads = options.threads;
  r.warm_up_counts = !options.warm_frames;
  if (options.processor_time) r.clock = processor_seconds;
  settings.slopes = options.slopes;
  settings.seconds = options.seconds;
  settings.samples = options.samples.value_or(settings.samples);
  settings.repeats = options.repeats;
  settings.confidence = options.confidence;
  return settings;
}

// The reference that was named, or kept, or one that is made now. What is to be said of it goes to `notes`.
Result<lab::Reference> find_reference(const LoadedScene::Parts& parts, const ContestOptions& options,
                                      const std::vector<lab::Contestant>& contestants,
                                      const lab::ContestSettings& settings, const lab::ContestWatch& watch,
                                      std::vector<std::string>& notes) {
  const PixelBounds& b = settings.render.bounds;
  if (options.reference) return read_reference(*options.reference, b);
  auto serve = who_may_serve(contestants);
  if (!serve) return serve.failure();
  std::string biases;
  for (const std::string& bias : contestants[serve->front()].biases) biases += bias + ";";
  const auto folder = options.cache ? cache_folder() : std::nullopt;
  const fs::path file =
      folder ? *folder / fmt::format("reference-{:016x}.exr", scene_hash(parts, b, biases)) : fs::path();
  constexpr double wanted_share = 0.05;
  const double goal_mse = lab::expected_smallest_mse(contestants, settings, watch) * wanted_share;
  if (folder)
    if (auto kept = kept_reference(file, b); kept && lab::mean_value(kept->variance) <= goal_mse) {
      notes.push_back("the reference was kept from an earlier comparison: " + file.string());
      return *std::move(kept);
    }
  lab::Reference made = lab::make_reference(contestants, *serve, settings, goal_mse, watch);
  if (folder && !(watch.stop && watch.stop())) keep_reference(file, made);
  return made;
}

// What is to be said once all rounds are done.
void conclude(Contest& contest, const std::vector<lab::Contestant>& contestants, const lab::ContestSettings& settings,
              bool interrupted) {
  contest.result = lab::result_of(contestants, contest.saved.state, settings);
  contest.result.interrupted = interrupted;
  contest.notes = contest.saved.notes;
  if (contest.result.reference_share > largest_reference_share)
    contest.refusal = fmt::format(
        "the reference's own variance is {:.0f} % of the smallest mean squared error (at most {:.0f} % is right): it "
        "would decide the comparison; it needs {:.1f} times its samples",
        100 * contest.result.reference_share, 100 * largest_reference_share,
        contest.result.reference_share / largest_reference_share);
  for (const lab::Contestant& c : contestants)
    if (!c.biases.empty())
      contest.notes.push_back(fmt::format("{} ({}) is biased: {}", c.label, c.text, fmt::join(c.biases, ", ")));
  for (const lab::Contestant& c : contestants)
    if (contest.saved.options.attribution && !c.layers)
      contest.notes.push_back(fmt::format(
          "{} ({}) does not part its light into layers, so its variance is not attributed", c.label, c.text));
}

// Frames that are not to count must be there.
Status check_warm_up(const std::vector<lab::Contestant>& contestants, const ContestOptions& options) {
  const auto warms_up = [](const lab::Contestant& c) {
    return c.integrator.coupled() && c.integrator.coupled()->warm_up() > 0;
  };
  if (!options.warm_frames || std::ranges::any_of(contestants, warms_up)) return Done{};
  return Failure{
      "no method has frames of warm-up whose time might not count: restir-di:chain=1,warm-up=12 has, for one"};
}

// Seconds of one repeat of one method; none where that is not known.
std::optional<double> seconds_of_repeat(const lab::ContestState& state, const lab::ContestSettings& settings) {
  if (settings.seconds) return *settings.seconds / settings.repeats;
  double sum = 0, repeats = 0;
  for (const lab::MethodState& m : state.methods)
    for (const lab::Repeat& r : m.repeats) sum += r.seconds, repeats += 1;
  if (!(sum > 0)) return std::nullopt;
  return sum / repeats;
}

}  // namespace

Result<Contest> compare_methods(const LoadedScene& scene, const ContestOptions& options,
                                const lab::ContestWatch& watch) {
  auto field = make_field(scene.parts(), options);
  if (!field) return field.failure();
  if (Status warm = check_warm_up(field->contestants, options); !warm) return warm.failure();
  auto settings = settings_of(scene.parts(), options);
  if (!settings) return settings.failure();
  Contest contest;
  contest.saved.options = options;
  auto reference = find_reference(scene.parts(), options, field->contestants, *settings, watch, contest.saved.notes);
  if (!reference) return reference.failure();
  contest.saved.state = lab::begin_contest(field->contestants, *std::move(reference), *settings);
  const bool whole = lab::run_rounds(field->contestants, *settings, settings->repeats, watch, contest.saved.state);
  conclude(contest, field->contestants, *settings, !whole);
  return contest;
}

Result<Contest> continue_contest(const LoadedScene& scene, SavedContest saved, const ContestBudget& more,
                                 const lab::ContestWatch& watch) {
  auto field = make_field(scene.parts(), saved.options);
  if (!field) return field.failure();
  auto settings = settings_of(scene.parts(), saved.options);
  if (!settings) return settings.failure();
  const PixelBounds& b = settings->render.bounds;
  if (saved.state.reference.mean.width != b.width() || saved.state.reference.mean.height != b.height() ||
      saved.state.methods.size() != field->contestants.size())
    return Failure{"the saved comparison does not fit the scene: it has other sizes"};
  for (std::size_t i = 0; i < field->contestants.size(); ++i) {
    const auto& layers = field->contestants[i].layers;
    const auto& shares = saved.state.methods[i].pixel_shares;
    if (!shares.empty() && (!layers || shares.size() != std::size_t(layers->count()) + 1))
      return Failure{"the saved comparison does not fit the scene: its variance was attributed to other layers"};
  }
  int rounds = more.repeats.value_or(settings->repeats);
  if (more.seconds) {
    const std::optional<double> one = seconds_of_repeat(saved.state, *settings);
    if (!one)
      return Failure{
          "the saved comparison has no repeat that tells how long one takes: give --repeats, and not --time"};
    rounds = int(std::clamp(std::round(*more.seconds / *one), 1.0, 1e6));
  }
  Contest contest;
  contest.saved = std::move(saved);
  const bool whole = lab::run_rounds(field->contestants, *settings, rounds, watch, contest.saved.state);
  conclude(contest, field->contestants, *settings, !whole);
  return contest;
}

}  // namespace montelux
