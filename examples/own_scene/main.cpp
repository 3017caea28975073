// A scene in code: a lamp, a black sphere that shines, stands above a diffuse square under a constant sky. The program
// renders it, prints the estimate of the pixel in the middle beside the true value, and writes the picture.
//
// usage: own_scene [PICTURE.exr [SAMPLES [SEED]]]
#include <montelux/montelux.h>

#include <cstdio>
#include <cstdlib>

namespace mx = montelux::api;

namespace {

constexpr float lamp_height = 2, lamp_radius = 0.5f;
constexpr mx::Rgb albedo{0.8f, 0.5f, 0.2f}, sky{0.5f, 0.75f, 1.0f}, lamp{20, 16, 12};

mx::Scene make_scene() {
  mx::Scene scene;
  scene.set_film(33, 33);
  // The pixels are so small on the floor that all of it in a picture has one radiance, to 1e-6.
  scene.set_camera({"perspective", {{"fov", 0.05}}}, mx::look_at({0, 1, -2}, {0, 0, 0}, {0, 1, 0}));

  const mx::MaterialId floor = scene.add_material({"diffuse", {{"reflectance", albedo}}});
  const mx::MaterialId black = scene.add_material({"diffuse", {{"reflectance", mx::Rgb{0, 0, 0}}}});

  mx::Mesh square;
  square.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
  square.triangles = {0, 2, 1, 0, 3, 2};
  scene.add_mesh(square, {.material = floor});

  scene.add_shape({"sphere", {{"radius", double(lamp_radius)}}}, {.material = black,
                                                                  .area_light = mx::Model{"diffuse", {{"L", lamp}}},
                                                                  .object_to_world = mx::translate(0, lamp_height, 0)});
  scene.add_light({"infinite", {{"L", sky}}});
  return scene;
}

// The radiance of the floor below the lamp. A sphere of radius r at height h has the share (r / h)^2 of the irradiance
// of a whole sky as bright as it, and hides as much of the sky.
double truth(int channel) {
  const double share = double(lamp_radius / lamp_height) * double(lamp_radius / lamp_height);
  const auto of = [channel](const mx::Rgb& rgb) { return double(channel == 0 ? rgb.r : channel == 1 ? rgb.g : rgb.b); };
  return of(albedo) * (of(lamp) * share + of(sky) * (1 - share));
}

int run(int argc, char** argv) {
  const mx::PreparedScene scene = mx::prepare(make_scene()).value();
  for (const mx::Message& message : scene.messages()) std::fprintf(stderr, "%s\n", to_text(message).c_str());

  mx::RenderSettings settings;
  settings.samples = argc > 2 ? std::atoi(argv[2]) : 256;
  if (argc > 3) settings.seed = std::uint32_t(std::strtoul(argv[3], nullptr, 10));
  const mx::Picture picture = scene.render(settings).value();

  const mx::Estimate pixel = picture.pixel(picture.width() / 2, picture.height() / 2);
  std::printf("pixel: %g samples in %d passes\n", pixel.samples, pixel.passes);
  for (int channel = 0; channel < 3; ++channel) {
    const auto c = std::size_t(channel);
    std::printf("  %c  mean %.6f  standard error %.6f", "RGB"[channel], pixel.mean[c], pixel.standard_error[c]);
    if (const auto interval = pixel.interval(channel))
      std::printf("  95 %% [%.6f, %.6f]", interval->low, interval->high);
    std::printf("  true %.6f\n", truth(channel));
  }
  const mx::Estimate image = picture.mean();
  std::printf("picture: mean %.6f %.6f %.6f, standard error %.6f %.6f %.6f\n", image.mean[0], image.mean[1],
              image.mean[2], image.standard_error[0], image.standard_error[1], image.standard_error[2]);
  if (argc > 1) picture.write(argv[1]).value();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const mx::Error& error) {
    std::fprintf(stderr, "own_scene: %s\n", error.what());
    return 1;
  }
}
