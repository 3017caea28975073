// The documentation of the experiments agrees with their table.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "api/lab.h"

namespace montelux {
namespace {

const std::filesystem::path folder = MONTELUX_SOURCE_DIR "/docs/lab";
const std::filesystem::path contents = MONTELUX_SOURCE_DIR "/docs/lab.md";
constexpr std::string_view marker =
    "<!-- What follows is printed from the table of experiments; the test of it can rewrite it. -->\n";

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

std::string list_of(const std::vector<ExperimentPage>& pages) {
  std::string text, group;
  for (const ExperimentPage& page : pages) {
    if (page.group != group) text += "\n## " + page.group + "\n\n";
    group = page.group;
    text += "- [" + page.title + "](lab/" + page.name + ".md): `montelux lab run " + page.name + " -o out`\n";
  }
  return text;
}

// Images contain numbers whose last digits depend on the machine: only their presence is tested.
TEST(LabDocument, holds_the_experiments_as_they_are) {
  const std::vector<ExperimentPage> pages = document_experiments();
  const std::string text = read(contents);
  const std::size_t at = text.find(marker);
  ASSERT_NE(at, std::string::npos) << contents;
  const std::string list = text.substr(0, at + marker.size()) + list_of(pages);
  // To rewrite it: MONTELUX_WRITE_DOCUMENTS=1 analytic_lab --gtest_filter=LabDocument.*
  if (std::getenv("MONTELUX_WRITE_DOCUMENTS")) {
    write(contents, list);
    for (const ExperimentPage& page : pages) {
      write(folder / (page.name + ".md"), page.markdown);
      for (const auto& [name, picture] : page.pictures) write(folder / page.name / name, picture);
    }
  }
  EXPECT_EQ(read(contents), list);
  for (const ExperimentPage& page : pages) {
    EXPECT_EQ(read(folder / (page.name + ".md")), page.markdown) << page.name;
    for (const auto& [name, picture] : page.pictures)
      EXPECT_TRUE(std::filesystem::exists(folder / page.name / name)) << page.name << "/" << name;
  }
}

}  // namespace
}  // namespace montelux
