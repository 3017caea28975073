#include "lab/report/write.h"

#include "image/output_file.h"
#include "lab/report/page.h"

namespace montelux::lab {

namespace {

// JSON that no reader of HTML takes for the end of its script or for a comment.
std::string inside_script(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  for (char c : json) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

class Folder {
 public:
  Folder(std::filesystem::path folder, WrittenReports& written) : folder_(std::move(folder)), written_(written) {}

  Status write(const std::filesystem::path& name, const std::string& content) {
    const std::filesystem::path path = folder_ / name;
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    if (error) return Failure{"cannot create the folder " + path.parent_path().string() + ": " + error.message()};
    written_.files.push_back(name);
    return write_file(path, content);
  }

 private:
  std::filesystem::path folder_;
  WrittenReports& written_;
};

Status write_section(Folder& folder, const std::filesystem::path& report, const Section& section) {
  if (const auto* table = std::get_if<Table>(&section))
    return folder.write(report / (table->name + ".csv"), to_csv(*table));
  if (const auto* figure = std::get_if<Figure>(&section)) {
    if (Status s = folder.write(report / (figure->name + ".svg"), to_svg(*figure)); !s) return s;
    return folder.write(report / (figure->name + ".csv"), to_csv(*figure));
  }
  if (const auto* images = std::get_if<Images>(&section))
    for (std::size_t i = 0; i < images->pictures.size(); ++i) {
      const std::string name = images->name + "-" + std::to_string(i + 1) + ".png";
      if (Status s = folder.write(report / name, to_png(images->pictures[i])); !s) return s;
    }
  return Done{};
}

}  // namespace

Result<std::string> to_html(const ReportSet& set) {
  const Page built = page();
  if (built.html.empty()) return Failure{std::string(built.why)};
  const std::size_t mark = built.html.find(page_data_mark);
  if (mark == std::string_view::npos) return Failure{"the page has no slot for a report"};
  return std::string(built.html.substr(0, mark)) + inside_script(to_json(set)) +
         std::string(built.html.substr(mark + page_data_mark.size()));
}

Result<WrittenReports> write_reports(const ReportSet& set, const std::filesystem::path& folder) {
  WrittenReports written;
  Folder out(folder, written);
  for (const Report& report : set.reports)
    for (const Section& section : report.sections)
      if (Status s = write_section(out, report.name, section); !s) return s.failure();
  if (Status s = out.write("report.json", to_json(set, false)); !s) return s.failure();
  Result<std::string> html = to_html(set);
  if (!html) {
    written.why_no_page = html.error();
    return written;
  }
  if (Status s = out.write("report.html", *html); !s) return s.failure();
  written.page = folder / "report.html";
  return written;
}

}  // namespace montelux::lab
