// The document of the format agrees with the tables.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "io/pbrt/parser.h"
#include "io/pbrt_reference.h"

namespace montelux {
namespace {

const std::string document = MONTELUX_SOURCE_DIR "/docs/formats.md";
constexpr std::string_view marker =
    "<!-- What follows is printed from the tables; the test of it can rewrite it. -->\n";

std::string read_document() {
  std::ifstream file(document, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(FormatsDocument, holds_the_tables_as_they_are) {
  std::string text = read_document();
  std::size_t at = text.find(marker);
  ASSERT_NE(at, std::string::npos) << document;
  std::string before = text.substr(0, at + marker.size());
  // To rewrite it: MONTELUX_WRITE_DOCUMENTS=1 unit_io --gtest_filter=FormatsDocument.*
  if (std::getenv("MONTELUX_WRITE_DOCUMENTS"))
    std::ofstream(document, std::ios::binary) << before << "\n" << pbrt_reference();
  EXPECT_EQ(read_document(), before + "\n" + pbrt_reference());
}

TEST(FormatsDocument, names_every_directive) {
  std::string text = read_document();
  for (std::string_view name : pbrt::Parser::directive_names())
    EXPECT_NE(text.find(std::string(1, '`').append(name) + '`'), std::string::npos) << name;
}

}  // namespace
}  // namespace montelux
