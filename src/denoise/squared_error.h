// An estimate of the error of a filtered pixel, from the pixel itself.
#pragma once

namespace montelux {

// A candidate at one pixel and channel: both halves, and for each its covariance with the noise of the pixel, in
// variances of the pixel. Where pixels have independent noise that is the share of the pixel itself.
struct Filtered {
  double first, second;
  double own_first, own_second;
};

// The image at one pixel and channel.
struct Noisy {
  double first, second;
  double share;     // of the first half
  double variance;  // of the mean of both
  double mean() const { return share * first + (1 - share) * second; }
};

// An unbiased estimate of the squared error of share * first + (1 - share) * second, whose weights do not depend on
// what they weigh. For a half y with variance v and its filtered value f, (f - y)^2 - v + 2 own v has the expectation
// of the squared error of f (Stein 1981); that of a mean follows from those of its parts and from their difference.
inline double squared_error(const Noisy& noisy, const Filtered& f) {
  const double s = noisy.share, t = 1 - s;
  const auto of_half = [](double value, double data, double variance, double own) {
    return (value - data) * (value - data) - variance + 2 * own * variance;
  };
  const double first = of_half(f.first, noisy.first, noisy.variance / s, f.own_first);
  const double second = of_half(f.second, noisy.second, noisy.variance / t, f.own_second);
  return s * first + t * second - s * t * (f.first - f.second) * (f.first - f.second);
}

// The same of any filter of each half: its value is compared with the other half, which is independent of it. With the
// halves x and y and their shares s and t, (f - y)^2 - s (x - y)^2 has the expectation of the squared error of f, since
// s (x - y)^2 has that of the squared error of y; and a rare bright sample counts only linearly. The noise is that of
// two halves instead of all passes.
inline double squared_error_by_halves(const Noisy& noisy, double first, double second) {
  const double s = noisy.share, t = 1 - s, noise = (noisy.first - noisy.second) * (noisy.first - noisy.second);
  const double of_first = (first - noisy.second) * (first - noisy.second) - s * noise;
  const double of_second = (second - noisy.first) * (second - noisy.first) - t * noise;
  return s * of_first + t * of_second - s * t * (first - second) * (first - second);
}

}  // namespace montelux
