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

struct Paint {
  NumberInput gloss = 0.5f;
  SpectrumInput color = gray_value(0.25f);
  std::optional<IndexInput> index;
  SpectrumValue glow = gray_value(0);
  std::optional<SpectrumValue> glaze;
  Vec3f along{0, 0, 1};
};

Fields<Paint> paint() {
  Fields<Paint> all;
  all.input<NumberInput>("gloss", &Paint::gloss, "share", 0, 1)
      .input<SpectrumInput>("color", &Paint::color, "albedo", 0, 1)
      .optional_input<IndexInput>("index", &Paint::index, "of refraction; default none", 1, 9)
      .spectrum("glow", &Paint::glow, "radiance", 0, 9)
      .optional("glaze", &Paint::glaze, "of the coat; default that of color", 0, 1)
      .only_if([](const Paint& p) { return p.index.has_value(); })
      .vector("along", ParameterType::vector3, &Paint::along, "axis");
  return all;
}

Parameter stated(std::string name, ParameterType type, Values values) {
  return {std::move(name), type, std::move(values), {nullptr, 3, 4}};
}

TEST(Inputs, show_their_defaults_and_take_the_types_of_their_alternatives) {
  const std::vector<ParameterSpec> specs = paint().specs({});
  EXPECT_EQ(meanings(specs),
            "gloss: share; default 0.5\ncolor: albedo; default 0.25\nindex: of refraction; default none\n"
            "glow: radiance; default 0\nglaze: of the coat; default that of color\nalong: axis; default 0 0 1\n");
  using enum ParameterType;
  EXPECT_EQ(specs[0].types, (std::vector{number, texture}));
  EXPECT_EQ(specs[1].types, (std::vector{spectrum, texture}));
  EXPECT_EQ(specs[2].types, (std::vector{number, spectrum}));
  EXPECT_EQ(specs[5].types, (std::vector{vector3}));
}

TEST(Inputs, are_read_with_their_places_and_written_again) {
  using enum ParameterType;
  ParameterList list;
  list.add(stated("gloss", texture, TextureName{"dust"}));
  list.add(stated("color", spectrum, std::vector<SpectrumValue>{NamedSpectrum{"red"}}));
  list.add(stated("index", number, std::vector<float>{2}));
  list.add(stated("glow", spectrum, std::vector<SpectrumValue>{Blackbody{3000}}));
  list.add(stated("glaze", spectrum, std::vector<SpectrumValue>{gray_value(1)}));
  list.add(stated("along", vector3, std::vector<Vec3f>{{1, 2, 3}}));
  Paint p;
  ASSERT_TRUE(paint().read(list, p));
  EXPECT_TRUE(list.unused().empty());
  ASSERT_TRUE(p.gloss.get<TextureName>());
  EXPECT_EQ(p.gloss.get<TextureName>()->name, "dust");
  EXPECT_EQ(p.gloss.where.line, 3);
  ASSERT_TRUE(p.index);
  EXPECT_EQ(*p.index->get<float>(), 2);
  EXPECT_TRUE(p.color == SpectrumInput(SpectrumValue(NamedSpectrum{"red"})));
  EXPECT_EQ(p.along.z, 3);

  Paint again;
  const ParameterList written = paint().write(p, {});
  ASSERT_EQ(written.all().size(), 6u);
  ASSERT_TRUE(paint().read(written, again));
  EXPECT_TRUE(again.gloss == p.gloss && again.color == p.color && again.index == p.index && again.glow == p.glow &&
              again.glaze == p.glaze && again.along.y == p.along.y);
  // What has its default is not written.
  EXPECT_TRUE(paint().write({}, {}).all().empty());
}

TEST(Fields, of_arrays_have_defaults_and_take_lists_of_their_length) {
  struct Map {
    std::array<float, 2> scale{1, 0.5f};
  };
  Fields<Map> all;
  all.list<2>("scale", &Map::scale, "of x and y", -9, 9).later();
  const ParameterSpec spec = all.specs({}).front();
  EXPECT_EQ(spec.meaning, "of x and y; default 1 0.5");
  EXPECT_TRUE(spec.array && spec.later);
  ParameterList list;
  list.add(stated("scale", ParameterType::number, std::vector<float>{2, -3}));
  Map map;
  ASSERT_TRUE(all.read(list, map));
  EXPECT_EQ(map.scale, (std::array<float, 2>{2, -3}));
  EXPECT_EQ(all.write(map, {}).array<float>("scale"), (std::vector<float>{2, -3}));
  EXPECT_TRUE(all.write({}, {}).all().empty());
  ParameterList longer;
  longer.add(stated("scale", ParameterType::number, std::vector<float>{4, 5, 6}));
  ASSERT_TRUE(all.read(longer, map));
  EXPECT_EQ(map.scale[0], 2);
}

TEST(Inputs, without_effect_count_as_unused) {
  using enum ParameterType;
  ParameterList list;
  list.add(stated("glaze", spectrum, std::vector<SpectrumValue>{gray_value(1)}));
  list.add(stated("gloss", number, std::vector<float>{1}));
  Paint p;
  ASSERT_TRUE(paint().read(list, p));
  ASSERT_EQ(list.unused().size(), 1u);
  EXPECT_EQ(list.unused()[0]->name, "glaze");
  list.add(stated("index", number, std::vector<float>{2}));
  ASSERT_TRUE(paint().read(list, p));
  EXPECT_TRUE(list.unused().empty());
}

}  // namespace
}  // namespace montelux::test
