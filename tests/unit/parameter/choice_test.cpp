#include "parameter/choice.h"

#include <gtest/gtest.h>

namespace montelux {
namespace {

using enum ParameterType;

const EntitySpec dish{"soup",
                      "hot",
                      {{"salt", {number}, "grams", 0, 10},
                       {"spoons", {integer}, "how many", 1, 4},
                       {"warm", {boolean}, "default true"},
                       {"bowl", {string}, "which", 0, 0, {"deep", "flat"}},
                       {"most", {integer}, "most; none: no bound", 0, 2147483647, {"none"}},
                       {"guests", {integer}, "how many", 1, 9, {}, false, false, "eaters"}}};

TEST(Choice, splits_a_name_from_its_settings) {
  const auto choice = parse_choice("soup:salt=0.5,bowl=f(1,2)");
  ASSERT_TRUE(choice);
  EXPECT_EQ(choice->name, "soup");
  EXPECT_EQ(choice->settings, (std::vector<Setting>{{"salt", "0.5"}, {"bowl", "f(1,2)"}}));
  EXPECT_EQ(parse_choice("soup")->settings.size(), 0u);
}

TEST(Choice, refuses_what_is_not_key_and_value) {
  for (const char* text : {"", ":a=1", "soup:", "soup:salt", "soup:salt=", "soup:=1", "soup:salt=1,,"})
    EXPECT_FALSE(parse_choice(text)) << text;
}

TEST(Choice, reads_each_type) {
  const auto list =
      read_settings(dish, {{"salt", "2.5"}, {"spoons", "3"}, {"warm", "off"}, {"bowl", "flat"}, {"most", "7"}}, "dish");
  ASSERT_TRUE(list) << list.error();
  EXPECT_EQ(list->number("salt", 0), 2.5f);
  EXPECT_EQ(list->integer("spoons", 0), 3);
  EXPECT_FALSE(list->boolean("warm", true));
  EXPECT_EQ(list->string("bowl", ""), "flat");
  EXPECT_EQ(list->integer("most", 0), 7);
}

TEST(Choice, accepts_an_earlier_name_as_the_present_one) {
  const auto list = read_settings(dish, {{"eaters", "4"}}, "dish");
  ASSERT_TRUE(list) << list.error();
  EXPECT_EQ(list->integer("guests", 0), 4);
  EXPECT_EQ(list->find("eaters"), nullptr);
  EXPECT_FALSE(read_settings(dish, {{"eaters", "10"}}, "dish"));
}

TEST(Choice, none_lifts_a_bound) { EXPECT_EQ(read_settings(dish, {{"most", "none"}}, "dish")->find("most"), nullptr); }

TEST(Choice, names_everything_that_is_wrong_at_once) {
  const auto list = read_settings(
      dish, {{"slat", "1"}, {"spoons", "9"}, {"salt", "nan"}, {"warm", "maybe"}, {"bowl", "round"}, {"most", "-1"}},
      "dish");
  ASSERT_FALSE(list);
  for (const char* part : {"did you mean \"salt\"", "spoons takes a whole number from 1 to 4; found \"9\"",
                           "salt takes a number", "warm takes true or false", "bowl takes deep, flat", "most takes"})
    EXPECT_NE(list.error().find(part), std::string::npos) << part << " in " << list.error();
}

}  // namespace
}  // namespace montelux
