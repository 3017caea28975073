// What it takes to finish a picture, which a render within a time sets aside.
#include <gtest/gtest.h>

#include <algorithm>

#include "api/render.h"

namespace montelux {

TEST(SecondsToFinish, grow_with_the_picture_and_with_its_files) {
  const PixelBounds small{0, 0, 64, 64}, large{0, 0, 1024, 1024};
  EXPECT_GT(seconds_to_finish(small, {}).error, 0);
  EXPECT_GT(seconds_to_finish(large, {}).error, 4 * seconds_to_finish(small, {}).error);
  EXPECT_LT(seconds_to_finish(large, {}).encoding, 0.1 * seconds_to_finish(large, {}).error);
  const double one = seconds_to_finish(large, {{"a.exr"}, false}).encoding;
  EXPECT_GT(one, 0);
  EXPECT_GT(seconds_to_finish(large, {{"a.exr", "b.exr", "c.exr", "d.exr"}, false}).encoding, one);
}

// Its time is set aside where noise is removed, too.
TEST(SecondsToFinish, contain_the_removal_of_noise) {
  const PixelBounds bounds{0, 0, 512, 256};
  EXPECT_GT(seconds_to_finish(bounds, {}, {.denoise = true}).error, 3 * seconds_to_finish(bounds, {}).error);
}

// A picture of large squares has a smaller file, which takes less time to make.
TEST(SecondsToFinish, fall_where_few_pixels_are_sampled) {
  const FinishTime time = seconds_to_finish({0, 0, 1024, 256}, {{"a.exr"}, false});
  EXPECT_LT(time.encoding_of(16), 0.9 * time.encoding_of(1));
  EXPECT_GT(time.encoding_of(16), 0);
}

// The pixels of a cell are alike, except for the samples, which only one of them has; the last cells are cut off.
TEST(LayersOfASparsePicture, are_those_of_the_film) {
  const PixelBounds bounds{3, 2, 20, 13};
  Rendering rendering{RenderResult{Film(bounds, {}, 4), {}, 0, false, 0, 0, 0}, {}, {}, {}, {}, 0, {}, {}, {}};
  Film& film = rendering.result.film;
  const PixelBounds cells = film.grid().cells();
  std::vector<PixelSample> samples(std::size_t(cells.area()));
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) samples[i].radiance.c[c] = float(1 + 10 * i + 3 * c + pass);
      samples[i].features.coverage = 1, samples[i].features.depth = float(i + 1);
    }
    film.add_pass(cells, pass, 1, samples);
  }
  const PixelBuffer image = layers_of(rendering);
  const auto channel = [&](std::string_view name) {
    return int(std::ranges::find(image.channels, name) - image.channels.begin());
  };
  double taken = 0;
  for (int y = bounds.y0; y < bounds.y1; ++y)
    for (int x = bounds.x0; x < bounds.x1; ++x) {
      const auto value = [&](std::string_view name) { return image.at(x - bounds.x0, y - bounds.y0, channel(name)); };
      EXPECT_EQ(value("R"), float(film.pixel(x, y).mean[0])) << x << ", " << y;
      EXPECT_EQ(value("B"), float(film.pixel(x, y).mean[2])) << x << ", " << y;
      EXPECT_EQ(value("Z"), float(film.features(x, y).depth() / 2)) << x << ", " << y;
      EXPECT_EQ(value("samples"), float(film.samples(x, y))) << x << ", " << y;
      taken += double(value("samples"));
    }
  EXPECT_EQ(taken, 2 * cells.area());
}

// A picture that cannot be encoded is the writer's matter.
TEST(SecondsToFinish, of_an_unknown_format_are_those_of_its_error_alone) {
  const FinishTime time = seconds_to_finish({0, 0, 64, 64}, {{"a.xyz"}, false});
  EXPECT_GT(time.error, 0);
  EXPECT_EQ(time.encoding, 0);
}

}  // namespace montelux
