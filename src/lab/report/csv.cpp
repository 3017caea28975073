#include <fmt/format.h>

#include <cmath>

#include "lab/report/write.h"

namespace montelux::lab {

namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string result = "\"";
  for (char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

std::string number(double x) { return std::isfinite(x) ? fmt::format("{}", x) : ""; }

std::string line_of(const std::vector<std::string>& cells) { return fmt::format("{}\n", fmt::join(cells, ",")); }

}  // namespace

std::string to_csv(const Table& table) {
  std::vector<std::string> cells;
  for (const std::string& column : table.columns) cells.push_back(quoted(column));
  std::string text = line_of(cells);
  for (const auto& row : table.rows) {
    cells.clear();
    for (const Cell& cell : row)
      cells.push_back(std::holds_alternative<double>(cell) ? number(std::get<double>(cell))
                                                           : quoted(std::get<std::string>(cell)));
    text += line_of(cells);
  }
  return text;
}

std::string to_csv(const Figure& figure) {
  std::string text = "curve,x,y,low,high\n";
  for (const Curve& curve : figure.curves)
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      text += line_of({quoted(curve.name), number(curve.x[i]), number(curve.y[i]),
                       curve.low.empty() ? "" : number(curve.low[i]), curve.high.empty() ? "" : number(curve.high[i])});
  return text;
}

}  // namespace montelux::lab
