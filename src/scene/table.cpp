#include "scene/table.h"

namespace montelux {

namespace {

using enum ParameterType;
using List = std::vector<ParameterSpec>;

constexpr double most = 1e30;
constexpr double max_integer = 2147483647;

ParameterSpec later(ParameterSpec spec) {
  spec.later = true;
  return spec;
}

List film_parameters(List more = {}) {
  List list{
      {"xresolution", {integer}, "width in pixels; default 1280", 1, 65536},
      {"yresolution", {integer}, "height in pixels; default 720", 1, 65536},
      {"cropwindow", {number}, "x0 x1 y0 y1 of the part to render, in [0, 1]; default all", 0, 1, {}, true},
      {"pixelbounds", {integer}, "x0 x1 y0 y1 of the part to render, in pixels; default all", 0, 65536, {}, true},
      later({"diagonal", {number}, "diagonal of the film in mm, for the realistic camera; default 35", 1e-6, most}),
      {"filename", {string}, "output file unless stated by -o; default: the name of the scene"},
      later({"savefp16", {boolean}, "write half floats; default true"}),
      {"iso", {number}, "sensitivity: scales the image with the exposure time; default 100", 1e-6, most},
      later({"whitebalance", {number}, "colour temperature in kelvin taken as white; default none", 0, most}),
      later({"sensor", {string}, "camera sensor; default cie1931"}),
      {"maxcomponentvalue", {number}, "clamp of a sample's components (biased); default none", 0, most}};
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

List sampler_parameters(List more = {}) {
  List list{{"pixelsamples", {integer}, "samples per pixel; default 16", 1, 1 << 24},
            {"seed", {integer}, "default 0", -max_integer, max_integer}};
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

ParameterSpec randomization() {
  return {"randomization",
          {string},
          "default fastowen; points are always scrambled by Owen's method, since error bars need it",
          0,
          0,
          {"none", "permutedigits", "fastowen", "owen"}};
}

List integrator_parameters(List more = {}) {
  List list{{"maxdepth", {integer}, "maximum number of bounces; default none", 0, max_integer}};
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

std::vector<std::string_view> light_samplers() { return {"uniform", "power", "bvh", "exhaustive"}; }

List path_parameters() {
  return integrator_parameters(
      {{"lightsampler", {string}, "how a light is chosen; default bvh", 0, 0, light_samplers()},
       later({"regularize", {boolean}, "blurs narrow lobes after the first bounce (biased); default false"})});
}

std::vector<EntitySpec> camera_integrators() {
  return {
      {"path", "path tracing with light sampling", path_parameters()},
      {"volpath", "path tracing with media", path_parameters(), false, "path", true},
      {"simplepath", "path tracing, its techniques one by one",
       integrator_parameters(
           {later({"samplebsdf", {boolean}, "sample directions by the BSDF; default true"}),
            {"samplelights", {boolean}, "sample points of lights; default true; otherwise replaced by `naive`"}}),
       false, "path"},
      {"simplevolpath", "path tracing with media, without light sampling", integrator_parameters(), false, "path"},
      {"randomwalk", "path tracing with uniform directions", integrator_parameters(), false, "path"},
      {"ambientocclusion",
       "the share of open directions",
       {{"cossample", {boolean}, "cosine-weighted directions; default true"},
        {"maxdistance", {number}, "maximum distance of occluders; default infinite", 1e-6, most}},
       false,
       "ao",
       true},
      {"ao",
       "the share of open directions, the short name",
       {{"cossample", {boolean}, "cosine-weighted directions; default true"},
        {"maxdistance", {number}, "maximum distance of occluders; default infinite", 1e-6, most}}},
  };
}

std::vector<EntitySpec> bidirectional_integrators() {
  return {
      {"bdpt", "bidirectional path tracing",
       integrator_parameters({later({"regularize", {boolean}, "blurs narrow lobes (biased); default false"}),
                              {"lightsampler", {string}, "how a light is chosen; default bvh", 0, 0, light_samplers()},
                              later({"visualizestrategies", {boolean}, "one image per technique; default false"}),
                              later({"visualizeweights", {boolean}, "with the weights; default false"})})},
      {"mlt", "Metropolis light transport",
       integrator_parameters(
           {later({"bootstrapsamples", {integer}, "default 100000", 1, max_integer}),
            later({"chains", {integer}, "default 1000", 1, max_integer}),
            {"mutationsperpixel", {integer}, "the number of samples; default that of the sampler", 1, 1 << 24},
            {"largestepprobability", {number}, "default 0.3", 0.01, 1},
            later({"sigma", {number}, "size of a small step; default 0.01", 1e-9, most}),
            later({"regularize", {boolean}, "default false"})}),
       false, "metropolis"},
      {"sppm", "stochastic progressive photon mapping",
       integrator_parameters(
           {{"photonsperiteration", {integer}, "light paths in each frame; default one per pixel", -1, 1 << 28},
            {"radius", {number}, "radius of the first frame; default three pixels wide", 1e-30, most},
            {"seed", {integer}, "default that of the sampler", -max_integer, max_integer},
            later({"regularize", {boolean}, "default false"})})},
      {"lightpath", "paths only from the lights", integrator_parameters(), false, "path"},
      {"function",
       "the integral of a test function",
       {{"function", {string}, "which"}, {"skipbad", {boolean}, "default true"}},
       true,
       "path"},
  };
}

std::vector<EntitySpec> samplers() {
  return {
      {"independent", "random points", sampler_parameters()},
      {"stratified",
       "a jittered grid",
       {{"xsamples", {integer}, "strata along x; default 4", 1, 4096},
        {"ysamples", {integer}, "strata along y; default 4", 1, 4096},
        {"jitter", {boolean}, "default true; false: the centres of the strata, the same in every pass (biased)"},
        {"seed", {integer}, "default 0", -max_integer, max_integer}}},
      {"halton", "Halton points", sampler_parameters({randomization()})},
      {"sobol", "Sobol points over the image", sampler_parameters({randomization()})},
      {"paddedsobol", "Sobol points, two dimensions at a time", sampler_parameters({randomization()}), false,
       "padded-sobol"},
      {"zsobol", "Sobol points along a Morton curve", sampler_parameters({randomization()}), false, "blue-noise"},
      {"pmj02bn", "progressive multi-jittered points", sampler_parameters(), false, "blue-noise"},
  };
}

}  // namespace

std::span<const EntitySpec> film_table() {
  static const std::vector<EntitySpec> table{
      {"rgb", "an image in a colour space", film_parameters()},
      {"gbuffer", "an image with geometry layers",
       film_parameters({later({"coordinatesystem", {string}, "default camera", 0, 0, {"camera", "world"}})}), false,
       "rgb"},
      {"spectral", "an image in wavelength buckets",
       film_parameters({later({"nbuckets", {integer}, "default 16", 1, 4096}),
                        later({"lambdamin", {number}, "nm; default 360", 1, most}),
                        later({"lambdamax", {number}, "nm; default 830", 1, most})}),
       false, "rgb"},
  };
  return table;
}

std::span<const EntitySpec> sampler_table() {
  static const std::vector<EntitySpec> table = samplers();
  return table;
}

std::span<const EntitySpec> integrator_table() {
  static const std::vector<EntitySpec> table = [] {
    std::vector<EntitySpec> all = camera_integrators(), more = bidirectional_integrators();
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return table;
}

std::span<const EntitySpec> accelerator_table() {
  static const std::vector<EntitySpec> table{
      {"bvh",
       "a hierarchy of boxes",
       {later({"maxnodeprims", {integer}, "primitives in a leaf"}),
        later({"splitmethod", {string}, "how boxes are split"})}},
      {"kdtree",
       "a k-d tree",
       {later({"intersectcost", {integer}, "of the cost model"}), later({"traversalcost", {integer}, "likewise"}),
        later({"emptybonus", {number}, "likewise"}), later({"maxprims", {integer}, "primitives in a leaf"}),
        later({"maxdepth", {integer}, "maximum depth"})},
       false,
       "bvh"},
  };
  return table;
}

const EntitySpec& option_spec() {
  static const EntitySpec spec{
      "Option",
      "global settings",
      {{"seed", {integer}, "seed of all randomness; default 0", -max_integer, max_integer},
       {"disablepixeljitter",
        {boolean},
        "all samples at the pixel's centre, in the middle of lens and shutter (biased); default false"},
       later({"disabletexturefiltering", {boolean}, "default false"}),
       later({"disablewavelengthjitter", {boolean}, "default false"}),
       later({"displacementedgescale", {number}, "default 1", 0, most}),
       later({"forcediffuse", {boolean}, "all materials diffuse; default false"}),
       later({"msereferenceimage", {string}, "image to compare with"}),
       later({"msereferenceout", {string}, "where to write the comparison"}),
       later({"pixelstats", {boolean}, "default false"}),
       later({"rendercoordsys", {string}, "default cameraworld", 0, 0, {"camera", "cameraworld", "world"}}),
       later({"wavefront", {boolean}, "default false"})}};
  return spec;
}

}  // namespace montelux
