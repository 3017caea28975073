#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/json_text.h"
#include "lab/report/axis_scale.h"
#include "lab/report/base64.h"
#include "lab/report/write.h"
#include "texture/texel_image.h"

namespace montelux::lab {

namespace {

using Json = nlohmann::ordered_json;

// Seven digits, more than any plot can show.
Json number(double x) { return std::isfinite(x) ? Json(std::stod(fmt::format("{:.7g}", x))) : Json(); }

Json numbers(const std::vector<double>& values) {
  Json array = Json::array();
  for (double x : values) array.push_back(number(x));
  return array;
}

Json to_json(const Axis& axis) {
  Json json{{"label", plain_text(axis.label)}, {"log", axis.logarithmic}};
  if (axis.low) json["low"] = *axis.low;
  if (axis.high) json["high"] = *axis.high;
  if (!axis.names.empty()) json["names"] = axis.names;
  return json;
}

Json to_json(const Curve& curve, int color) {
  constexpr const char* marks[] = {"line", "dashes", "points", "bars", "steps"};
  Json json{{"name", curve.name}, {"mark", marks[std::size_t(curve.mark)]}};
  json["x"] = numbers(curve.x), json["y"] = numbers(curve.y);
  json["color"] = color;
  if (curve.width > 0) json["width"] = curve.width;
  if (!curve.low.empty()) json["low"] = numbers(curve.low), json["high"] = numbers(curve.high);
  return json;
}

// Values as 16-bit floats, little end first, in 64 letters.
std::string packed(const std::vector<float>& values) {
  std::string bytes;
  bytes.reserve(2 * values.size());
  for (float x : values) {
    const std::uint16_t half = float_to_half(std::clamp(x, -65504.0f, 65504.0f));
    bytes += char(half & 0xff), bytes += char(half >> 8);
  }
  return base64(bytes);
}

// One section, by its kind.
struct SectionWriter {
  bool with_pictures;

  Json operator()(const Text& text) const { return {{"kind", "text"}, {"text", text.text}}; }
  Json operator()(const Formula& formula) const {
    return {{"kind", "formula"}, {"latex", formula.latex}, {"source", formula.source}};
  }
  Json operator()(const Table& table) const {
    Json rows = Json::array();
    for (const auto& row : table.rows) {
      Json cells = Json::array();
      for (const Cell& cell : row)
        cells.push_back(std::holds_alternative<double>(cell) ? number(std::get<double>(cell))
                                                             : Json(std::get<std::string>(cell)));
      rows.push_back(std::move(cells));
    }
    Json json{{"kind", "table"}, {"name", table.name}, {"caption", table.caption}};
    json["columns"] = table.columns, json["rows"] = std::move(rows);
    return json;
  }
  Json operator()(const Facts& facts) const {
    Json rows = Json::array();
    for (const auto& [name, value] : facts.rows) rows.push_back({name, value});
    return {{"kind", "facts"}, {"rows", std::move(rows)}};
  }
  Json operator()(const Figure& figure) const {
    Json json{{"kind", "figure"}, {"name", figure.name}, {"caption", figure.caption}};
    json["x"] = to_json(figure.x), json["y"] = to_json(figure.y), json["square"] = figure.square;
    json["curves"] = Json::array();
    for (std::size_t i = 0; i < figure.curves.size(); ++i)
      json["curves"].push_back(to_json(figure.curves[i], color_of(figure, i)));
    return json;
  }
  Json operator()(const Images& images) const {
    Json json{{"kind", "images"}, {"name", images.name}, {"caption", images.caption}, {"columns", images.columns}};
    constexpr const char* views[] = {"grid", "slider", "flip"};
    json["view"] = views[std::size_t(images.view)];
    json["pictures"] = Json::array();
    for (const Picture& picture : images.pictures) {
      Json one{{"caption", picture.caption}, {"width", picture.width}, {"height", picture.height}};
      if (with_pictures) one["src"] = "data:image/png;base64," + base64(to_png(picture));
      json["pictures"].push_back(std::move(one));
    }
    return json;
  }
  Json operator()(const PictureComparison& comparison) const {
    Json json{{"kind", "comparison"}, {"name", comparison.name}, {"caption", comparison.caption}};
    json["pictures"] = Json::array();
    for (const MeasuredPicture& picture : comparison.pictures) {
      Json one{{"name", picture.name},
               {"width", picture.width},
               {"height", picture.height},
               {"samples", number(picture.samples)},
               {"set", picture.set}};
      if (with_pictures) {
        one["mean"] = packed(picture.mean), one["error"] = packed(picture.error);
        one["repeats"] = Json::array();
        for (const std::vector<float>& repeat : picture.repeats) one["repeats"].push_back(packed(repeat));
      }
      json["pictures"].push_back(std::move(one));
    }
    return json;
  }
  Json operator()(const Verdict& verdict) const {
    return {{"kind", "verdict"}, {"claim", verdict.claim}, {"detail", verdict.detail}, {"passed", verdict.passed}};
  }
  Json operator()(const Commands& commands) const { return {{"kind", "commands"}, {"lines", commands.lines}}; }
};

}  // namespace

std::string to_json(const ReportSet& set, bool with_pictures) {
  Json json{{"title", set.title}, {"subtitle", set.subtitle}, {"reports", Json::array()}};
  for (const Report& report : set.reports) {
    Json one{{"name", report.name}, {"title", report.title}, {"group", report.group}, {"passed", report.passed()}};
    one["sections"] = Json::array();
    for (const Section& section : report.sections)
      one["sections"].push_back(std::visit(SectionWriter{with_pictures}, section));
    json["reports"].push_back(std::move(one));
  }
  return json_text(std::move(json)) + "\n";
}

}  // namespace montelux::lab
