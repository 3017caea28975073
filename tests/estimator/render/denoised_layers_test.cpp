// The layers of light of a rendered picture after the removal of noise.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "api/denoise.h"
#include "api/render.h"
#include "api/scene.h"
#include "image/image_file.h"
#include "image/layers.h"
#include "temporary_folder.h"

namespace montelux::test {
namespace {

class Quiet final : public RenderObserver {};

const std::filesystem::path first_light =
    std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes" / "first-light" / "first-light.pbrt";

Rendering rendering_of(int samples, std::uint32_t seed, const std::string& layers, bool denoise) {
  LoadOptions load;
  load.resolution = {60, 45};
  const LoadResult loaded = load_scene(first_light, load);
  RenderOptions options;
  options.samples = samples, options.seed = seed, options.layers = *parse_layers(layers), options.denoise = denoise;
  Quiet observer;
  return *render_scene(*loaded.scene, options, observer);
}

double relative_error(const PixelBuffer& image, const std::string& layer, const PixelBuffer& true_image,
                      const std::string& true_layer) {
  const PixelBuffer found = *montelux::layer(image, layer), truth = *montelux::layer(true_image, true_layer);
  double sum = 0;
  for (std::size_t i = 0; i < truth.values.size(); ++i) {
    const double t = double(truth.values[i]), difference = double(found.values[i]) - t;
    sum += difference * difference / (t * t + 0.01);
  }
  return sum / double(truth.values.size());
}

// The families sum to the image. Layers with most of the noise have far less of it; direct light has little, and is
// filtered as the image is.
TEST(DenoisedLayers, of_a_picture_sum_to_it_and_have_less_noise) {
  const PixelBuffer image = layers_of(rendering_of(16, 1, "bounces:2,light-groups", true));
  const PixelBuffer truth = layers_of(rendering_of(2048, 2, "bounces:2", false));
  const PixelBuffer whole = *layer(image, "denoised"), group = *layer(image, "denoised_Combined_default");
  std::vector<PixelBuffer> bounces;
  for (const char* name : {"bounce0", "bounce1", "bounce2", "bounce_rest"})
    bounces.push_back(*layer(image, std::string("denoised_") + name));
  for (const std::string name : {"bounce2", "bounce_rest"})
    EXPECT_LT(relative_error(image, "denoised_" + name, truth, name), 0.3 * relative_error(image, name, truth, name));
  EXPECT_LT(relative_error(image, "denoised_bounce1", truth, "bounce1"),
            1.5 * relative_error(image, "bounce1", truth, "bounce1"));
  for (std::size_t i = 0; i < whole.values.size(); ++i) {
    const double value = double(whole.values[i]);
    double sum = 0;
    for (const PixelBuffer& bounce : bounces) {
      ASSERT_GT(bounce.values[i], -1e-6f);  // rounding
      sum += double(bounce.values[i]);
    }
    ASSERT_NEAR(sum, value, 1e-5 * (1 + value));
    ASSERT_NEAR(double(group.values[i]), value, 1e-5 * (1 + value));
  }
}

TEST(DenoisedLayers, of_a_file_are_those_of_the_film) {
  const TemporaryFolder folder;
  const std::filesystem::path file = std::filesystem::path(folder.path()) / "halves.exr";
  const Rendering rendering = rendering_of(16, 1, "bounces:1,errors,halves", false);
  ASSERT_TRUE(write_rendering(file, rendering, {}));
  const PixelBuffer of_file = denoise_file(file)->layers;
  const PixelBuffer of_film = layers_of(rendering_of(16, 1, "bounces:1,errors", true));
  for (const char* name : {"denoised_bounce1", "denoised_error_bounce1", "denoised_bounce_rest"}) {
    const PixelBuffer a = *layer(of_file, name), b = *layer(of_film, name);
    for (std::size_t i = 0; i < a.values.size(); ++i) ASSERT_NEAR(a.values[i], b.values[i], 1e-4f * (1 + b.values[i]));
  }
}

// By the features, coverage and samples of the file as by those of the film. Numbers that cannot be do not spread.
TEST(DenoisedFile, states_the_error_that_a_film_states) {
  const TemporaryFolder folder;
  const std::filesystem::path file = std::filesystem::path(folder.path()) / "halves.exr";
  const Rendering rendering = rendering_of(16, 1, "halves", true);
  ASSERT_TRUE(write_rendering(file, rendering, {}));
  const double stated = denoise_file(file)->estimate.relative_mse;
  EXPECT_NEAR(stated / denoise(rendering.result.film)->estimate.relative_mse, 1, 2e-3);
  PixelBuffer pixels = read_image(file)->pixels;
  for (const char* name : {"R", "A", "samples", "id", "albedo.G", "N.X", "stderr.B"}) {
    PixelBuffer broken = pixels;
    const std::size_t channel = std::size_t(*find_channel(broken, name));
    for (float value : {std::nanf(""), -1e30f}) {
      broken.values[(60 * 20 + 30) * broken.channels.size() + channel] = value;
      ASSERT_TRUE(write_image(file, broken));
      // One of 2700 pixels is left out, or is taken for another surface; planted: a NaN that spreads makes all of it
      // NaN.
      EXPECT_NEAR(denoise_file(file)->estimate.relative_mse / stated, 1, 0.05) << name << " " << value;
    }
  }
}

}  // namespace
}  // namespace montelux::test
