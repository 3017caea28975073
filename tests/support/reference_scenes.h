// Pictures of one scene by another renderer, with their standard errors, and the test whether ours agree.
#pragma once
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "image/image_file.h"
#include "render_scenes.h"
#include "statistics.h"

namespace montelux::test {

// The folder of scenes with reference pictures; none where it is absent.
inline std::optional<std::filesystem::path> reference_folder() {
  const char* stated = std::getenv("MONTELUX_SCENES");
  const std::filesystem::path folder =
      stated ? std::filesystem::path(stated) : std::filesystem::path(MONTELUX_SOURCE_DIR) / "../shared/scenes";
  if (!std::filesystem::is_directory(folder)) return std::nullopt;
  return folder;
}

struct ReferenceScene {
  std::string name;
  std::filesystem::path scene, mean, standard_error;
};

inline void PrintTo(const ReferenceScene& s, std::ostream* out) { *out << s.name; }

// Every NAME.pbrt below the folder that has NAME.reference.exr and NAME.stderr.exr, by name.
inline std::vector<ReferenceScene> reference_scenes() {
  std::vector<ReferenceScene> all;
  const auto folder = reference_folder();
  if (!folder) return all;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder)) {
    std::filesystem::path p = entry.path();
    if (p.extension() != ".pbrt") continue;
    ReferenceScene s{p.stem().string(), p, p, p};
    s.mean.replace_extension(".reference.exr"), s.standard_error.replace_extension(".stderr.exr");
    if (std::filesystem::exists(s.mean) && std::filesystem::exists(s.standard_error)) all.push_back(s);
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return all;
}

// One number a pixel: the mean over the channels, and the variance of that.
struct GrayPicture {
  int width = 0, height = 0;
  std::vector<double> mean, variance;
  double degrees = 1;  // of freedom, of each variance
};

// The reference renderer draws one set of wavelengths for all channels of a path, so that their errors are correlated:
// the standard error of their mean is taken as the mean of theirs, which is an upper bound. It is of 8 runs.
inline GrayPicture read_reference(const ReferenceScene& s) {
  const auto read = [](const std::filesystem::path& path) {
    Result<Image> image = read_image(path);
    if (!image) throw std::runtime_error("cannot read " + path.string());
    return std::move(image->pixels);
  };
  const PixelBuffer mean = read(s.mean), error = read(s.standard_error);
  if (mean.width != error.width || mean.height != error.height) throw std::runtime_error(s.name + ": sizes differ");
  const auto a = rgb_channels(mean), b = rgb_channels(error);
  GrayPicture g{mean.width, mean.height, {}, {}, 7};
  for (int y = 0; y < mean.height; ++y)
    for (int x = 0; x < mean.width; ++x) {
      const Rgb m = rgb_at(mean, a, x, y), e = rgb_at(error, b, x, y);
      const double sigma = (double(e.c[0]) + double(e.c[1]) + double(e.c[2])) / 3;
      g.mean.push_back((double(m.c[0]) + double(m.c[1]) + double(m.c[2])) / 3);
      g.variance.push_back(sigma * sigma);
    }
  return g;
}

// By path tracing, with pixels that are independent of each other.
inline RenderResult render_independent_pixels(const TestScene& scene, PassPlan plan, std::uint32_t seed, int threads) {
  RenderSettings settings = scene.settings(PointSetKind::padded_sobol, plan, seed, threads);
  settings.image.sharing = nullptr;
  const PathTracer path = scene.tracer();
  RenderObserver silent;
  return render(path, settings, silent);
}

// Of a film of a grey scene, whose channels are equal up to rounding. The film's pixels must be independent of each
// other.
inline GrayPicture gray_picture(const Film& film) {
  const PixelBounds& b = film.bounds();
  GrayPicture g{b.width(), b.height(), {}, {}, double(film.image().passes) - 1};
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) {
      const PixelEstimate& p = film.pixel(x, y);
      g.mean.push_back(mean_of_channels(p.mean));
      g.variance.push_back((p.variance_of_mean(0) + p.variance_of_mean(1) + p.variance_of_mean(2)) / 3);
    }
  return g;
}

// Mean of a block, variance of that mean, and its degrees of freedom (Satterthwaite 1946): a block whose variance comes
// from a few bright pixels has hardly more than one of them.
struct Block {
  double mean = 0, variance = 0, degrees = 1;
};
inline Block block_of(const GrayPicture& g, int x0, int y0, int x1, int y1) {
  Block b;
  double n = 0, squares = 0;
  for (int y = y0; y < std::min(y1, g.height); ++y)
    for (int x = x0; x < std::min(x1, g.width); ++x) {
      const auto i = std::size_t(y) * std::size_t(g.width) + std::size_t(x);
      b.mean += g.mean[i], b.variance += g.variance[i], squares += g.variance[i] * g.variance[i], n += 1;
    }
  if (squares > 0) b.degrees = g.degrees * b.variance * b.variance / squares;
  b.mean /= n, b.variance /= n * n;
  return b;
}

inline TestResult welch_test(const Block& a, const Block& b) {
  const double v = a.variance + b.variance;
  if (v == 0) return {0, 0, a.mean == b.mean ? 1.0 : 0.0, "no spread"};
  const double t = (a.mean - b.mean) / std::sqrt(v);
  const double degrees = v * v / (a.variance * a.variance / a.degrees + b.variance * b.variance / b.degrees);
  return {t, degrees, 2 * student_t_cdf(-std::abs(t), degrees), {}};
}

struct BlockDifference {
  int x = 0, y = 0;
  Block ours, reference;
  TestResult test;
};

// Image mean and 8x8 blocks of two pictures. A family of scenes shares one level, half for means, half for blocks.
struct Comparison {
  Block ours, reference;  // of the whole image
  TestResult image;
  std::vector<BlockDifference> blocks;  // most significant first

  double ratio() const { return ours.mean / reference.mean; }
  double ratio_error() const {
    return ratio() *
           std::sqrt(ours.variance / (ours.mean * ours.mean) + reference.variance / (reference.mean * reference.mean));
  }
  double relative_error() const { return std::sqrt(ours.variance) / ours.mean; }
  // How many blocks differ, where the scene has `level` for itself.
  std::size_t differing(double level) const {
    const double each = sidak_level(level / 2, double(blocks.size()));
    std::size_t n = 0;
    for (const BlockDifference& b : blocks) n += b.test.p_value < each ? 1 : 0;
    return n;
  }
  bool agrees(double level) const { return image.p_value >= level / 2 && differing(level) == 0; }
};

inline Comparison compare(const GrayPicture& ours, const GrayPicture& reference) {
  Comparison c;
  c.ours = block_of(ours, 0, 0, ours.width, ours.height);
  c.reference = block_of(reference, 0, 0, reference.width, reference.height);
  c.image = welch_test(c.ours, c.reference);
  for (int y = 0; y < ours.height; y += 8)
    for (int x = 0; x < ours.width; x += 8) {
      BlockDifference b{x, y, block_of(ours, x, y, x + 8, y + 8), block_of(reference, x, y, x + 8, y + 8), {}};
      b.test = welch_test(b.ours, b.reference);
      c.blocks.push_back(b);
    }
  std::sort(c.blocks.begin(), c.blocks.end(),
            [](const auto& a, const auto& b) { return a.test.p_value < b.test.p_value; });
  return c;
}

// A picture that is wrong by a factor in a part: what the comparison must find.
inline GrayPicture scaled(GrayPicture g, double factor, int x0, int y0, int x1, int y1) {
  for (int y = y0; y < std::min(y1, g.height); ++y)
    for (int x = x0; x < std::min(x1, g.width); ++x) {
      const auto i = std::size_t(y) * std::size_t(g.width) + std::size_t(x);
      g.mean[i] *= factor, g.variance[i] *= factor * factor;
    }
  return g;
}

inline constexpr double reference_level = 0.01;
inline constexpr int reference_passes = 32;

// Renders a scene and holds it against its reference.
inline Comparison compare_with_reference(const ReferenceScene& s, int samples, int threads) {
  const TestScene scene(read_text(s.scene), s.scene.parent_path().string());
  const PassPlan plan{std::max(1, samples / reference_passes), reference_passes};
  const RenderResult result = render_independent_pixels(scene, plan, 1, threads);
  if (result.film.non_finite() > 0) throw std::runtime_error(s.name + ": samples that are not finite");
  return compare(gray_picture(result.film), read_reference(s));
}

// A line of the table of docs/validation.md.
inline std::string table_row(const std::string& name, const Comparison& c, int samples, double level) {
  char row[400];
  const BlockDifference& worst = c.blocks.front();
  std::snprintf(row, sizeof row,
                "| %s | %d | %.5f | %.5f | %.4f ± %.4f | %+.2f | %.2f %% | %zu of %zu | %+.2f at (%d, %d) |",
                name.c_str(), samples, c.ours.mean, c.reference.mean, c.ratio(), c.ratio_error(), c.image.statistic,
                100 * c.relative_error(), c.differing(level), c.blocks.size(), worst.test.statistic, worst.x, worst.y);
  return row;
}
inline constexpr const char* table_head =
    "| scene | samples | ours | reference | ratio | t of the mean | our error | blocks that differ | largest block |\n"
    "|---|---|---|---|---|---|---|---|---|";

}  // namespace montelux::test
