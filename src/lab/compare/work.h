// Pieces of work of a comparison during renders.
#pragma once
#include <string>

#include "lab/compare/comparison.h"

namespace montelux::lab {

// Reports the progress of a piece over its renders.
class PieceProgress {
 public:
  PieceProgress(const ComparisonWatch& watch, WorkPiece piece) : watch_(watch), piece_(std::move(piece)) { state(0); }
  ~PieceProgress() { state(1); }
  PieceProgress(const PieceProgress&) = delete;
  PieceProgress& operator=(const PieceProgress&) = delete;

  void state(double done) const {
    if (watch_.progress) watch_.progress(piece_, done);
  }
  const ComparisonWatch& watch() const { return watch_; }

 private:
  const ComparisonWatch& watch_;
  WorkPiece piece_;
};

// A render that is the part [from, to] of a piece; it forwards a request to stop.
class PartOfPiece final : public RenderObserver {
 public:
  PartOfPiece(const PieceProgress& piece, double from, double to) : piece_(piece), from_(from), to_(to) {}
  void progress(const Progress& p) override { piece_.state(from_ + (to_ - from_) * (p.finished ? 1 : p.fraction)); }
  bool stop_requested() override { return piece_.watch().stopped(); }

 private:
  const PieceProgress& piece_;
  double from_, to_;
};

// The render settings for one method: its own point set, no time limit.
RenderSettings settings_for(const ComparedMethod& compared_method, const ComparisonSettings& settings);
// The counted part of the time of a render.
double seconds_that_count(const RenderResult& result, const ComparisonSettings& settings);

}  // namespace montelux::lab
