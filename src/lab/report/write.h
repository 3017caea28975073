// Reports as text: JSON, CSV, SVG and the self-contained page; and a folder of them.
#pragma once
#include <filesystem>

#include "lab/report/report.h"
#include "math/result.h"

namespace montelux::lab {

// One JSON object, the form that the page reads (web/src/report.ts states it). Pictures are PNG in data URIs where
// `with_pictures`, else only their captions and sizes. Numbers have seven digits; those that are not finite are null.
std::string to_json(const ReportSet& set, bool with_pictures = true);

// Comma-separated values with a line of names (RFC 4180). A figure has one row a point: curve, x, y, low, high.
std::string to_csv(const Table& table);
std::string to_csv(const Figure& figure);

// A figure for paper: SVG 1.1 with a white ground and no script. Formulas in labels are written as plain text.
std::string to_svg(const Figure& figure);

// PNG, 8 bits of red, green and blue.
std::string to_png(const Picture& picture);

// The page with the reports inside: one HTML file that needs no network. Fails where the page was not built, and says
// why.
Result<std::string> to_html(const ReportSet& set);

// What write_reports has written, relative to the folder.
struct WrittenReports {
  std::vector<std::filesystem::path> files;
  std::optional<std::filesystem::path> page;
  std::string why_no_page;
};

// Writes report.html and report.json into the folder, which is made where it is missing, and for each report a folder
// of its name with its figures (.svg, .csv), tables (.csv) and pictures (.png).
Result<WrittenReports> write_reports(const ReportSet& set, const std::filesystem::path& folder);

}  // namespace montelux::lab
