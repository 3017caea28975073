#include "render/target_judge.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

namespace montelux {

namespace {

// Consecutive looks that spend alike, and what they spend together.
struct SpentBlock {
  int looks;
  double share;
};

}  // namespace

int Looks::after(int passes) const {
  if (passes < first_) return first_;
  int look = first_;
  while (look <= passes) look += std::max(look / growth_, 1);
  return look;
}

double Looks::spent(int passes) const {
  int number = 0;
  for (int look = first_; look < passes; look = after(look)) ++number;
  constexpr std::array blocks = {SpentBlock{4, 0.16}, SpentBlock{8, 0.48}, SpentBlock{8, 0.24}};
  double rest = 1;
  for (const SpentBlock& block : blocks) {
    if (number < block.looks) return block.share / block.looks;
    number -= block.looks, rest -= block.share;
  }
  return rest / double((number + 1) * (number + 2));
}

FilmMark::FilmMark(const ImageEstimate& image) : passes(image.passes), mean(std::to_array(image.mean)) {}

class FilteredFilm {
 public:
  // What the filter has left of this film; nothing if another one was filtered last.
  std::optional<FilteredError> of(const ImageEstimate& image) const {
    const std::scoped_lock lock(mutex_);
    return mark_ == FilmMark(image) ? left_ : std::nullopt;
  }
  void set(const ImageEstimate& image, double noisy, const FilteredError& left) {
    const std::scoped_lock lock(mutex_);
    mark_ = FilmMark(image), noisy_ = noisy, left_ = left;
  }
  // What it would leave of this relative mean squared error.
  std::optional<FilteredError> scaled_to(double noisy) const {
    const std::scoped_lock lock(mutex_);
    if (!left_ || !(noisy_ > 0)) return left_;
    const double ratio = std::pow(noisy / noisy_, filtered_power);
    return FilteredError{ratio * left_->relative_mse, ratio * left_->unfiltered, ratio * left_->deviation};
  }

 private:
  mutable std::mutex mutex_;
  std::optional<FilmMark> mark_;
  double noisy_ = 0;
  std::optional<FilteredError> left_;
};

TargetJudge::TargetJudge(const ErrorTarget& target, NoiseFilter filter)
    : target_(target), filter_(std::move(filter)), last_(filter_ ? std::make_shared<FilteredFilm>() : nullptr) {}

TargetJudge TargetJudge::with_error(double error) const {
  TargetJudge other = *this;
  other.target_.error = error;
  return other;
}

TargetState TargetJudge::judge(const Film& film, bool single_look, const std::function<bool()>& stops) const {
  const ImageEstimate image = film.image();
  if (image.passes < 2 || film.grid().stride > 1) return {};
  FilmPlanes planes(film.bounds());
  planes.copy(film, film.bounds());
  const ErrorEstimate error = estimate_error(planes);
  std::optional<FilteredError> filtered;
  if (filter_ && film.has_halves()) {
    filtered = last_->of(image);
    if (!filtered && (filtered = filter_(film, stops))) last_->set(image, error.relative_mse, *filtered);
  }
  std::size_t max_passes = 0;
  for (const auto& [index, tile] : film.tiles()) max_passes = std::max(max_passes, tile.passes.size());
  const double spent = single_look ? 1 : Looks(target_.measure).spent(int(max_passes));
  return montelux::judge(target_, planes, error, image, spent, filtered);
}

bool TargetJudge::is_reached(const Film& film, const std::function<bool()>& stops) const {
  // A filter takes long: it is not tried where it would have to remove more than it ever does, which is 0.85 of the
  // error in the scenes of docs/denoising.md.
  constexpr double max_gain = 10;
  if (filter_ && std::sqrt(film.error().relative_mse) > max_gain * target_.error) return false;
  return judge(film, false, stops).reaches(target_);
}

TargetState TargetJudge::judge(const FilmPlanes& planes, const ErrorEstimate& error, const ImageEstimate& image) const {
  const std::optional<FilteredError> filtered = last_ ? last_->scaled_to(error.relative_mse) : std::nullopt;
  return montelux::judge(target_, planes, error, image, 1, filtered);
}

}  // namespace montelux
