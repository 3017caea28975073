#include "api/comparison_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "api/checksum.h"
#include "api/comparison_methods.h"
#include "api/diff.h"
#include "api/render.h"

namespace montelux {

namespace {

namespace fs = std::filesystem;

// Checks that every value is finite: an invalid value would invalidate every figure.
Status check_finite(const PixelBuffer& picture, std::string_view what) {
  std::size_t holes = 0, first = 0;
  for (std::size_t p = 0; p < picture.pixel_count(); ++p) {
    const float* pixel = &picture.values[p * picture.channels.size()];
    if (std::all_of(pixel, pixel + picture.channels.size(), [](float v) { return std::isfinite(v); })) continue;
    if (holes++ == 0) first = p;
  }
  if (holes == 0) return Done{};
  return Failure{fmt::format("{} in {} of {} pixels, the first at {}, {}; a comparison needs a value in every pixel",
                             what, holes, picture.pixel_count(), first % std::size_t(picture.width),
                             first / std::size_t(picture.width))};
}

Result<lab::Reference> read_reference(const fs::path& file, const PixelBounds& bounds) {
  auto picture = read_estimate({file, {}, {}});
  if (!picture) return picture.failure();
  if (picture->color.width != bounds.width() || picture->color.height != bounds.height())
    return Failure{fmt::format("{}: the reference has {} x {} pixels, the picture {} x {}", file.string(),
                               picture->color.width, picture->color.height, bounds.width(), bounds.height())};
  if (Status finite = check_finite(picture->color, "the reference is not finite"); !finite)
    return Failure{file.string() + ": " + finite.error()};
  if (picture->bars)
    if (Status finite = check_finite(picture->bars->standard_error, "the reference's standard error is not finite");
        !finite)
      return Failure{file.string() + ": " + finite.error()};
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
      for (std::size_t c = 0; c < 3; ++c) (*reference.variance_of_image)[c] = std::pow((*error)[c], 2);
    }
  }
  return reference;
}

// ---- the cache of references ----------------------------------------------------------------------------------------

// Includes the modification time of the image.
std::string environment_text(const EnvironmentOptions& e) {
  std::error_code ignored;
  return fmt::format("{} {} {} {}", e.file, e.rotation, e.scale,
                     fs::last_write_time(e.file, ignored).time_since_epoch().count());
}

// The choices of a view that a scene file may offer.
std::string view_of(const LoadOptions& load) {
  return fmt::format("camera {}, animation {}, shutter {}, lenient {}, environment {}", load.camera.value_or("-"),
                     load.animation.value_or("-"),
                     load.shutter ? fmt::format("{} to {}", load.shutter->open, load.shutter->close) : "-",
                     load.lenient, load.environment ? environment_text(*load.environment) : "-");
}

// Changes with any file in the scene's folder or below, with the camera, the time and the size of the image, and with
// its biases.
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

}  // namespace

Result<ReferenceSource> find_reference(const ComparisonOptions& options,
                                       const std::vector<lab::ComparedMethod>& compared_methods,
                                       const PixelBounds& bounds) {
  ReferenceSource source;
  if (options.reference) {
    auto named = read_reference(*options.reference, bounds);
    if (!named) return named.failure();
    source.reference = *std::move(named);
    return source;
  }
  auto serve = who_may_serve(compared_methods);
  if (!serve) return serve.failure();
  source.may_serve = *std::move(serve);
  return source;
}

std::optional<fs::path> reference_cache(const LoadedScene::Parts& parts, const PixelBounds& bounds,
                                        const lab::ComparedMethod& method) {
  std::optional<fs::path> folder;
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache)
    folder = fs::path(cache) / "montelux";
  else if (const char* home = std::getenv("HOME"); home && *home)
    folder = fs::path(home) / ".cache/montelux";
  if (!folder) return std::nullopt;
  std::string biases;
  for (const std::string& bias : method.biases) biases += bias + ";";
  return *folder / fmt::format("reference-{:016x}.exr", scene_hash(parts, bounds, biases));
}

std::optional<lab::Reference> kept_reference(const fs::path& file, const PixelBounds& bounds,
                                             const lab::ByMeasure<double>& variance) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  auto reference = read_reference(file, bounds);
  if (!reference) return std::nullopt;
  for (lab::ErrorMeasure by : {lab::ErrorMeasure::relative_mse, lab::ErrorMeasure::mse})
    if (!(lab::variance_by(by, *reference) <= variance[by])) return std::nullopt;
  return *std::move(reference);
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

}  // namespace montelux
