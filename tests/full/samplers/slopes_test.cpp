// The variance of every point set against the number of points, N = 1, 2, 4, ..., 4096, and its exponent with its
// error, held to theory; and the variance of a picture by the samples of a pass. Both tables are those of
// docs/samplers.md. To rewrite them: MONTELUX_WRITE_DOCUMENTS=1 full_samplers
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "render_scenes.h"
#include "sampler_variance.h"

namespace montelux::test {
namespace {

const std::filesystem::path document = std::filesystem::path(MONTELUX_SOURCE_DIR) / "docs/samplers.md";

// Puts the text between the two comments that name the part.
void put_into_document(const std::string& part, const std::string& text) {
  if (!std::getenv("MONTELUX_WRITE_DOCUMENTS")) return;
  const std::string begin = "<!-- " + part + " -->\n", end = "<!-- end -->";
  std::string all = read_text(document);
  const std::size_t from = all.find(begin);
  ASSERT_NE(from, std::string::npos) << part;
  const std::size_t to = all.find(end, from);
  ASSERT_NE(to, std::string::npos) << part;
  all.replace(from + begin.size(), to - from - begin.size(), text);
  std::ofstream(document, std::ios::binary) << all;
}

std::string text_of(const char* format, double a, double b = 0) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, a, b);
  return buffer;
}

bool is_net(PointSetKind kind) {
  return kind == PointSetKind::sobol || kind == PointSetKind::padded_sobol || kind == PointSetKind::blue_noise ||
         kind == PointSetKind::pmj02;
}

// What the exponent between 64 and 4096 points must lie in: the asymptotic rate where it is reached by then, else room
// for its logarithms. Sources in docs/samplers.md.
struct Range {
  double low, high;
};
Range theory(PointSetKind kind, const SquareIntegrand& f) {
  if (kind == PointSetKind::independent) return {-1, -1};
  const bool edge = f.f == square_disk.f || f.f == square_triangle.f;
  const bool lattice = kind == PointSetKind::lattice, halton = kind == PointSetKind::halton;
  if (f.f == line_exp.f) return lattice ? Range{-2, -2} : Range{-3, -3};
  // Straight edges: a lattice may meet them better than its rate for curved ones, up to -2 except for logarithms.
  if (edge) return {lattice || halton ? -2.1 : -1.7, -1.3};
  if (kind == PointSetKind::stratified) return {-2.1, -1.9};
  // Powers of two are no round numbers in base 3: between the rates -2 and -3.
  if (halton) return {-3.2, -1.9};
  if (lattice) return f.f == square_periodic.f ? Range{-4.2, -3.5} : Range{-2.3, -1.8};
  return {-3.1, -2.6};
}

// Theory's own variance where it is known exactly, else none.
std::optional<double> exact_variance(PointSetKind kind, const SquareIntegrand& f, int m) {
  const std::uint32_t n = 1u << m;
  const bool line = f.one_dimensional, edge = f.f == square_disk.f || f.f == square_triangle.f;
  if (edge) return std::nullopt;
  if (kind == PointSetKind::independent) return independent_variance(f, n);
  if (kind == PointSetKind::stratified && (line || m % 2 == 0)) return jittered_variance(f, n);
  if (is_net(kind)) return scrambled_net_variance(f, m);
  if (kind == PointSetKind::lattice && f.f == square_periodic.f) return lattice_variance_of_periodic(m);
  if (kind == PointSetKind::lattice && line) return lattice_variance_of_exp(n);
  return std::nullopt;
}

TEST(Samplers, have_the_variance_of_theory_at_every_number_of_points) {
  constexpr int last = 12, first_of_fit = 6;
  const double level = sidak_level(family_level, double(point_set_names.size() * square_integrands().size()) * 15);
  std::string text;
  for (const SquareIntegrand& f : square_integrands()) {
    text += "\n**" + f.name + "**\n\n| sampler | N = 1 | 4 | 16 | 64 | 256 | 1024 | 4096 | exponent |\n|";
    for (int i = 0; i < 9; ++i) text += "---|";
    text += "\n";
    for (const NamedPointSet& set : point_set_names) {
      std::vector<double> n;
      std::vector<SampleSummary> variances;
      text += "| " + std::string(set.name) + " |";
      for (int m = 0; m <= last; ++m) {
        const SampleSummary v = measured_variance(set.kind, 1u << m, f, 2000);
        if (m % 2 == 0) text += text_of(" %.2e |", v.mean);
        if (const auto truth = exact_variance(set.kind, f, m)) {
          EXPECT_GT(t_test(v, *truth).p_value, level)
              << set.name << ", " << f.name << ", N = " << (1 << m) << ": " << v.mean << " for " << *truth;
        }
        if (m >= first_of_fit) n.push_back(double(1 << m)), variances.push_back(v);
      }
      const Exponent e = fitted_exponent(n, variances);
      text += text_of(" %.3f ± %.3f |\n", e.value, e.standard_error);
      const Range range = theory(set.kind, f);
      EXPECT_GT(at_least_p_value(e.value, e.standard_error, range.low), level) << set.name << ", " << f.name;
      EXPECT_GT(at_most_p_value(e.value, e.standard_error, range.high), level) << set.name << ", " << f.name;
      // The test has power: it would find an exponent that is off by a third.
      EXPECT_LT(at_most_p_value(e.value + 1.0 / 3, e.standard_error, range.low), level) << set.name << ", " << f.name;
    }
  }
  std::fputs(text.c_str(), stdout);
  put_into_document("exponents", text + "\n");
}

// The picture that is bundled, in passes of N samples: the mean over pixels of the variance of a pass, times N, over
// that of independent points.
TEST(Samplers, have_less_noise_in_a_picture_than_independent_points) {
  const std::filesystem::path room = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/first-light";
  const TestScene scene(read_text(room / "first-light.pbrt"), room.string(), std::pair(48, 36));
  constexpr int passes = 32;
  const std::vector<int> counts{1, 4, 16, 64};
  const auto inefficiency = [&](PointSetKind kind, int n) {
    const Film film = scene.render(kind, {n, passes}, 3, Lanes::native, 0).film;
    return film.error().relative_mse * passes * n;
  };
  std::vector<double> independent;
  for (int n : counts) independent.push_back(inefficiency(PointSetKind::independent, n));
  std::string text = "| sampler |";
  for (int n : counts) text += text_of(n == 1 ? " N = %.0f |" : " %.0f |", n);
  text += "\n|";
  for (std::size_t i = 0; i <= counts.size(); ++i) text += "---|";
  text += "\n";
  for (const NamedPointSet& set : point_set_names) {
    text += "| " + std::string(set.name) + " |";
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const double ratio =
          (set.kind == PointSetKind::independent ? independent[i] : inefficiency(set.kind, counts[i])) / independent[i];
      text += text_of(" %.3f |", ratio);
      // Single points are random; the noise of the ratio is some 2 %.
      EXPECT_LT(ratio, counts[i] >= 64 && set.kind != PointSetKind::independent ? 1.0 : 1.15) << set.name;
    }
    text += "\n";
  }
  std::fputs(text.c_str(), stdout);
  put_into_document("picture", text);
}

}  // namespace
}  // namespace montelux::test
