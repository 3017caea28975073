// Films in files: a line of JSON, which says what the film is of, and the film's bytes (docs/formats.md).
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "api/film_keeper.h"
#include "api/saved_film.h"
#include "api/saved_scene.h"
#include "api/target_text.h"
#include "film/film_bytes.h"

namespace montelux {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Texts = std::vector<std::string>;

constexpr SavedFormat saved_format{"montelux film", 1, "montelux render --checkpoint", "film"};

Json bounds_json(const PixelBounds& b) { return {b.x0, b.y0, b.x1, b.y1}; }
PixelBounds bounds_from(const Json& j) {
  return {side_from(j.at(0)), side_from(j.at(1)), side_from(j.at(2)), side_from(j.at(3))};
}

Json settings_json(const FilmSettings& s) {
  return {{"integrator", s.integrator},
          {"sampler", s.sampler},
          {"seed", s.seed},
          {"samples_per_pass", s.samples_per_pass},
          {"resolution", {s.width, s.height}},
          {"crop", bounds_json(s.crop)},
          {"layers", s.layers},
          {"filter_samples", s.shared_filters ? "shared" : "own"}};
}
FilmSettings settings_from(const Json& j) {
  FilmSettings s;
  s.integrator = j.at("integrator"), s.sampler = j.at("sampler"), s.layers = j.at("layers");
  s.seed = whole_from<std::uint32_t>(j.at("seed"), 0, std::numeric_limits<std::uint32_t>::max());
  s.samples_per_pass = whole_from(j.at("samples_per_pass"), 1, int(max_film_samples));
  s.width = side_from(j.at("resolution").at(0)), s.height = side_from(j.at("resolution").at(1));
  s.crop = bounds_from(j.at("crop"));
  s.shared_filters = j.value("filter_samples", "own") == "shared";  // those of older versions are not
  const PixelBounds& b = s.crop;
  if (!check_resolution(s.width, s.height) || b.x0 >= b.x1 || b.y0 >= b.y1 || b.x1 > s.width || b.y1 > s.height)
    throw std::invalid_argument("its settings are damaged");
  return s;
}

Json target_json(const TargetRequest& target) {
  return {{"error", to_text(target.error)}, {"confidence", target.error.confidence}, {"unbiased", target.unbiased}};
}
TargetRequest target_from(const Json& j) {
  const Result<ErrorTarget> error = parse_target(j.at("error").get<std::string>());
  TargetRequest target;
  if (error) target.error = *error;
  target.error.confidence = j.at("confidence"), target.unbiased = j.at("unbiased");
  if (!error || !(target.error.confidence > 0 && target.error.confidence < 1))
    throw std::invalid_argument("its requested error is damaged");
  return target;
}

Json options_json(const RenderOptions& o) {
  return {{"integrator", or_null<Json>(o.integrator)},
          {"settings", o.settings},
          {"preset", or_null<Json>(o.preset)},
          {"sampler", or_null<Json>(o.sampler)},
          {"crop", o.crop ? bounds_json(*o.crop) : Json()},
          {"layers", o.all_layers() ? Json(to_text(*o.all_layers())) : Json()},
          {"target", o.target ? target_json(*o.target) : Json()}};
}
RenderOptions options_from(const Json& j) {
  RenderOptions o;
  o.integrator = optional_at<std::string>(j, "integrator"), o.preset = optional_at<std::string>(j, "preset");
  o.settings = j.at("settings").get<decltype(o.settings)>(), o.sampler = optional_at<std::string>(j, "sampler");
  if (const Json& crop = j.at("crop"); !crop.is_null()) o.crop = bounds_from(crop);
  if (const Json& layers = j.at("layers"); !layers.is_null()) {
    const Result<LayerRequest> request = parse_layers(layers.get<std::string>());
    if (!request) throw std::invalid_argument("its layers are damaged");
    o.layers = *request;
  }
  // Films of older versions have none.
  if (const auto target = j.find("target"); target != j.end() && !target->is_null()) o.target = target_from(*target);
  return o;
}

Json layers_json(const LayerPlan& plan) {
  return {{"bounces", or_null<Json>(plan.bounces)},
          {"light_groups", plan.light_groups},
          {"strategies", or_null<Json>(plan.strategies)},
          {"mergings", plan.mergings},
          {"alone", plan.alone},
          {"errors", plan.spread},
          {"groups", plan.group_names}};
}
LayerPlan layers_from(const Json& j) {
  LayerPlan plan;
  if (const Json& bounces = j.at("bounces"); !bounces.is_null()) plan.bounces = whole_from(bounces, 0, 1 << 10);
  // Films of older versions have no strategies.
  if (const auto strategies = j.find("strategies"); strategies != j.end() && !strategies->is_null())
    plan.strategies = whole_from(*strategies, 0, 16), plan.mergings = j.at("mergings"), plan.alone = j.at("alone");
  plan.light_groups = j.at("light_groups"), plan.spread = j.at("errors");
  plan.group_names = j.at("groups").get<Texts>();
  return plan;
}

Json choice_json(const AutomaticChoice& choice) {
  Json ratios = Json::array();
  for (const auto& r : choice.ratios) ratios.push_back({r.integrator, r.ratio, r.low, r.high});
  return {{"integrator", choice.integrator}, {"reason", choice.reason}, {"share", choice.share}, {"ratios", ratios}};
}
AutomaticChoice choice_from(const Json& j) {
  AutomaticChoice choice{j.at("integrator"), j.at("reason"), j.at("share"), {}};
  for (const Json& r : j.at("ratios")) choice.ratios.push_back({r.at(0), r.at(1), r.at(2), r.at(3)});
  return choice;
}

Json facts_json(const PictureFacts& f) {
  Json replaced = Json::array();
  for (const Replacement& r : f.replaced) replaced.push_back({r.family, r.name, r.by});
  return {{"scene", f.scene},
          {"integrator", f.integrator},
          {"sampler", f.sampler},
          {"biases", f.biases},
          {"notes", f.notes},
          {"missing_light", f.missing},
          {"left_out", f.left_out},
          {"replaced", replaced},
          {"content", content_names[std::size_t(f.content)]},
          {"states_exposure", f.states_exposure},
          {"layers", f.layers ? layers_json(*f.layers) : Json()},
          {"choice", f.choice ? choice_json(*f.choice) : Json()},
          {"max_chance_radiance", f.max_chance_radiance.c}};
}
PictureFacts facts_from(const Json& j, const FilmSettings& settings) {
  PictureFacts f;
  f.scene = j.at("scene"), f.integrator = j.at("integrator"), f.sampler = j.at("sampler");
  f.seed = settings.seed, f.samples_per_pass = settings.samples_per_pass;
  f.biases = j.at("biases").get<Texts>(), f.notes = j.at("notes").get<Texts>();
  f.missing = j.at("missing_light").get<Texts>(), f.left_out = j.at("left_out").get<Texts>();
  for (const Json& r : j.at("replaced")) f.replaced.push_back({r.at(0), r.at(1), r.at(2)});
  const auto content = std::ranges::find(content_names, j.at("content").get<std::string>());
  if (content == std::end(content_names)) throw std::invalid_argument("the content of its picture is damaged");
  f.content = Content(content - std::begin(content_names));
  f.states_exposure = j.at("states_exposure"), f.shared_filters = settings.shared_filters;
  if (const Json& layers = j.at("layers"); !layers.is_null()) f.layers = layers_from(layers);
  // Films of older versions have none.
  if (const auto choice = j.find("choice"); choice != j.end() && !choice->is_null()) f.choice = choice_from(*choice);
  if (const auto radiance = j.find("max_chance_radiance"); radiance != j.end())
    for (std::size_t c = 0; c < rgb_size; ++c) {
      const double channel = radiance->at(c);
      if (!(channel >= 0 && channel <= double(std::numeric_limits<float>::max())))
        throw std::invalid_argument("the radiance that its paths meet by chance is damaged");
      f.max_chance_radiance.c[c] = float(channel);
    }
  return f;
}

Json rays_json(const RayCounts& r) {
  return {{"camera", r.camera}, {"scattered", r.scattered}, {"shadow", r.shadow}, {"by_depth", r.by_depth}};
}
RayCounts rays_from(const Json& j) {
  const auto count = [](const Json& n) { return whole_from<std::uint64_t>(n, 0, std::uint64_t(1) << 60); };
  RayCounts r;
  r.camera = count(j.at("camera")), r.scattered = count(j.at("scattered")), r.shadow = count(j.at("shadow"));
  for (std::size_t i = 0; i < r.by_depth.size(); ++i) r.by_depth[i] = count(j.at("by_depth").at(i));
  return r;
}

// Of each pass its number and the difference of each colour.
Json bias_json(const BiasOfPasses& bias) {
  Json json = Json::array();
  for (const auto& [pass, difference] : bias) json.push_back({pass, difference});
  return json;
}
BiasOfPasses bias_from(const Json& json) {
  BiasOfPasses bias;
  for (const Json& pass : json)
    bias[whole_from(pass.at(0), 0, int(max_film_samples))] = pass.at(1).get<MeanDifference>();
  return bias;
}

// Of each pass its number and the figures.
Json mixing_json(const MixingOfPasses& mixing) {
  Json json = Json::array();
  for (const auto& [pass, m] : mixing)
    json.push_back(
        {pass, m.chains, m.steps, m.large, m.large_accepted, m.small_accepted, m.between_chains, m.independent});
  return json;
}
MixingOfPasses mixing_from(const Json& json) {
  const auto count = [](const Json& n) { return whole_from<std::uint64_t>(n, 0, std::uint64_t(1) << 60); };
  MixingOfPasses mixing;
  for (const Json& pass : json)
    mixing[whole_from(pass.at(0), 0, int(max_film_samples))] = {
        count(pass.at(1)),        count(pass.at(2)),        count(pass.at(3)),       pass.at(4).get<double>(),
        pass.at(5).get<double>(), pass.at(6).get<double>(), pass.at(7).get<double>()};
  return mixing;
}

// The channels of the table of features, whose sums the film has.
Texts feature_names() {
  Texts names;
  for (const FeatureRow& row : feature_rows)
    for (char channel : row.channels)
      names.push_back(std::string(row.layer).append(row.layer.empty() ? "" : ".") + channel);
  return names;
}
void check_features(const Json& j) {
  const Texts first_version{"Z", "P.X", "P.Y", "P.Z", "albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z"};
  const auto stated = j.find("features");
  if ((stated == j.end() ? first_version : stated->get<Texts>()) != feature_names())
    throw std::invalid_argument("it has other feature layers than films of this version");
}

// Of older versions the halves have no emission and the layers of light no halves: their films cannot be continued.
void check_halves(const Json& j) {
  const Result<LayerRequest> request = parse_layers(j.at("settings").at("layers").get<std::string>());
  if (!request || !request->halves) return;
  if (!j.contains("halves_have_emission"))
    throw std::invalid_argument("its halves have no emission: an older version saved it");
  if (!j.at("picture").at("layers").is_null() && !j.contains("layers_have_halves"))
    throw std::invalid_argument("its layers of light have no halves: an older version saved it");
}

// Until the shares are decided, with the rays of the tiles, which decide them as well.
Json adaptive_json(const AdaptiveFilm& adaptive, const std::vector<std::uint64_t>& rays) {
  Json json{{"first_passes", adaptive.first_passes}, {"shares", adaptive.shares}};
  if (adaptive.shares.empty()) json["rays"] = rays;
  return json;
}
AdaptiveFilm adaptive_from(const Json& j, std::size_t tiles) {
  AdaptiveFilm adaptive{whole_from(j.at("first_passes"), 1, int(max_film_samples)),
                        j.at("shares").get<std::vector<double>>()};
  constexpr double max_share = 1 << 20;
  const auto is_share = [](double share) { return share > 0 && share <= max_share; };
  if (!adaptive.shares.empty() && (adaptive.shares.size() != tiles || !std::ranges::all_of(adaptive.shares, is_share)))
    throw std::invalid_argument("the shares of its tiles are damaged");
  return adaptive;
}
std::vector<std::uint64_t> rays_of_tiles_from(const Json& j, std::size_t tiles) {
  std::vector<std::uint64_t> rays;
  if (const auto found = j.find("rays"); found != j.end())
    for (const Json& of_tile : *found) rays.push_back(whole_from<std::uint64_t>(of_tile, 0, std::uint64_t(1) << 60));
  if ((j.at("shares").empty() || !rays.empty()) && rays.size() != tiles)
    throw std::invalid_argument("the rays of its tiles are damaged");
  return rays;
}

// All but the film itself.
Json header_json(const SavedFilm& film, const FilmSnapshot& snapshot) {
  Json json{{"format", saved_format.name}, {"version", saved_format.version}, {"program", version()}};
  add_scene(json, {film.scene, film.load, film.fingerprint});
  json["settings"] = settings_json(film.settings);
  json["options"] = options_json(film.options);
  json["passes"] = film.wanted ? Json{film.wanted->first, film.wanted->last} : Json();
  json["picture"] = facts_json(film.facts);
  json["seconds"] = snapshot.seconds;
  json["rays"] = rays_json(snapshot.rays);
  if (!snapshot.bias.empty()) json["measured_bias"] = bias_json(snapshot.bias);
  if (!snapshot.mixing.empty()) json["mixing"] = mixing_json(snapshot.mixing);
  if (film.adaptive) json["adaptive"] = adaptive_json(*film.adaptive, snapshot.rays_of_tiles);
  json["features"] = feature_names(), json["layers_have_halves"] = true, json["halves_have_emission"] = true;
  json["has_emission_rays"] = true;
  json["tile_side"] = snapshot.tile_side;
  return json;
}

Film film_from(const FilmSettings& settings, const std::optional<LayerPlan>& layers, int tile_side,
               bool has_emission_rays, std::string_view bytes) {
  const std::vector<PixelBounds> tiles = tiles_of(settings.crop, tile_side);
  // A tile takes a byte at least: room is not made for a picture that the file cannot hold.
  if (bytes.size() < tiles.size()) throw std::invalid_argument("its film is damaged");
  const Result<LayerRequest> request = parse_layers(settings.layers);
  Film film(settings.crop, layers, 1, request && request->halves);
  ByteReader in(bytes);
  for (const PixelBounds& tile : tiles) film.read_tile(tile, in, has_emission_rays);
  if (!in.at_end()) throw std::invalid_argument("it is damaged: more follows its film");
  return film;
}

SavedFilm saved_from(const Json& j, std::string_view bytes) {
  check_features(j);
  check_halves(j);
  const SavedScene scene = scene_from(j);
  const FilmSettings settings = settings_from(j.at("settings"));
  const PictureFacts facts = facts_from(j.at("picture"), settings);
  std::optional<PassRange> wanted;
  if (const Json& range = j.at("passes"); !range.is_null()) {
    wanted =
        PassRange{whole_from(range.at(0), 0, int(max_film_samples)), whole_from(range.at(1), 0, int(max_film_samples))};
    if (wanted->last < wanted->first) throw std::invalid_argument("its passes are damaged");
  }
  const double seconds = j.at("seconds");
  if (!(seconds >= 0)) throw std::invalid_argument("its time is damaged");
  Film film = film_from(settings, facts.layers, whole_from(j.at("tile_side"), 1, widest_tile),
                        j.contains("has_emission_rays"), bytes);
  film.set_max_chance_radiance(facts.max_chance_radiance);
  const auto adaptive = j.find("adaptive");
  const bool is_adaptive = adaptive != j.end() && !adaptive->is_null();
  const std::size_t tiles = film.tiles().size();
  return {scene.file,
          scene.load,
          scene.fingerprint,
          settings,
          options_from(j.at("options")),
          wanted,
          facts,
          {std::move(film), rays_from(j.at("rays")), seconds,
           j.contains("measured_bias") ? bias_from(j.at("measured_bias")) : BiasOfPasses{},
           j.contains("mixing") ? mixing_from(j.at("mixing")) : MixingOfPasses{},
           is_adaptive ? rays_of_tiles_from(*adaptive, tiles) : std::vector<std::uint64_t>{}},
          is_adaptive ? std::optional(adaptive_from(*adaptive, tiles)) : std::nullopt};
}

// The first of the values on which the passes of a film depend that differs: "seed is 1 and 2".
std::optional<std::string> difference(const Json& a, const Json& b) {
  // Passes are identified by their numbers, so that those of different seeds cannot be in one film.
  constexpr std::string_view hint =
      "; to add passes to a film, render others of the same seed, by --passes A:B or --resume";
  for (const auto& [key, value] : a.items()) {
    const auto other = b.find(key);
    const Json theirs = other == b.end() ? Json() : *other;
    if (theirs != value)
      return fmt::format("{} is {} and {}{}", key, value.dump(), theirs.dump(), key == "seed" ? hint : "");
  }
  for (const auto& [key, value] : b.items())
    if (!a.contains(key)) return fmt::format("{} is null and {}", key, value.dump());
  return std::nullopt;
}

// As far as options of the reading of the scene decide passes: not where its file is, nor what the resolution was,
// which is among the settings.
Json decisive_json(const SavedFilm& film) {
  Json json;
  add_scene(json, {film.scene, film.load, film.fingerprint});
  for (const char* key : {"scene", "scene_bytes", "lenient", "resolution"}) json.erase(key);
  make_utf8(json);
  const Json settings = settings_json(film.settings);
  for (const auto& [key, value] : settings.items()) json[key] = value;
  return json;
}

std::optional<int> common_pass(const Film& a, const Film& b) {
  for (const auto& [index, tile] : b.tiles())
    for (int pass : b.pass_numbers(tile.cells))
      if (a.has(tile.cells, pass)) return pass;
  return std::nullopt;
}

}  // namespace

bool is_saved_film(const fs::path& file) { return begins_as(file, saved_format); }

Status check_film_file(const fs::path& file) { return check_saved_target(file, saved_format); }

Result<SavedFilm> load_film(const fs::path& file) { return load_saved_bytes<Json>(file, saved_format, saved_from); }

Status save_film(const fs::path& file, const SavedFilm& film) {
  const Film& all = film.begun.film;
  FilmSnapshot snapshot{
      {}, 0, film.begun.rays, film.begun.seconds, film.begun.bias, film.begun.mixing, film.begun.rays_of_tiles};
  for (const auto& [index, tile] : all.tiles()) {
    snapshot.tile_side = std::max({snapshot.tile_side, tile.cells.width(), tile.cells.height()});
    all.write_tile(tile.cells, snapshot.tiles);
  }
  return save_snapshot(file, film, snapshot);
}

Status save_snapshot(const fs::path& file, const SavedFilm& film, const FilmSnapshot& snapshot) {
  return save_bytes(file, header_json(film, snapshot), snapshot.tiles);
}

void take_options(const SavedFilm& film, LoadOptions& load, RenderOptions& options) {
  const LoadOptions& l = film.load;
  const RenderOptions& o = film.options;
  load.lenient |= l.lenient;
  if (!load.resolution && !load.resolution_scale) load.resolution = l.resolution;
  if (!load.camera) load.camera = l.camera;
  if (!load.animation) load.animation = l.animation;
  if (!load.shutter) load.shutter = l.shutter;
  if (!load.environment) load.environment = l.environment;
  if (!options.integrator && !options.preset && options.settings.empty())
    options.integrator = o.integrator, options.preset = o.preset, options.settings = o.settings;
  if (!options.sampler) options.sampler = o.sampler;
  if (!options.crop) options.crop = o.crop;
  if (!options.layers) options.layers = o.layers;
  if (!options.seed) options.seed = film.settings.seed;
  // Where they are, that is the default.
  if (!options.shared_filters && !film.settings.shared_filters) options.shared_filters = false;
  if (!options.samples_per_pass) options.samples_per_pass = film.settings.samples_per_pass;
  if (!options.target) options.target = o.target;
  if (!options.adaptive) options.adaptive = film.adaptive.has_value();
  // The number of samples of an unbiased render is decided, whatever its time.
  const bool is_decided = options.target && options.target->unbiased && o.target && o.target->unbiased;
  const bool is_open = !options.samples && !options.seconds && !options.passes && !options.target;
  if (is_decided || is_open) options.passes = film.wanted;
}

Status check_continues(const SavedFilm& film, const SavedFilm& now) {
  if (film.fingerprint != now.fingerprint)
    return Failure{fmt::format("{} is not the scene that the saved film is of ({}), or it has changed since",
                               now.scene.string(), film.scene.string())};
  if (const auto other = difference(decisive_json(film), decisive_json(now)))
    return Failure{fmt::format("the saved film and this render do not agree: {}", *other)};
  return Done{};
}

Result<SavedFilm> merge_films(std::vector<SavedFilm> films, const Texts& names) {
  if (films.empty()) return Failure{"there is nothing to merge"};
  if (films.size() > 1)
    for (std::size_t i = 0; i < films.size(); ++i)
      if (films[i].adaptive)
        return Failure{
            fmt::format("{} is adaptive: which passes its tiles have depends on their errors, and it has no "
                        "parts to merge (--resume adds to it)",
                        names[i])};
  SavedFilm total = std::move(films.front());
  for (std::size_t i = 1; i < films.size(); ++i) {
    const SavedFilm& part = films[i];
    if (total.fingerprint != part.fingerprint)
      return Failure{fmt::format("{} and {} are of different scenes, or of one that has changed", names[0], names[i])};
    if (const auto other = difference(decisive_json(total), decisive_json(part)))
      return Failure{fmt::format("{} and {} are not of the same render: {}", names[0], names[i], *other)};
  }
  std::vector<const Film*> all{&total.begun.film};
  for (std::size_t i = 1; i < films.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if (const auto pass = common_pass(*all[j], films[i].begun.film))
        return Failure{fmt::format("{} and {} both have pass {}", names[j], names[i], *pass)};
    all.push_back(&films[i].begun.film);
  }
  try {
    for (std::size_t i = 1; i < films.size(); ++i) {
      SavedFilm& part = films[i];
      total.begun.film.merge(part.begun.film);
      total.begun.rays += part.begun.rays, total.begun.seconds += part.begun.seconds;
      total.begun.bias.merge(part.begun.bias), total.begun.mixing.merge(part.begun.mixing);
      if (total.wanted && part.wanted)
        total.wanted = {std::min(total.wanted->first, part.wanted->first),
                        std::max(total.wanted->last, part.wanted->last)};
      else
        total.wanted.reset();
      part.begun.film = Film({});
    }
  } catch (const std::invalid_argument& error) {
    return Failure{error.what()};
  }
  return total;
}

}  // namespace montelux
