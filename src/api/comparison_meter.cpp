#include "api/comparison_meter.h"

#include <algorithm>

namespace montelux {

ComparisonMeter::ComparisonMeter(const ComparisonObserver& observer) : observer_(observer) {
  watch_.stop = observer.stop;
  watch_.progress = [this](const lab::WorkPiece& piece, double done) { state(piece, done); };
}

void ComparisonMeter::expect(double seconds) { expected_ = seconds, done_ = piece_ = 0, expected_at_ = elapsed(); }

double ComparisonMeter::remaining() const {
  const double done = done_ + piece_, took = elapsed() - expected_at_;
  // A small part of the work is no reliable basis for the prediction.
  const double trust = expected_ > 0 ? std::clamp(10 * done / expected_, 0.0, 1.0) : 0;
  const double pace = done > 0 ? 1 + trust * (std::clamp(took / done, 0.1, 10.0) - 1) : 1;
  return std::max(expected_ - done, 0.0) * pace;
}

void ComparisonMeter::state(const lab::WorkPiece& piece, double done) {
  // A piece that consists of several renders ends with the last of them, and then once more.
  if (done == 0) piece_ = 0, under_way_ = true;
  if (under_way_) piece_ = std::max(piece_, done * piece.seconds);
  if (done == 1 && under_way_) done_ += piece.seconds, piece_ = 0, under_way_ = false;
  if (!observer_.progress) return;
  const double gone = elapsed(), left = remaining();
  observer_.progress({gone + left > 0 ? gone / (gone + left) : 0, gone, left, piece.what});
}

}  // namespace montelux
