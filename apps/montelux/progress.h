// The progress of a render, on standard error.
#pragma once
#include <chrono>
#include <functional>
#include <string>

#include "api/render.h"
#include "signals.h"

namespace montelux::cli {

// A line with a bar that is updated in place on a terminal; elsewhere a line after one second and then every ten.
class StatusLine {
 public:
  explicit StatusLine(bool visible);
  // Draws the line when it is due, and immediately when a new phase begins; `text` is called only then.
  void show(double fraction, double elapsed, const std::function<std::string()>& text, std::string_view phase = {});
  // Removes the line: the results contain the same information.
  void finish();

 private:
  bool visible_, in_place_;
  double next_ = 0;  // seconds at which the next line is due
  std::string phase_;
};

// The progress of a render as a status line; also forwards the request of a signal to stop.
class ProgressLine final : public RenderObserver {
 public:
  // What to show during the work.
  struct Shows {
    bool line = true, notes = true;
  };
  // For `parts` images of about equal duration: bar, time and remaining time are those of all of them.
  ProgressLine(Shows shows, const StopSignals& signals, int parts = 1)
      : signals_(signals), line_(shows.line), notes_(shows.notes), parts_(parts) {}

  // Selects the current image; `name` precedes the figures.
  void begin(int part, std::string name) { part_ = part, name_ = std::move(name); }

  void progress(const Progress& progress) override;
  void announce(const std::string& text) override;
  bool stop_requested() override;

 private:
  const StopSignals& signals_;
  StatusLine line_;
  bool notes_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::string name_;
  int part_ = 0, parts_;
};

// "1.2 ms", "850 ms", "12.3 s", "4 min 05 s", "2 h 03 min".
std::string time_text(double seconds);
// "1.23 k", "45.6 Mrays/s": three digits, a decimal prefix and the unit.
std::string count_text(double count, std::string_view unit = "");
// The root of a relative mean squared error as "1.23 %"; "-" until it is known for every pixel.
std::string error_text(const ErrorEstimate& error);

}  // namespace montelux::cli
