#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "lab/report/axis_scale.h"
#include "lab/report/write.h"

namespace montelux::lab {

namespace {

// The order of colours that web/src/style.css has for light paper.
constexpr std::array<const char*, 8> colors{"#1f66b0", "#cc5a1e", "#2a8656", "#8350ab",
                                            "#b8354f", "#7c6b14", "#1b8a97", "#5c6370"};
constexpr const char* ink = "#1d222b";
constexpr const char* faint = "#5a6472";

std::string escaped(const std::string& text) {
  std::string result;
  for (char c : text) {
    if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '&')
      result += "&amp;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

std::size_t letters(const std::string& text) {
  return std::size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

// The figure being drawn: the frame in points, and the scales.
class Drawing {
 public:
  explicit Drawing(const Figure& figure) : figure_(figure) {
    std::vector<double> x, y;
    bool bars = false;
    for (const Curve& curve : figure.curves) {
      bars = bars || curve.mark == Mark::bars;
      x.insert(x.end(), curve.x.begin(), curve.x.end());
      if (curve.mark == Mark::bars && !curve.x.empty())
        x.push_back(curve.x.front() - 0.5 * step(curve)), x.push_back(curve.x.back() + 0.5 * step(curve));
      for (const auto* values : {&curve.y, &curve.low, &curve.high}) y.insert(y.end(), values->begin(), values->end());
    }
    x_ = scale_of(figure.x, x, false), y_ = scale_of(figure.y, y, bars);
    if (figure.square) width_ = height_ = 380;
    top_ = 16 + legend_lines() * 18;
  }

  std::string svg() {
    const double full_width = left_ + width_ + 18, full_height = top_ + height_ + 52;
    out_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}\" height=\"{1:g}\" viewBox=\"0 0 {0:g} {1:g}\" "
        "font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" font-size=\"12\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
        "<clipPath id=\"frame\"><rect x=\"{2:g}\" y=\"{3:g}\" width=\"{4:g}\" height=\"{5:g}\"/></clipPath>\n",
        full_width, full_height, left_, top_, width_, height_);
    axes();
    out_ += "<g clip-path=\"url(#frame)\">\n";
    for (std::size_t i = 0; i < figure_.curves.size(); ++i) draw(figure_.curves[i], color_of(i));
    out_ += fmt::format("</g>\n<path d=\"M{0:g} {1:g}V{2:g}H{3:g}\" fill=\"none\" stroke=\"{4}\"/>\n", left_, top_,
                        top_ + height_, left_ + width_, ink);
    legend();
    return out_ + "</svg>\n";
  }

 private:
  static double step(const Curve& curve) {
    if (curve.width > 0) return curve.width;
    return curve.x.size() > 1 ? curve.x[1] - curve.x[0] : 1;
  }
  double px(double x) const { return left_ + width_ * x_.place(x); }
  // Far outside of the frame rather than endless, so that every reader of SVG clips it.
  double py(double y) const { return top_ + height_ - height_ * std::clamp(y_.place(y), -2.0, 3.0); }
  const char* color_of(std::size_t i) const { return colors[std::size_t(lab::color_of(figure_, i)) % colors.size()]; }
  static bool good(double x, double y) { return std::isfinite(x) && std::isfinite(y); }

  void axes() {
    for (const Tick& tick : x_.ticks()) {
      const double x = px(tick.value);
      out_ += fmt::format("<path d=\"M{0:.1f} {1:g}V{2:g}\" stroke=\"{3}\" stroke-width=\"{4}\"/>\n", x, top_,
                          top_ + height_, "#dfe3e8", tick.label.empty() ? 0.4 : 0.8);
      out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:g}\" text-anchor=\"middle\" fill=\"{}\">{}</text>\n", x,
                          top_ + height_ + 17, faint, escaped(plain_text(tick.label)));
    }
    for (const Tick& tick : y_.ticks()) {
      const double y = py(tick.value);
      out_ += fmt::format("<path d=\"M{0:g} {1:.1f}H{2:g}\" stroke=\"{3}\" stroke-width=\"{4}\"/>\n", left_, y,
                          left_ + width_, "#dfe3e8", tick.label.empty() ? 0.4 : 0.8);
      out_ += fmt::format("<text x=\"{:g}\" y=\"{:.1f}\" text-anchor=\"end\" fill=\"{}\">{}</text>\n", left_ - 7, y + 4,
                          faint, escaped(plain_text(tick.label)));
    }
    out_ += fmt::format("<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"middle\" fill=\"{}\">{}</text>\n",
                        left_ + width_ / 2, top_ + height_ + 40, ink, escaped(plain_text(figure_.x.label)));
    out_ +=
        fmt::format("<text transform=\"translate(15 {:g}) rotate(-90)\" text-anchor=\"middle\" fill=\"{}\">{}</text>\n",
                    top_ + height_ / 2, ink, escaped(plain_text(figure_.y.label)));
  }

  void draw(const Curve& curve, const char* color) {
    if (curve.mark == Mark::bars) return bars(curve, color);
    if (curve.mark == Mark::points) return points(curve, color);
    band(curve, color);
    std::string path;
    bool pen_down = false;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      const double x = px(curve.x[i]), y = py(curve.y[i]);
      if (!good(x, y)) {
        pen_down = false;
        continue;
      }
      if (curve.mark == Mark::steps && pen_down) path += fmt::format("H{:.2f}", x);
      path += fmt::format("{}{:.2f} {:.2f}", pen_down ? "L" : "M", x, y);
      pen_down = true;
    }
    out_ +=
        fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" stroke-linejoin=\"round\"{}/>\n",
                    path, color, curve.mark == Mark::dashes ? " stroke-dasharray=\"6 4\"" : "");
  }

  void band(const Curve& curve, const char* color) {
    std::string forth, back;
    for (std::size_t i = 0; i < curve.low.size(); ++i) {
      if (!good(px(curve.x[i]), py(curve.high[i]))) continue;
      // A lower bound that a logarithm cannot show lies below the frame.
      const double low = py(curve.low[i]), floor = top_ + 3 * height_;
      forth += fmt::format("{}{:.2f} {:.2f}", forth.empty() ? "M" : "L", px(curve.x[i]), py(curve.high[i]));
      back = fmt::format("L{:.2f} {:.2f}", px(curve.x[i]), std::isfinite(low) ? low : floor) + back;
    }
    if (!forth.empty())
      out_ += fmt::format("<path d=\"{}{}Z\" fill=\"{}\" fill-opacity=\"0.16\"/>\n", forth, back, color);
  }

  void error_bar(const Curve& curve, std::size_t i, const char* color) {
    if (curve.low.empty() || !good(px(curve.x[i]), py(curve.low[i])) || !std::isfinite(py(curve.high[i]))) return;
    const double x = px(curve.x[i]), low = py(curve.low[i]), high = py(curve.high[i]);
    out_ += fmt::format(
        "<path d=\"M{0:.2f} {1:.2f}V{2:.2f}M{3:.2f} {1:.2f}h5M{3:.2f} {2:.2f}h5\" stroke=\"{4}\" fill=\"none\"/>\n", x,
        low, high, x - 2.5, color);
  }

  void points(const Curve& curve, const char* color) {
    const double radius = curve.x.size() > 150 ? 1.4 : 3;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (!good(px(curve.x[i]), py(curve.y[i]))) continue;
      error_bar(curve, i, color);
      out_ += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:g}\" fill=\"{}\"/>\n", px(curve.x[i]),
                          py(curve.y[i]), radius, color);
    }
  }

  void bars(const Curve& curve, const char* color) {
    const double zero = std::min(py(y_.logarithmic ? y_.low : std::max(0.0, y_.low)), top_ + height_);
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      const double half = 0.46 * step(curve), left = px(curve.x[i] - half), right = px(curve.x[i] + half);
      if (!good(left, py(curve.y[i]))) continue;
      const double y = py(curve.y[i]);
      out_ += fmt::format(
          "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\" fill-opacity=\"0.45\"/>\n",
          left, std::min(y, zero), right - left, std::abs(zero - y), color);
      error_bar(curve, i, color);
    }
  }

  // Where each name of the legend begins: from left to right, in as many lines as it takes.
  std::vector<std::pair<double, int>> legend_places() const {
    std::vector<std::pair<double, int>> places;
    double x = left_;
    int line = 0;
    for (const Curve& curve : figure_.curves) {
      const double width = curve.name.empty() ? 0 : 34 + 6.8 * double(letters(plain_text(curve.name)));
      if (x > left_ && x + width > left_ + width_ + 10) x = left_, ++line;
      places.emplace_back(x, line);
      x += width;
    }
    return places;
  }
  int legend_lines() const { return figure_.curves.empty() ? 0 : legend_places().back().second + 1; }

  void legend() {
    const auto places = legend_places();
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Curve& curve = figure_.curves[i];
      if (curve.name.empty()) continue;
      const char* color = color_of(i);
      const double x = places[i].first, y = 14 + places[i].second * 18;
      if (curve.mark == Mark::points)
        out_ += fmt::format("<circle cx=\"{:g}\" cy=\"{:g}\" r=\"3\" fill=\"{}\"/>\n", x + 8, y - 4, color);
      else if (curve.mark == Mark::bars)
        out_ +=
            fmt::format("<rect x=\"{:g}\" y=\"{:g}\" width=\"14\" height=\"10\" fill=\"{}\" fill-opacity=\"0.45\"/>\n",
                        x + 1, y - 9, color);
      else
        out_ += fmt::format("<path d=\"M{:g} {:g}h16\" stroke=\"{}\" stroke-width=\"2\"{}/>\n", x, y - 4, color,
                            curve.mark == Mark::dashes ? " stroke-dasharray=\"5 3\"" : "");
      out_ += fmt::format("<text x=\"{:g}\" y=\"{:g}\" fill=\"{}\">{}</text>\n", x + 21, y, ink,
                          escaped(plain_text(curve.name)));
    }
  }

  const Figure& figure_;
  AxisScale x_, y_;
  double left_ = 66, top_ = 16, width_ = 560, height_ = 320;
  std::string out_;
};

}  // namespace

std::string to_svg(const Figure& figure) { return Drawing(figure).svg(); }

}  // namespace montelux::lab
