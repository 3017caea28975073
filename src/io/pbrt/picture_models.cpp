#include "io/pbrt/picture_models.h"

namespace montelux::pbrt {

namespace {

using enum ParameterType;

constexpr double unlimited = 1e30;
constexpr double max_integer = 2147483647;

ParameterSpec later(ParameterSpec spec) {
  spec.later = true;
  return spec;
}

// ---- films ----------------------------------------------------------------------------------------------------------

Fields<FilmDesc> film() {
  using S = FilmDesc;
  Fields<S> fields;
  fields.integer("xresolution", &S::width, "width in pixels", 1, 65536);
  fields.integer("yresolution", &S::height, "height in pixels", 1, 65536);
  fields.list<4>("cropwindow", &S::crop_window, "x0 x1 y0 y1 of the part to render, in [0, 1]; default all", 0, 1);
  fields.list<4>("pixelbounds", &S::pixel_bounds, "x0 x1 y0 y1 of the part to render, in pixels; default all", 0,
                 65536);
  fields.other(later(
      {"diagonal", {number}, "diagonal of the film in mm, for the realistic camera; default 35", 1e-6, unlimited}));
  fields.words("filename", &S::file, "output file unless stated by -o; default: the name of the scene");
  fields.other(later({"savefp16", {boolean}, "write half floats; default true"}));
  fields.optional("iso", &S::iso, "sensitivity: scales the image with the exposure time; default 100", 1e-6, unlimited);
  fields.other(
      later({"whitebalance", {number}, "colour temperature in kelvin taken as white; default none", 0, unlimited}));
  fields.other(later({"sensor", {string}, "camera sensor; default cie1931"}));
  fields.optional("maxcomponentvalue", &S::max_component, "clamp of a sample's components (biased); default none", 0,
                  unlimited);
  return fields;
}

Fields<FilmDesc> layers_film() {
  return film().other(later({"coordinatesystem", {string}, "default camera", 0, 0, {"camera", "world"}}));
}

Fields<FilmDesc> spectral_film() {
  return film()
      .other(later({"nbuckets", {integer}, "default 16", 1, 4096}))
      .other(later({"lambdamin", {number}, "nm; default 360", 1, unlimited}))
      .other(later({"lambdamax", {number}, "nm; default 830", 1, unlimited}));
}

// ---- samplers -------------------------------------------------------------------------------------------------------

using Sampler = StatedSampler;

Fields<Sampler> seed() {
  Fields<Sampler> fields;
  fields.optional("seed", &Sampler::seed, "default that of the options", -max_integer, max_integer);
  return fields;
}

Fields<Sampler> points() {
  Fields<Sampler> fields;
  fields.integer("pixelsamples", &Sampler::samples, "samples per pixel", 1, 1 << 24);
  return fields.append(seed());
}

Fields<Sampler> scrambled() {
  Fields<Sampler> fields = points();
  fields.text("randomization",
              "points are always scrambled by Owen's method, since error bars need it; default fastowen",
              [](const std::string& text, Sampler& s) -> Status {
                s.randomization = text;
                return Done{};
              },
              {}, {"none", "permutedigits", "fastowen", "owen"});
  return fields;
}

Fields<Sampler> strata() {
  Fields<Sampler> fields;
  fields.integer("xsamples", &Sampler::x_strata, "strata along x", 1, 4096);
  fields.integer("ysamples", &Sampler::y_strata, "strata along y", 1, 4096);
  fields.flag("jitter", &Sampler::jitter,
              "false: the points are the centres of the strata, the same in every pass (biased)");
  return fields.append(seed());
}

// A sampler that another point set replaces has that one's name.
Model<Sampler> sampler(std::string_view name, PointSetKind kind, std::string_view meaning, Fields<Sampler> fields) {
  const std::string_view ours = name_of(kind);
  return {name, meaning, {kind}, std::move(fields), false, name == ours ? std::string_view{} : ours};
}

// ---- integrators ----------------------------------------------------------------------------------------------------

using Integrator = StatedIntegrator;

Fields<Integrator> depth() {
  Fields<Integrator> fields;
  fields.optional("maxdepth", &Integrator::max_depth, "maximum number of bounces; default none", 0, max_integer);
  return fields;
}

Fields<Integrator> light_sampler() {
  Fields<Integrator> fields;
  fields.choice<StatedLightSampler>("lightsampler", &Integrator::light_sampler, "how a light is chosen",
                                    {{"uniform", StatedLightSampler::uniform},
                                     {"power", StatedLightSampler::power},
                                     {"bvh", StatedLightSampler::bvh},
                                     {"exhaustive", StatedLightSampler::exhaustive}});
  return fields;
}

ParameterSpec regularize(const char* meaning) { return later({"regularize", {boolean}, meaning}); }

Fields<Integrator> paths() {
  return depth()
      .append(light_sampler())
      .other(regularize("blurs narrow lobes after the first bounce (biased); default false"));
}

Fields<Integrator> simple_paths() {
  Fields<Integrator> fields = depth();
  fields.other(later({"samplebsdf", {boolean}, "sample directions by the BSDF; default true"}));
  fields.flag("samplelights", &Integrator::sample_lights, "sample points of lights; false: replaced by `naive`");
  return fields;
}

Fields<Integrator> occlusion() {
  Fields<Integrator> fields;
  fields.flag("cossample", &Integrator::cosine_directions, "cosine-weighted directions");
  fields.optional("maxdistance", &Integrator::max_distance, "maximum distance of occluders; default infinite", 1e-6,
                  unlimited);
  return fields;
}

Fields<Integrator> bidirectional() {
  return depth()
      .other(regularize("blurs narrow lobes (biased); default false"))
      .append(light_sampler())
      .other(later({"visualizestrategies", {boolean}, "one image per technique; default false"}))
      .other(later({"visualizeweights", {boolean}, "with the weights; default false"}));
}

Fields<Integrator> metropolis() {
  Fields<Integrator> fields = depth();
  fields.other(later({"bootstrapsamples", {integer}, "default 100000", 1, max_integer}));
  fields.other(later({"chains", {integer}, "default 1000", 1, max_integer}));
  fields.optional("mutationsperpixel", &Integrator::mutations, "the number of samples; default that of the sampler", 1,
                  1 << 24);
  fields.optional("largestepprobability", &Integrator::large_step, "default 0.3", 0.01, 1);
  fields.other(later({"sigma", {number}, "size of a small step; default 0.01", 1e-9, unlimited}));
  return fields.other(regularize("default false"));
}

Fields<Integrator> photons() {
  Fields<Integrator> fields = depth();
  fields.integer("photonsperiteration", &Integrator::photons, "light paths in each frame; 0 or less: one per pixel", -1,
                 1 << 28);
  fields.optional("radius", &Integrator::radius, "radius of the first frame; default three pixels wide", 1e-30,
                  unlimited);
  fields.optional("seed", &Integrator::seed, "default that of the sampler", -max_integer, max_integer);
  return fields.other(regularize("default false"));
}

Fields<Integrator> function() {
  Fields<Integrator> fields;
  fields.other({"function", {string}, "which"});
  return fields.other({"skipbad", {boolean}, "default true"});
}

// One that `ours` replaces; `same`: it is the same under another name.
Model<Integrator> integrator(std::string_view name, std::string_view ours, std::string_view meaning,
                             Fields<Integrator> fields, bool same = false) {
  Model<Integrator> model{name, meaning, {std::string(ours)}, std::move(fields)};
  if (name != ours) model.instead = ours;
  model.same = same;
  return model;
}

}  // namespace

const Models<FilmDesc>& film_models() {
  static const Models<FilmDesc> models(
      {{"rgb", "an image in a colour space", {}, film()},
       {"gbuffer", "an image with geometry layers", {}, layers_film(), false, "rgb"},
       {"spectral", "an image in wavelength buckets", {}, spectral_film(), false, "rgb"}});
  return models;
}

const Models<StatedSampler>& sampler_models() {
  using enum PointSetKind;
  static const Models<StatedSampler> models({
      sampler("independent", independent, "random points", points()),
      sampler("stratified", stratified, "a jittered grid", strata()),
      sampler("halton", halton, "Halton points", scrambled()),
      sampler("sobol", sobol, "Sobol points over the image", scrambled()),
      sampler("paddedsobol", padded_sobol, "Sobol points, two dimensions at a time", scrambled()),
      sampler("zsobol", blue_noise, "Sobol points along a Morton curve", scrambled()),
      sampler("pmj02bn", blue_noise, "progressive multi-jittered points", points()),
  });
  return models;
}

const Models<StatedIntegrator>& integrator_models() {
  static const Models<StatedIntegrator> models = [] {
    Model<Integrator> none = integrator("function", "path", "the integral of a test function", function());
    none.later = true;
    return Models<Integrator>({
        integrator("path", "path", "path tracing with light sampling", paths()),
        integrator("volpath", "path", "path tracing with media", paths(), true),
        integrator("simplepath", "path", "path tracing, its techniques one by one", simple_paths()),
        integrator("simplevolpath", "path", "path tracing with media, without light sampling", depth()),
        integrator("randomwalk", "path", "path tracing with uniform directions", depth()),
        integrator("ambientocclusion", "ao", "the share of open directions", occlusion(), true),
        integrator("ao", "ao", "the share of open directions, the short name", occlusion()),
        integrator("bdpt", "bdpt", "bidirectional path tracing", bidirectional()),
        integrator("mlt", "metropolis", "Metropolis light transport", metropolis()),
        integrator("sppm", "sppm", "stochastic progressive photon mapping", photons()),
        integrator("lightpath", "light", "paths only from the lights", depth(), true),
        none,
    });
  }();
  return models;
}

const Models<StatedOptions>& option_models() {
  using S = StatedOptions;
  static const Models<S> models = [] {
    Fields<S> fields;
    fields.optional("seed", &S::seed, "seed of all randomness; default 0", -max_integer, max_integer);
    fields.flag("disablepixeljitter", &S::pixel_centres,
                "all samples at the pixel's centre, in the middle of lens and shutter (biased)");
    fields.other(later({"disabletexturefiltering", {boolean}, "default false"}));
    fields.other(later({"disablewavelengthjitter", {boolean}, "default false"}));
    fields.other(later({"displacementedgescale", {number}, "default 1", 0, unlimited}));
    fields.other(later({"forcediffuse", {boolean}, "all materials diffuse; default false"}));
    fields.other(later({"msereferenceimage", {string}, "image to compare with"}));
    fields.other(later({"msereferenceout", {string}, "where to write the comparison"}));
    fields.other(later({"pixelstats", {boolean}, "default false"}));
    fields.other(later({"rendercoordsys", {string}, "default cameraworld", 0, 0, {"camera", "cameraworld", "world"}}));
    fields.other(later({"wavefront", {boolean}, "default false"}));
    return Models<S>({{"Option", "global settings", {}, fields}});
  }();
  return models;
}

const Models<Done>& accelerator_models() {
  static const Models<Done> models = [] {
    Fields<Done> boxes, planes;
    boxes.other(later({"maxnodeprims", {integer}, "primitives in a leaf"}));
    boxes.other(later({"splitmethod", {string}, "how boxes are split"}));
    for (const char* name : {"intersectcost", "traversalcost"})
      planes.other(later({name, {integer}, "of the cost model"}));
    planes.other(later({"emptybonus", {number}, "of the cost model"}));
    planes.other(later({"maxprims", {integer}, "primitives in a leaf"}));
    planes.other(later({"maxdepth", {integer}, "maximum depth"}));
    return Models<Done>(
        {{"bvh", "a hierarchy of boxes", {}, boxes}, {"kdtree", "a k-d tree", {}, planes, false, "bvh"}});
  }();
  return models;
}

}  // namespace montelux::pbrt
