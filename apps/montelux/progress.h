// Showing how a render gets on, on standard error.
#pragma once
#include <chrono>
#include <functional>
#include <string>

#include "api/render.h"
#include "signals.h"

namespace montelux::cli {

// A line with a bar that is redrawn in place on a terminal; elsewhere a line after a second and then every ten.
class StatusLine {
 public:
  explicit StatusLine(bool visible);
  // Draws the line where it is due, and at once where another phase begins; `text` is made only then.
  void show(double fraction, double elapsed, const std::function<std::string()>& text, std::string_view phase = {});
  // Takes the line away: the results say the same for good.
  void finish();

 private:
  bool visible_, in_place_;
  double next_ = 0;  // seconds at which the next line is due
  std::string phase_;
};

// The progress of a render as a status line; and it passes on the request of a signal to stop.
class ProgressLine final : public RenderObserver {
 public:
  // What a user wants to see while the work runs.
  struct Shows {
    bool line = true, notes = true;
  };
  // Of `parts` pictures that take about as long each: bar, time and time left are those of all of them.
  ProgressLine(Shows shows, const StopSignals& signals, int parts = 1)
      : signals_(signals), line_(shows.line), notes_(shows.notes), parts_(parts) {}

  // Which picture is at hand; `name` stands before the numbers.
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
// The root of a relative mean squared error as "1.23 %"; "-" where it is not known of every pixel yet.
std::string error_text(const ErrorEstimate& error);

}  // namespace montelux::cli
