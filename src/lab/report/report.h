// A report as plain data: what a page, a table of numbers and a figure for a paper are made from.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace montelux::lab {

// ---- figures --------------------------------------------------------------------------------------------------------

enum class Mark : std::uint8_t { line, dashes, points, bars, steps };

// y over x, of one size. `low` and `high`, both empty or of that size, bound an error band (lines) or error bars
// (points, bars). The x of all but points ascend. Bars stand at their middle, steps begin at x. A curve without a name
// is not in the legend. `color` counts through the palette; where it is negative, the curve has the next one.
struct Curve {
  std::string name;
  Mark mark = Mark::line;
  std::vector<double> x, y;
  std::vector<double> low, high;
  int color = -1;
  double width = 0;  // of bars; 0: the distance of the first two
};

// `label` may hold formulas in dollars. Without bounds the axis fits its data.
struct Axis {
  std::string label;
  bool logarithmic = false;
  std::optional<double> low, high;
  std::vector<std::string> names{};  // of the places 1, 2, ... of an axis that has no numbers
};

// `name` is unique in its report and good for a file. `square`: both axes have one scale.
struct Figure {
  std::string name, caption;
  Axis x, y;
  std::vector<Curve> curves;
  bool square = false;
};

// The colour of a curve, counted through the palette.
int color_of(const Figure& figure, std::size_t curve);

// ---- pictures -------------------------------------------------------------------------------------------------------

// Eight bits a component, red, green, blue; the top row first.
struct Picture {
  std::string caption;
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

// How pictures are first shown. The reader can change it: side by side, two with a slider between them, or one after
// the other at one place.
enum class ImagesView : std::uint8_t { grid, slider, flip };

// Pictures that are compared: they zoom and pan together, and so should be of one size.
struct Images {
  std::string name, caption;
  int columns = 4;
  std::vector<Picture> pictures;
  ImagesView view = ImagesView::grid;
};

// A picture in linear values, as an estimate: three components a pixel, or one, the top row first.
struct MeasuredPicture {
  std::string name;
  int width = 0, height = 0;
  std::vector<float> mean;
  std::vector<float> error;                 // standard error of the mean; empty: exact
  std::vector<std::vector<float>> repeats;  // luminance by repeat, one value per pixel; may be empty
  double samples = 0;                       // a pixel, in each repeat
  std::string set = "pictures";             // those of one set are shown together
};

// Pictures of one size to be held side by side, over each other, and read out by pixel, one set at a time. The first is
// the reference.
struct PictureComparison {
  std::string name, caption;
  std::vector<MeasuredPicture> pictures;
};

// ---- the rest -------------------------------------------------------------------------------------------------------

// A paragraph. Formulas are enclosed in dollars, code in backticks.
struct Text {
  std::string text;
};
// In LaTeX; `source` says where it is found.
struct Formula {
  std::string latex, source;
};
using Cell = std::variant<std::string, double>;
struct Table {
  std::string name, caption;
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;
};
// What a report is of, as names and values.
struct Facts {
  std::vector<std::pair<std::string, std::string>> rows;
};
// A claim and how it was decided: `detail` gives statistic, p-value and level.
struct Verdict {
  std::string claim, detail;
  bool passed = false;
};
struct Commands {
  std::vector<std::string> lines;
};

using Section = std::variant<Text, Formula, Table, Facts, Figure, Images, PictureComparison, Verdict, Commands>;

// `name` is good for a file and for a link; `group` gathers the reports of a page.
struct Report {
  std::string name, title, group;
  std::vector<Section> sections;

  // Every verdict holds.
  bool passed() const;
};

// What one run made.
struct ReportSet {
  std::string title, subtitle;
  std::vector<Report> reports;
};

}  // namespace montelux::lab
