// Settings that are stated once: table, default and reader from one row.
#include "parameter/fields.h"

#include <gtest/gtest.h>

#include "parameter/choice.h"

namespace montelux::test {
namespace {

enum class Order { first, last };

struct Inner {
  float width = 0.25f;
};
struct Settings {
  int count = 3;
  bool fast = true;
  Order order = Order::last;
  std::string text = "8/4";
  Inner inner;
};

Fields<Settings> fields() {
  Fields<Settings> all;
  all.integer("count", &Settings::count, "how many", 0, 10)
      .boolean("fast", &Settings::fast, "whether in a hurry")
      .number(
          "width", [](Settings& s) -> float& { return s.inner.width; }, "in pixels", 0, 1)
      .choice<Order>("order", &Settings::order, "which comes first", {{"first", Order::first}, {"last", Order::last}})
      .text(
          "text", "numbers",
          [](const std::string& text, Settings& s) -> Status {
            if (text.empty()) return Failure{"no text"};
            s.text = text;
            return Done{};
          },
          [](const Settings& s) { return s.text; })
      .other({"elsewhere", {ParameterType::integer}, "read by another; default none"});
  return all;
}

std::string meanings(const std::vector<ParameterSpec>& specs) {
  std::string all;
  for (const ParameterSpec& spec : specs) all += std::string(spec.name) + ": " + spec.meaning + "\n";
  return all;
}

Result<ParameterList> typed(const std::vector<Setting>& settings) {
  static const std::vector<ParameterSpec> specs = fields().specs({});
  return read_settings({"thing", "a thing", specs}, settings, "kind");
}

TEST(Fields, show_the_defaults_of_the_struct) {
  EXPECT_EQ(meanings(fields().specs({})),
            "count: how many; default 3\nfast: whether in a hurry; default on\nwidth: in pixels; default 0.25\n"
            "order: which comes first; default last\ntext: numbers; default 8/4\n"
            "elsewhere: read by another; default none\n");
  Settings other;
  other.count = 5, other.order = Order::first;
  EXPECT_EQ(meanings(fields().specs({}, other, "without groups")),
            "count: how many; default 3, without groups 5\nfast: whether in a hurry; default on\n"
            "width: in pixels; default 0.25\norder: which comes first; default last, without groups first\n"
            "text: numbers; default 8/4\nelsewhere: read by another; default none\n");
}

TEST(Fields, leave_what_is_not_stated) {
  Settings s;
  s.count = 7, s.inner.width = 0.5f, s.order = Order::first, s.text = "1";
  ASSERT_TRUE(fields().read({}, s));
  EXPECT_EQ(s.count, 7);
  EXPECT_EQ(s.inner.width, 0.5f);
  EXPECT_EQ(s.order, Order::first);
  EXPECT_EQ(s.text, "1");
}

TEST(Fields, store_what_is_stated) {
  const auto list = typed({{"count", "4"}, {"fast", "off"}, {"width", "0.75"}, {"order", "first"}, {"text", "2/1"}});
  ASSERT_TRUE(list);
  Settings s;
  ASSERT_TRUE(fields().read(*list, s));
  EXPECT_EQ(s.count, 4);
  EXPECT_FALSE(s.fast);
  EXPECT_EQ(s.inner.width, 0.75f);
  EXPECT_EQ(s.order, Order::first);
  EXPECT_EQ(s.text, "2/1");
  EXPECT_TRUE(list->unused().empty());
}

TEST(Fields, give_the_range_and_the_choices_to_the_table) {
  EXPECT_FALSE(typed({{"count", "11"}}));
  EXPECT_NE(typed({{"order", "firts"}}).error().find("did you mean \"first\""), std::string::npos);
}

TEST(Fields, fail_where_a_text_cannot_be_read) {
  ParameterList list;
  list.add({"text", ParameterType::string, std::vector<std::string>{""}, {}});
  Settings s;
  EXPECT_EQ(fields().read(list, s).error(), "no text");
}

// The planted fault: a row that nobody reads stays unused, which the catalogue of integrators refuses.
TEST(Fields, leave_a_row_of_others_unused) {
  const auto list = typed({{"elsewhere", "1"}, {"count", "1"}});
  ASSERT_TRUE(list);
  Settings s;
  ASSERT_TRUE(fields().read(*list, s));
  ASSERT_EQ(list->unused().size(), 1u);
  EXPECT_EQ(list->unused().front()->name, "elsewhere");
}

}  // namespace
}  // namespace montelux::test
