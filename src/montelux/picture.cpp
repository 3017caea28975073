#include "montelux/picture.h"

#include <cmath>
#include <limits>

#include "api/images.h"

namespace montelux::api {

namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

}  // namespace

std::optional<Interval> Estimate::interval(int channel, double probability) const {
  if (channel < 0 || channel > 2 || !(probability > 0 && probability < 1)) return std::nullopt;
  const double error = standard_error[std::size_t(channel)];
  if (passes < 2 || !std::isfinite(error)) return std::nullopt;
  const montelux::Interval found = confidence_interval(mean[std::size_t(channel)], error, double(passes), probability);
  return Interval{found.low, found.high};
}

Picture::Picture(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Picture::Picture(Picture&&) noexcept = default;
Picture& Picture::operator=(Picture&&) noexcept = default;
Picture::~Picture() = default;

int Picture::width() const { return parts_->rendering.result.film.bounds().width(); }
int Picture::height() const { return parts_->rendering.result.film.bounds().height(); }

Estimate Picture::pixel(int x, int y) const {
  const Film& film = parts_->rendering.result.film;
  const int px = film.bounds().x0 + x, py = film.bounds().y0 + y;
  const PixelEstimate& pixel = film.pixel(px, py);
  Estimate estimate;
  for (int c = 0; c < 3; ++c) {
    estimate.mean[std::size_t(c)] = pixel.mean[c];
    estimate.standard_error[std::size_t(c)] =
        parts_->rendering.found_no_light ? unknown : std::sqrt(pixel.variance_of_mean(c));
  }
  estimate.passes = int(pixel.passes);
  estimate.samples = film.samples(px, py);
  estimate.non_finite = pixel.non_finite;
  return estimate;
}

Estimate Picture::mean() const {
  const Rendering& rendering = parts_->rendering;
  const Film& film = rendering.result.film;
  Estimate estimate;
  for (int c = 0; c < 3; ++c) {
    estimate.mean[std::size_t(c)] = rendering.image.mean[c];
    estimate.standard_error[std::size_t(c)] = rendering.has_error_bar() ? rendering.image.standard_error[c] : unknown;
  }
  estimate.passes = rendering.image.passes;
  for (int y = film.bounds().y0; y < film.bounds().y1; ++y)
    for (int x = film.bounds().x0; x < film.bounds().x1; ++x) estimate.samples += film.samples(x, y);
  estimate.non_finite = film.non_finite();
  return estimate;
}

std::vector<float> Picture::rgb() const {
  const Film& film = parts_->rendering.result.film;
  std::vector<float> all;
  all.reserve(3 * std::size_t(width()) * std::size_t(height()));
  for (int y = film.bounds().y0; y < film.bounds().y1; ++y)
    for (int x = film.bounds().x0; x < film.bounds().x1; ++x)
      for (int c = 0; c < 3; ++c) all.push_back(float(film.pixel(x, y).mean[c]));
  return all;
}

double Picture::seconds() const { return parts_->rendering.result.seconds; }
bool Picture::interrupted() const { return parts_->rendering.result.interrupted; }
std::vector<std::string> Picture::notes() const { return parts_->rendering.notes; }

Status Picture::write(const std::filesystem::path& file) const {
  try {
    const DisplayTransform display =
        is_display_file(file) ? choose_display(parts_->rendering, {}).transform : DisplayTransform{};
    const montelux::Status written = write_rendering(file, parts_->rendering, display);
    if (!written) return Error(written.error());
    return Done{};
  } catch (const std::exception& error) {
    return Error(error.what());
  }
}

std::string version() { return montelux::version(); }

}  // namespace montelux::api
