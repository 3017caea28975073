// The relative error that pictures state of themselves against the one that they have.
#pragma once
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "api/render.h"
#include "statistics.h"

namespace montelux::test {

// The relative mean squared error by the pixel's own mean, which shares the noise of the squared error: a planted
// fault.
inline double error_over_own_mean(const Film& film) {
  double sum = 0;
  const PixelBounds& b = film.bounds();
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x)
      for (int c = 0; c < rgb_size; ++c) {
        const PixelEstimate& p = film.pixel(x, y);
        sum += p.variance_of_mean(c) / (p.mean[c] * p.mean[c] + 0.01) / rgb_size;
      }
  return sum / b.area();
}

// What one picture states, and what it is.
struct StatedError {
  double stated = 0, over_own_mean = 0, truth = 0;
  bool unsure = false;
};

// Pictures of one scene at several numbers of samples. Each is held to the mean of all the others, whose own error is
// subtracted.
class StatedErrors {
 public:
  StatedErrors(const std::filesystem::path& scene, int width, int height) {
    LoadOptions load;
    load.resolution = {width, height}, load.lenient = true;
    LoadResult loaded = load_scene(scene, load);
    if (!loaded.scene) throw std::runtime_error("cannot load " + scene.string());
    scene_.emplace(*std::move(loaded.scene));
  }

  // By seeds, for images with this many samples per pixel.
  void render(int samples, int seeds) {
    for (int i = 0; i < seeds; ++i) {
      RenderOptions options;
      options.samples = samples, options.integrator = "path", options.seed = std::uint32_t(++seed_);
      RenderObserver silent;
      const Result<Rendering> rendering = render_scene(*scene_, options, silent);
      if (!rendering) throw std::runtime_error(rendering.error());
      pictures_.push_back(picture_of(*rendering, samples));
      add(pictures_.back(), 1);
    }
  }

  // Of the pictures with so many samples.
  std::vector<StatedError> errors(int samples) {
    std::vector<StatedError> errors;
    for (const Picture& picture : pictures_) {
      if (picture.samples != samples) continue;
      add(picture, -1);
      errors.push_back(picture.error);
      errors.back().truth = true_error(picture);
      add(picture, 1);
    }
    return errors;
  }

 private:
  struct Picture {
    double samples;
    std::vector<double> mean, variance;
    StatedError error;
  };

  static Picture picture_of(const Rendering& rendering, int samples) {
    const Film& film = rendering.result.film;
    Picture picture{double(samples), {}, {}, {}};
    const PixelBounds& b = film.bounds();
    for (int y = b.y0; y < b.y1; ++y)
      for (int x = b.x0; x < b.x1; ++x)
        for (int c = 0; c < rgb_size; ++c) {
          picture.mean.push_back(film.pixel(x, y).mean[c]);
          picture.variance.push_back(film.pixel(x, y).variance_of_mean(c));
        }
    picture.error = {rendering.error.relative_mse, error_over_own_mean(film), 0, rendering.error.is_unsure()};
    return picture;
  }
  void add(const Picture& picture, double sign) {
    sum_.resize(picture.mean.size()), variance_.resize(picture.mean.size());
    for (std::size_t i = 0; i < sum_.size(); ++i) {
      sum_[i] += sign * picture.samples * picture.mean[i];
      variance_[i] += sign * picture.samples * picture.samples * picture.variance[i];
    }
    samples_ += sign * picture.samples;
  }
  double true_error(const Picture& picture) const {
    double error = 0;
    for (std::size_t i = 0; i < sum_.size(); ++i) {
      const double truth = sum_[i] / samples_, own = variance_[i] / (samples_ * samples_);
      const double difference = picture.mean[i] - truth;
      error += (difference * difference - own) / (truth * truth + 0.01);
    }
    return error / double(sum_.size());
  }

  std::optional<LoadedScene> scene_;
  int seed_ = 0;
  std::vector<Picture> pictures_;
  std::vector<double> sum_, variance_;  // over pictures, weighted by their samples
  double samples_ = 0;
};

// The mean of what is stated over the mean of what is true, with the standard error of its logarithm over pictures.
struct ErrorRatio {
  double ratio = 0, log_error = 0;
  double low() const { return ratio * std::exp(-1.96 * log_error); }
  double high() const { return ratio * std::exp(1.96 * log_error); }
};

template <class Stated>
ErrorRatio ratio_of(const std::vector<StatedError>& errors, Stated stated) {
  double a = 0, b = 0, square = 0;
  for (const StatedError& e : errors) a += stated(e), b += e.truth;
  for (const StatedError& e : errors) {
    const double d = stated(e) / a - e.truth / b;  // the influence of one picture on log(a / b)
    square += d * d;
  }
  const double n = double(errors.size());
  return {a / b, std::sqrt(square * n / (n - 1))};
}

}  // namespace montelux::test
