// Reports as JSON, CSV, SVG, PNG and HTML.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "image/image_file.h"
#include "lab/report/axis_scale.h"
#include "lab/report/base64.h"
#include "lab/report/page.h"
#include "lab/report/write.h"

namespace montelux::lab {
namespace {

Figure small_figure() {
  Figure figure{"curve", "A <caption> & more", {"$x$", true, {}, {}}, {"$\\sigma^2$", false, {}, {}}, {}, false};
  figure.curves = {{"line", Mark::line, {1, 10, 100}, {1, 2, 3}, {0.5, 1.5, 2.5}, {1.5, 2.5, 3.5}},
                   {"points", Mark::points, {1, 100}, {1, std::numeric_limits<double>::quiet_NaN()}, {}, {}}};
  return figure;
}

ReportSet small_set() {
  Report report{"first", "A title with </script><b> in it", "group", {}};
  report.sections = {
      Text{"Words with $x^2$ and \"quotes\"."},
      Formula{"\\frac{1}{2}", "somewhere"},
      small_figure(),
      Table{"numbers", "", {"name", "value"}, {{"a", 1.5}, {"b, c", std::numeric_limits<double>::infinity()}}},
      Images{"pictures", "", 2, {{"red", 2, 1, {255, 0, 0, 0, 0, 255}}}},
      Verdict{"It holds.", "p = 0.5", true},
      Commands{{"montelux lab list"}}};
  return {"Title", "", {report}};
}

TEST(Base64, is_that_of_rfc_4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(Base64, is_read_back_and_refused_where_it_is_damaged) {
  for (const std::string bytes : {"", "f", "fo", "foo", "foob", "\xff\x80\x01"})
    EXPECT_EQ(bytes_of_base64(base64(bytes)), bytes);
  for (const char* text : {"Zg=", "Zg", "Z===", "Z*==", "Zg==Zg==", "Zg=v"})
    EXPECT_FALSE(bytes_of_base64(text)) << text;
}

TEST(ReportSvg, has_bars_side_by_side_over_names) {
  Figure figure{"bars", "", {"kind", false, 0.5, 2.5, {"first", "second"}}, {"share", false, {}, {}}, {}, false};
  figure.curves = {{"a", Mark::bars, {0.8, 1.8}, {1, 2}, {}, {}, 0, 0.4},
                   {"b", Mark::bars, {1.2, 2.2}, {2, 1}, {}, {}, 1, 0.4}};
  const std::string svg = to_svg(figure), json = to_json(ReportSet{"t", "", {{"r", "r", "", {figure}}}});
  EXPECT_NE(svg.find(">first</text>"), std::string::npos);
  EXPECT_NE(svg.find(">second</text>"), std::string::npos);
  EXPECT_NE(json.find("\"names\":[\"first\",\"second\"]"), std::string::npos);
  EXPECT_NE(json.find("\"width\":0.4"), std::string::npos);
}

TEST(ReportCsv, quotes_what_must_be_quoted_and_leaves_out_what_is_no_number) {
  Table table{"t", "", {"name", "value"}, {{"a, \"b\"", 0.1}, {"c", std::numeric_limits<double>::quiet_NaN()}}};
  EXPECT_EQ(to_csv(table), "name,value\n\"a, \"\"b\"\"\",0.1\nc,\n");
  EXPECT_EQ(
      to_csv(small_figure()),
      "curve,x,y,low,high\nline,1,1,0.5,1.5\nline,10,2,1.5,2.5\nline,100,3,2.5,3.5\npoints,1,1,,\npoints,100,,,\n");
}

TEST(ReportJson, writes_what_is_not_finite_as_null) {
  const std::string json = to_json(small_set());
  EXPECT_NE(json.find("\"y\":[1.0,null]"), std::string::npos) << json;
  EXPECT_EQ(json.find("nan"), std::string::npos);
  EXPECT_EQ(json.find("inf"), std::string::npos);
}

TEST(ReportJson, carries_pictures_only_where_requested) {
  EXPECT_NE(to_json(small_set(), true).find("data:image/png;base64,iVBOR"), std::string::npos);
  EXPECT_EQ(to_json(small_set(), false).find("base64"), std::string::npos);
}

TEST(ReportPng, is_read_back_as_it_was_by_another_reader) {
  Picture picture{"", 3, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 10, 20, 30, 255, 255, 255, 0, 0, 0}};
  const auto path = std::filesystem::temp_directory_path() / "montelux-report-test.png";
  std::ofstream(path, std::ios::binary) << to_png(picture);
  Result<Image> read = read_image(path.string());
  std::filesystem::remove(path);
  ASSERT_TRUE(read) << read.error();
  const PixelBuffer* image = &read->pixels;
  ASSERT_EQ(image->width, 3);
  ASSERT_EQ(image->height, 2);
  EXPECT_EQ(image->at(0, 0, 0), 1.0f);
  EXPECT_EQ(image->at(1, 0, 1), 1.0f);
  EXPECT_EQ(image->at(0, 0, 1), 0.0f);
  EXPECT_EQ(image->at(1, 1, 2), 1.0f);
  EXPECT_GT(image->at(0, 1, 2), image->at(0, 1, 0));
}

TEST(ReportPng, refuses_a_picture_without_its_pixels) {
  EXPECT_THROW((void)to_png({"", 2, 2, {1, 2, 3}}), std::invalid_argument);
}

TEST(ReportSvg, has_a_path_for_a_line_and_circles_for_finite_points) {
  const std::string svg = to_svg(small_figure());
  EXPECT_TRUE(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  std::size_t circles = 0;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) ++circles;
  EXPECT_EQ(circles, 2u);  // one point that can be drawn, and one in the legend
  EXPECT_NE(svg.find("σ²"), std::string::npos);
}

TEST(AxisScale, puts_decades_at_equal_distances_and_ticks_at_round_numbers) {
  const AxisScale log{1, 1000, true};
  EXPECT_NEAR(log.place(10), 1.0 / 3, 1e-12);
  EXPECT_TRUE(std::isnan(log.place(0)));
  const AxisScale linear = scale_of({"", false, 0.0, 10.0}, {}, false);
  std::vector<double> values;
  for (const Tick& tick : linear.ticks()) values.push_back(tick.value);
  EXPECT_EQ(values, (std::vector<double>{0, 2, 4, 6, 8, 10}));
}

TEST(AxisScale, of_one_value_or_none_has_a_width) {
  for (bool logarithmic : {false, true})
    for (const std::vector<double>& values : {std::vector<double>{}, std::vector<double>{3}}) {
      const AxisScale scale = scale_of({"", logarithmic, {}, {}}, values, false);
      EXPECT_LT(scale.low, scale.high);
    }
}

TEST(ReportPage, holds_its_data_where_no_script_can_end_by_it) {
  const Result<std::string> html = to_html(small_set());
  if (page().html.empty()) GTEST_SKIP() << page().why;
  ASSERT_TRUE(html);
  EXPECT_EQ(html->find("A title with </script>"), std::string::npos);
  EXPECT_NE(html->find("A title with \\u003c/script>"), std::string::npos);
  EXPECT_EQ(html->find(page_data_mark), std::string::npos);
}

TEST(WriteReports, makes_a_folder_with_every_file_it_names) {
  const auto folder = std::filesystem::temp_directory_path() / "montelux-write-reports-test";
  std::filesystem::remove_all(folder);
  const Result<WrittenReports> written = write_reports(small_set(), folder / "deep");
  ASSERT_TRUE(written);
  for (const auto& file : written->files) EXPECT_TRUE(std::filesystem::exists(folder / "deep" / file)) << file;
  for (const char* file :
       {"report.json", "first/curve.svg", "first/curve.csv", "first/numbers.csv", "first/pictures-1.png"})
    EXPECT_TRUE(std::filesystem::exists(folder / "deep" / file)) << file;
  EXPECT_EQ(written->page.has_value(), !page().html.empty());
  EXPECT_EQ(written->why_no_page.empty(), !page().html.empty());
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace montelux::lab
