// Every kind of mistake, with the place and the words that the reader must give back.
#include <gtest/gtest.h>

#include <ostream>

#include "io/pbrt.h"
#include "io/report.h"
#include "io/text_file.h"
#include "temporary_folder.h"

namespace montelux {
namespace {

struct Mistake {
  std::string name;
  std::string text;
  int line, column;
  std::string message, hint = {};
  Severity severity = Severity::error;
};

std::string listing(const Diagnostics& diagnostics) { return render(diagnostics, {false, false}); }

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.text; }

class Mistakes : public testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, are_reported_where_they_stand) {
  const Mistake& mistake = GetParam();
  ReadResult result = read_pbrt_text(mistake.text, ".");
  EXPECT_EQ(result.scene.has_value(), mistake.severity != Severity::error) << listing(result.diagnostics);
  for (const Diagnostic& d : result.diagnostics.all())
    if (d.severity == mistake.severity && d.where.line == mistake.line && d.where.column == mistake.column &&
        d.message.find(mistake.message) != std::string::npos && d.hint.find(mistake.hint) != std::string::npos)
      return;
  FAIL() << "expected " << mistake.line << ":" << mistake.column << ": " << mistake.message << "; found\n"
         << listing(result.diagnostics);
}

// Text that stands in the second line, behind WorldBegin.
Mistake world(std::string name, std::string text, int column, std::string message, std::string hint = {}) {
  return {std::move(name), "WorldBegin\n" + text + "\n", 2, column, std::move(message), std::move(hint)};
}
// Text that stands in the first line, before WorldBegin.
Mistake head(std::string name, std::string text, int column, std::string message, std::string hint = {}) {
  return {std::move(name), text + "\nWorldBegin\n", 1, column, std::move(message), std::move(hint)};
}
Mistake warned(Mistake mistake) {
  mistake.severity = Severity::warning;
  return mistake;
}
Mistake noted(Mistake mistake) {
  mistake.severity = Severity::note;
  return mistake;
}

std::string name_of_case(const testing::TestParamInfo<Mistake>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(
    words, Mistakes,
    testing::Values(
        world("unknown_directive", "Shap \"sphere\"", 1, "no directive 'Shap'", "Shape"),
        world("directive_expected", "42 Identity", 1, "a directive is expected"),
        world("stray_quote", "\"lonely\"", 1, "a directive is expected"),
        world("unclosed_quote", "Shape \"sphere", 7, "Shape takes the name"),
        world("unclosed_bracket", "Shape \"sphere\" \"float radius\" [ 1", 31, "not closed", ""),
        world("bracket_meets_directive", "Shape \"sphere\" \"float radius\" [ 1\nIdentity", 31, "not closed"),
        world("bracket_meets_parameter", "Shape \"sphere\" \"float radius\" [ 1 \"float zmin\" -1", 31, "not closed"),
        world("nested_bracket", "Shape \"sphere\" \"float radius\" [ [ 1 ] ]", 31, "not closed"),
        world("no_value", "Shape \"sphere\" \"float radius\"", 16, "has no value"),
        world("empty_list", "Shape \"sphere\" \"float radius\" [ ]", 31, "has no value"),
        world("header_without_name", "Shape \"sphere\" \"float\" 1", 16, "\"type name\""),
        world("unknown_type", "Shape \"sphere\" \"flot radius\" 1", 16, "'flot' is not a parameter type", "float"),
        world("missing_brackets", "Material \"diffuse\" \"rgb reflectance\" 1 0 0", 40, "needs brackets"),
        world("stated_twice", "Shape \"sphere\" \"float radius\" 1 \"float radius\" 2", 33, "stated twice")),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    values, Mistakes,
    testing::Values(world("not_a_number", "Shape \"sphere\" \"float radius\" [ 1x ]", 33, "finite numbers; found '1x'"),
                    world("nan", "Shape \"sphere\" \"float radius\" [ nan ]", 33, "finite numbers; found 'nan'"),
                    world("infinite", "Shape \"sphere\" \"float radius\" [ -inf ]", 33, "finite numbers"),
                    world("overflow", "Shape \"sphere\" \"float radius\" [ 1e39 ]", 33, "finite numbers"),
                    world("fractional_integer", "Shape \"loopsubdiv\" \"integer levels\" 1.5", 37, "integers"),
                    world("large_integer", "Shape \"loopsubdiv\" \"integer levels\" 99999999999", 37, "integers"),
                    world("bad_boolean", "AreaLightSource \"diffuse\" \"bool twosided\" yes", 43, "true or false"),
                    world("string_for_number", "Shape \"sphere\" \"float radius\" \"one\"", 31, "finite numbers"),
                    world("uneven_points", "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 ]", 22, "triples"),
                    world("uneven_rgb", "Material \"diffuse\" \"rgb reflectance\" [ 1 0 ]", 20, "triples"),
                    world("two_for_one", "Shape \"sphere\" \"float radius\" [ 1 2 ]", 16, "takes one value; found 2"),
                    world("negative_radius", "Shape \"sphere\" \"float radius\" -1", 16, "must be positive; found -1"),
                    world("reflectance_over_one", "Material \"diffuse\" \"rgb reflectance\" [ 1 1.5 0 ]", 20,
                          "at most 1; found 1.5"),
                    world("cold_blackbody", "LightSource \"point\" \"blackbody I\" 0", 21, "must be positive"),
                    world("odd_spectrum", "LightSource \"point\" \"spectrum I\" [ 400 1 500 ]", 21, "pairs"),
                    world("falling_wavelengths", "LightSource \"point\" \"spectrum I\" [ 500 1 400 1 ]", 21,
                          "wavelengths must increase"),
                    world("unknown_spectrum", "Material \"conductor\" \"spectrum eta\" \"metal-Cu-et\"", 37,
                          "neither a named spectrum", "metal-Cu-eta"),
                    world("wrong_type", "Shape \"sphere\" \"integer radius\" 1", 16, "must be float, not integer"),
                    world("unknown_parameter", "Shape \"sphere\" \"float radus\" 1", 16, "no parameter 'radus'",
                          "did you mean 'radius'"),
                    world("unknown_choice",
                          "Shape \"curve\" \"point3 P\" [ 0 0 0 1 0 0 2 0 0 3 0 0 ] \"string type\" \"flt\"", 54,
                          "'flt' is not a value of 'type'", "flat")),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    names, Mistakes,
    testing::Values(
        world("unknown_shape", "Shape \"spere\"", 7, "no shape 'spere'", "sphere"),
        world("unknown_material", "Material \"difuse\"", 10, "no material 'difuse'", "diffuse"),
        world("old_material", "Material \"matte\"", 10, "no material 'matte'", "'diffuse' in pbrt-v4"),
        world("undefined_material", "NamedMaterial \"gold\"", 15, "no material 'gold'"),
        world("near_material", "MakeNamedMaterial \"gold\" \"string type\" \"diffuse\" NamedMaterial \"gild\"", 64,
              "no material 'gild'", "gold"),
        world("material_without_type", "MakeNamedMaterial \"a\"", 1, "needs \"string type\""),
        world("material_twice",
              "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"a\" \"string type\" \"diffuse\"",
              47, "defined twice"),
        world("undefined_texture", "Material \"diffuse\" \"texture reflectance\" \"wood\"", 20, "no texture 'wood'"),
        world("texture_of_numbers",
              "Texture \"t\" \"float\" \"constant\" Material \"diffuse\" \"texture reflectance\" \"t\"", 51,
              "is of \"float\""),
        world("texture_kind", "Texture \"t\" \"colour\" \"constant\"", 13, "\"float\" or \"spectrum\""),
        world("texture_twice", "Texture \"t\" \"float\" \"constant\" Texture \"t\" \"float\" \"constant\"", 32,
              "defined twice"),
        world("texture_of_later_texture", "Texture \"t\" \"float\" \"scale\" \"texture tex\" \"t\"", 29,
              "before this one"),
        world("spectrum_in_number_texture", "Texture \"t\" \"float\" \"constant\" \"rgb value\" [ 1 1 1 ]", 32,
              "must be float or texture, not rgb"),
        world("mixture_of_one", "Material \"mix\" \"string materials\" \"a\"", 16, "takes 2 values"),
        world("mixture_of_itself",
              "MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string materials\" [ \"m\" \"m\" ]", 43,
              "defined before the mixture"),
        world("undefined_object", "ObjectInstance \"tree\"", 16, "no object 'tree'"),
        world("object_twice", "ObjectBegin \"a\" ObjectEnd ObjectBegin \"a\" ObjectEnd", 27, "defined twice"),
        world("undefined_medium", "MediumInterface \"fog\" \"\"", 17, "no medium 'fog'"),
        world("medium", "MakeNamedMedium \"fog\" \"string type\" \"uniformgrid\"", 23,
              "medium 'uniformgrid' is not supported yet"),
        world("medium_twice",
              "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" MakeNamedMedium \"a\" \"string type\" "
              "\"homogeneous\"",
              49, "medium 'a' is defined twice"),
        world("medium_without_type", "MakeNamedMedium \"fog\"", 1, "needs \"string type\""),
        world("unknown_medium", "MakeNamedMedium \"fog\" \"string type\" \"homogenous\"", 23, "no medium 'homogenous'",
              "homogeneous"),
        world("unknown_preset", "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"string preset\" \"Beer\"",
              51, "preset"),
        world("hair", "Material \"hair\"", 10, "is not supported yet", "'diffuse' instead"),
        world("undefined_coordinates", "CoordSysTransform \"cam\"", 1, "no coordinate system"),
        world("color_space", "ColorSpace \"sRGB2\"", 12, "no colour space", "rec2020"),
        world("attribute_target", "Attribute \"shap\" \"float radius\" 2", 11, "Attribute takes"),
        world("attribute_unknown", "Attribute \"shape\" \"float radus\" 2", 19, "no shape has a parameter")),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    structure, Mistakes,
    testing::Values(
        Mistake{"no_world", "Identity\n", 0, 0, "no WorldBegin"}, Mistake{"empty_file", "", 0, 0, "no WorldBegin"},
        head("shape_before_world", "Shape \"sphere\"", 1, "must stand after WorldBegin"),
        world("film_in_world", "Film \"rgb\"", 1, "must stand before WorldBegin"),
        world("second_world", "WorldBegin", 1, "a second WorldBegin"),
        world("old_world_end", "WorldEnd", 1, "not a directive of pbrt-v4"),
        world("end_without_begin", "AttributeEnd", 1, "AttributeEnd without AttributeBegin"),
        world("begin_without_end", "AttributeBegin", 1, "AttributeBegin has no end"),
        world("crossed_blocks", "AttributeBegin TransformBegin AttributeEnd", 31, "closes TransformBegin of line 2"),
        world("object_end_alone", "ObjectEnd", 1, "ObjectEnd without ObjectBegin"),
        world("object_in_object", "ObjectBegin \"a\" ObjectBegin \"b\" ObjectEnd", 17, "inside ObjectBegin"),
        world("block_open_in_object", "ObjectBegin \"a\" AttributeBegin ObjectEnd", 17, "no end before ObjectEnd"),
        world("instance_in_object", "ObjectBegin \"a\" ObjectInstance \"a\" ObjectEnd", 17, "inside ObjectBegin"),
        world("missing_include", "Include \"nowhere.pbrt\"", 1, "no file"),
        world("include_without_name", "Include 3", 9, "in quotes"),
        world("too_few_numbers", "Translate 1 2 Identity", 15, "takes 3 finite numbers"),
        world("numbers_meet_word", "Scale 1 1 Identity", 11, "found 'Identity' as number 3"),
        world("too_many_in_brackets", "Translate [ 1 2 3 4 ]", 19, "']' is expected"),
        world("zero_scale", "Scale 1 0 1", 1, "cannot be inverted"),
        world("zero_axis", "Rotate 30 0 0 0", 1, "no length"),
        world("look_at_itself", "LookAt 1 1 1 1 1 1 0 1 0", 1, "no direction"),
        world("look_along_up", "LookAt 0 0 0 0 1 0 0 1 0", 1, "no direction"),
        world("singular_matrix", "Transform [ 1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1 ]", 1, "singular"),
        world("vanishing_scale", "Scale 1e-20 1 1 Scale 1e-20 1 1", 17, "range of numbers"),
        world("active_transform", "ActiveTransform Begin", 17, "StartTime, EndTime, All"),
        world("moving_lamp", "AreaLightSource \"diffuse\" ActiveTransform EndTime Translate 1 0 0 Shape \"sphere\"", 67,
              "which emits light, moves"),
        world("moving_light", "ActiveTransform EndTime Translate 1 0 0 LightSource \"point\"", 41, "this light moves"),
        world("turned_inside_out", "ActiveTransform EndTime Scale -1 1 1 Shape \"sphere\"", 38, "is mirrored"),
        head("times_backward", "TransformTimes 2 1", 1, "a later end"),
        world("lamp_of_many_forms",
              "AreaLightSource \"diffuse\" Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] "
              "\"point3 P1\" [ 0 0 1 1 0 0 0 1 0 ]",
              27, "deforms"),
        world("form_too_short",
              "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"point3 P1\" [ 0 0 1 1 0 0 ]", 55,
              "'P1' takes the 3 vertices"),
        world("form_without_normals",
              "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"normal N\" [ 0 0 1 0 0 1 0 0 1 ] "
              "\"point3 P1\" [ 0 0 1 1 0 0 0 1 0 ]",
              88, "'N1' takes a normal")),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    things, Mistakes,
    testing::Values(
        head("large_film", "Film \"rgb\" \"integer xresolution\" 70000", 12, "at most 65536"),
        head("largest_integer", "Film \"rgb\" \"integer xresolution\" 2147483647", 12, "found 2147483647"),
        head("huge_film", "Film \"rgb\" \"integer xresolution\" 60000 \"integer yresolution\" 60000", 12, "too large"),
        head("no_pixels", "Film \"rgb\" \"integer xresolution\" 0", 12, "at least 1"),
        head("empty_crop", "Film \"rgb\" \"float cropwindow\" [ 0.5 0.5 0 1 ]", 12, "is empty"),
        head("short_crop", "Film \"rgb\" \"float cropwindow\" [ 0 1 ]", 12, "takes 4 values"),
        head("bounds_outside", "Film \"rgb\" \"integer pixelbounds\" [ 0 2000 0 10 ]", 12, "beyond the film"),
        head("no_samples", "Sampler \"halton\" \"integer pixelsamples\" 0", 18, "at least 1"),
        head("wide_angle", "Camera \"perspective\" \"float fov\" 180", 22, "at most 179.99"),
        head("empty_window", "Camera \"perspective\" \"float screenwindow\" [ 1 0 0 1 ]", 22, "is empty"),
        head("shutter", "Camera \"perspective\" \"float shutteropen\" 2", 1, "closes before it opens"),
        head("noshutter", "Camera \"perspective\" \"float shutteropen\" 1", 1, "closes when it opens"),
        head("notimes", "TransformTimes 1 1", 1, "a later end"),
        head("realistic", "Camera \"realistic\"", 8, "is not supported yet", "perspective"),
        head("unknown_filter", "PixelFilter \"gauss\"", 13, "no filter 'gauss'", "gaussian"),
        head("negative_filter", "PixelFilter \"box\" \"float xradius\" -2", 19, "at least"),
        head("unknown_option", "Option \"integer sed\" 1", 8, "no parameter 'sed'", "seed"),
        warned(head("second_film", "Film \"rgb\" Film \"rgb\"", 12, "replaces the first")),
        noted(head("random_walk", "Integrator \"randomwalk\"", 12, "replaced by 'path'")),
        world("spot_to_itself", "LightSource \"spot\" \"point3 to\" [ 0 0 0 ]", 20, "the same point"),
        world("spot_edge", "LightSource \"spot\" \"float coneangle\" 10 \"float conedeltaangle\" 20", 41, "wider"),
        world("projection_without_slide", "LightSource \"projection\"", 1, "needs 'filename'"),
        world("missing_image", "LightSource \"infinite\" \"string filename\" \"no.exr\"", 24, "no file 'no.exr'"),
        world("both_emissions", "LightSource \"infinite\" \"string filename\" \"a.exr\" \"rgb L\" [ 1 1 1 ]", 50,
              "exclude"),
        warned(world("portal", "LightSource \"infinite\" \"point3 portal\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ]", 24,
                     "no effect yet")),
        world("metal_twice", "Material \"conductor\" \"rgb reflectance\" [ 1 1 1 ] \"rgb k\" [ 1 1 1 ]", 50, "exclude"),
        world("encoding",
              "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"a.png\" \"string encoding\" \"gamma\"", 58,
              "not an encoding"),
        world("image_without_file", "Texture \"t\" \"float\" \"imagemap\"", 1, "needs 'filename'"),
        world("marble_of_numbers", "Texture \"t\" \"float\" \"marble\"", 1, "\"spectrum\" only")),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    shapes, Mistakes,
    testing::Values(
        world("no_points", "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 ]", 1, "needs 'P'"),
        world("no_indices", "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ]", 1, "needs 'indices'"),
        world("index_out_of_range",
              "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 3 ]", 55,
              "index 3 (number 3 of 'indices') has no vertex: there are 3"),
        world("negative_index",
              "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 -1 ]", 55,
              "not be negative; found -1"),
        world("two_indices", "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 ]",
              55, "takes 3 per face"),
        world("three_of_a_patch",
              "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 ]", 55,
              "takes 4 per face"),
        world("few_normals", "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"normal N\" [ 0 0 1 ]", 55,
              "1 values for 3 vertices"),
        world("few_uvs", "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"point2 uv\" [ 0 0 1 1 ]", 55,
              "2 values for 3 vertices"),
        warned(world("no_area",
                     "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 0 1 1 ]", 1,
                     "1 face has no area")),
        world("missing_mesh", "Shape \"plymesh\" \"string filename\" \"no.ply\"", 17, "no file 'no.ply'"),
        world("mesh_without_file", "Shape \"plymesh\"", 1, "needs 'filename'"),
        world("ring_inside_out", "Shape \"disk\" \"float innerradius\" 2", 14, "smaller than 'radius'"),
        world("flat_cylinder", "Shape \"cylinder\" \"float zmin\" 1", 1, "nothing is left"),
        world("sphere_cut_away", "Shape \"sphere\" \"float zmin\" 2 \"float zmax\" 3", 16, "nothing is left"),
        world("curve_points", "Shape \"curve\" \"point3 P\" [ 0 0 0 1 0 0 2 0 0 ]", 15, "cannot have 3 control points"),
        world("curve_without_points", "Shape \"curve\"", 1, "needs 'P'"),
        world("ribbon_normals", "Shape \"curve\" \"string type\" \"ribbon\" \"point3 P\" [ 0 0 0 1 0 0 2 0 0 3 0 0 ]",
              1, "takes 2 normals; found 0"),
        world("many_levels", "Shape \"loopsubdiv\" \"integer levels\" 11", 20, "at most 10"),
        warned(world("emitting_object", "ObjectBegin \"a\" AreaLightSource \"diffuse\" Shape \"sphere\" ObjectEnd", 43,
                     "cannot emit light"))),
    name_of_case);

TEST(Reading, reports_all_mistakes_of_a_file_in_one_run) {
  ReadResult result = read_pbrt_text(
      "WorldBegin\nShape \"spere\"\nMaterial \"diffuse\" \"float reflektance\" 1\nTranslate 1 x 2\nFoo 1 2 3\nScale 0 "
      "0 0\n",
      ".");
  EXPECT_EQ(result.diagnostics.errors(), 5) << listing(result.diagnostics);
}

TEST(Reading, stops_printing_after_fifty_mistakes_and_counts_the_rest) {
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 80; ++i) text += "Scale 0 0 0\n";
  ReadResult result = read_pbrt_text(text, ".");
  EXPECT_EQ(result.diagnostics.errors(), 50);
  EXPECT_NE(result.diagnostics.all().back().message.find("and 30 more errors"), std::string::npos);
}

TEST(LenientReading, lets_pass_what_montelux_cannot_do_yet) {
  std::string text =
      "WorldBegin\nMakeNamedMedium \"fog\" \"string type\" \"cloud\"\nMediumInterface \"fog\" \"\"\nMaterial \"hair\" "
      "\"rgb reflectance\" [ .1 "
      ".2 .3 ]\n"
      "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All\nShape \"sphere\" \"float radus\" 1\n";
  EXPECT_FALSE(read_pbrt_text(text, ".").scene);
  ReadResult result = read_pbrt_text(text, ".", {true});
  ASSERT_TRUE(result.scene) << listing(result.diagnostics);
  const MaterialModel stated = DiffuseDesc{RgbValue{Rgb{{0.1f, 0.2f, 0.3f}}}};
  EXPECT_TRUE(result.scene->materials.at(1).model == stated);
  EXPECT_TRUE(result.scene->shapes.at(0).object_to_world.is_identity());
}

TEST(Reading, names_the_format_of_a_file_that_is_none_of_pbrt) {
  const test::TemporaryFolder folder;
  for (const auto& [content, what] :
       std::vector<std::pair<std::string, std::string>>{{"{\n  \"asset\": {}\n}", "JSON, as glTF is"},
                                                        {" \n<scene version=\"3.0.0\"/>", "XML, as Mitsuba's"},
                                                        {std::string("glTF\2\0\0\0\xe0\xff", 10), "binary glTF"},
                                                        {"ply\nformat ascii 1.0\n", "a ply mesh"}}) {
    const ReadResult result = read_pbrt(folder.write("scene.x", content));
    EXPECT_EQ(result.diagnostics.errors(), 1);
    EXPECT_NE(listing(result.diagnostics).find(what), std::string::npos) << listing(result.diagnostics);
  }
}

TEST(Messages, hold_no_control_characters_and_no_broken_text) {
  EXPECT_EQ(printable("a\tb\x7f"), "a?b?");
  EXPECT_EQ(printable("Gr\xc3\xb6\xc3\x9f"
                      "e \xe2\x82\xac \xf0\x9f\x8e\xb2"),
            "Gr\xc3\xb6\xc3\x9f"
            "e \xe2\x82\xac \xf0\x9f\x8e\xb2");
  // Cut off, too long a form, a surrogate, beyond the last character, a control character of two bytes.
  EXPECT_EQ(printable("\xe2\x82"), "??");
  EXPECT_EQ(printable("\xc0\xaf"), "??");
  EXPECT_EQ(printable("\xed\xa0\x80"), "???");
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "????");
  EXPECT_EQ(printable("\xc2\x9b"), "??");
  const test::TemporaryFolder folder;
  const ReadResult result = read_pbrt(folder.write("scene.pbrt", "WorldBegin\nShap\xff\xfe \x1b[31m\n"));
  const std::string text = render(result.diagnostics, {false, true});
  for (const char* broken : {"\xff", "\xfe", "\x1b"}) EXPECT_EQ(text.find(broken), std::string::npos) << text;
}

}  // namespace
}  // namespace montelux
