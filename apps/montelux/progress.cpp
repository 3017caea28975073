#include "progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "status.h"

namespace montelux::cli {

namespace {

int terminal_columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

// The known figures without the bar: speed and error of the image, times of all.
std::string numbers(const Progress& p, double elapsed, std::optional<double> left) {
  const double speed = p.elapsed > 0 ? double(p.samples) / p.elapsed : 0;
  std::string time_left = left ? time_text(*left) : "-";
  if (p.to_target && left && *left == p.to_target->seconds)
    time_left += fmt::format(" ({} to {})", time_text(p.to_target->low), time_text(p.to_target->high));
  return fmt::format("{}  left {}  {}  error {}", time_text(elapsed), time_left, count_text(speed, "samples/s"),
                     error_text(p.error));
}

}  // namespace

StatusLine::StatusLine(bool visible) : visible_(visible), in_place_(terminal_on_stderr()), next_(in_place_ ? 0 : 1) {}

void StatusLine::show(double fraction, double elapsed, const std::function<std::string()>& text,
                      std::string_view phase) {
  const bool begins = in_place_ && phase != phase_;
  if (!visible_ || (elapsed < next_ && !begins)) return;
  phase_ = phase;
  next_ = elapsed + (in_place_ ? 0.1 : 10);
  const std::string numbers = text();
  const int percent = int(100 * fraction);
  if (!in_place_) {
    print_log(fmt::format("{:3} %  {}\n", percent, numbers));
    return;
  }
  const int columns = terminal_columns();
  const int width = std::clamp(columns - int(numbers.size()) - 12, 0, 40);
  std::string line = fmt::format("{:3} % ", percent);
  if (width >= 8) {
    const int full = int(std::lround(fraction * width));
    line += fmt::format("[{}{}] ", std::string(std::size_t(full), '='), std::string(std::size_t(width - full), ' '));
  }
  line = (line + numbers).substr(0, std::size_t(std::max(columns - 1, 1)));
  print_log(fmt::format("\r{}\x1b[K", line));
}

void StatusLine::finish() {
  if (!visible_ || !in_place_) return;
  print_log("\r\x1b[K");
}

void ProgressLine::announce(const std::string& text) {
  if (notes_) warn(text);
}

bool ProgressLine::stop_requested() { return signals_.received() != 0; }

void ProgressLine::progress(const Progress& p) {
  if (p.finished) return line_.finish();
  const std::chrono::duration<double> all = std::chrono::steady_clock::now() - start_;
  const double fraction = (part_ + p.fraction) / parts_, elapsed = parts_ > 1 ? all.count() : p.elapsed;
  const double left = parts_ > 1 ? elapsed * (1 / fraction - 1) : p.remaining;
  line_.show(fraction, elapsed,
             [&] { return name_ + numbers(p, elapsed, fraction > 0 ? std::optional(left) : std::nullopt); });
}

std::string time_text(double seconds) {
  if (seconds < 0.00995) return fmt::format("{:.2g} ms", seconds * 1e3);
  if (seconds < 0.9995) return fmt::format("{:.0f} ms", seconds * 1e3);
  if (seconds < 99.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = (long long)(std::min(seconds, 1e15));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string count_text(double count, std::string_view unit) {
  const char* prefixes[] = {"", "k", "M", "G", "T", "P"};
  std::size_t prefix = 0;
  while (count >= 999.5 && prefix + 1 < std::size(prefixes)) count /= 1000, ++prefix;
  std::string text = fmt::format("{:.3g} {}{}", count, prefixes[prefix], unit);
  if (text.back() == ' ') text.pop_back();
  return text;
}

std::string error_text(const ErrorEstimate& error) {
  if (!error.whole() || !std::isfinite(error.relative_mse)) return "-";
  return fmt::format("{:.3g} %", 100 * std::sqrt(error.relative_mse));
}

}  // namespace montelux::cli
