#include "io/pbrt/spectra.h"

#include <algorithm>

#include "color/named_spectra.h"
#include "io/numbers.h"
#include "io/pbrt/lexer.h"
#include "io/text_file.h"

namespace montelux::pbrt {

std::optional<SampledValue> sampled_from_pairs(const std::vector<float>& pairs, const SourceLocation& where,
                                               Reporter& report) {
  if (pairs.empty() || pairs.size() % 2 != 0) {
    report.error(where, "a sampled spectrum takes pairs of wavelength and value; found " +
                            std::to_string(pairs.size()) + " numbers");
    return std::nullopt;
  }
  SampledValue sampled;
  for (std::size_t i = 0; i < pairs.size(); i += 2) {
    if (i > 0 && pairs[i] <= pairs[i - 2]) {
      report.error(where, "wavelengths must increase; " + shortest(pairs[i]) + " nm follows " + shortest(pairs[i - 2]));
      return std::nullopt;
    }
    sampled.wavelengths.push_back(pairs[i]);
    sampled.values.push_back(pairs[i + 1]);
  }
  if (sampled.wavelengths.front() <= 0) {
    report.error(where, "wavelengths must be positive, in nm");
    return std::nullopt;
  }
  return sampled;
}

namespace {

std::optional<SpectrumValue> read_spectrum_file(const std::string& path, const SourceLocation& where,
                                                Reporter& report) {
  auto text = read_whole_file(path);
  if (!text) {
    report.error(where, text.error());
    return std::nullopt;
  }
  Lexer lexer(without_byte_order_mark(*text), std::make_shared<const std::string>(path));
  std::vector<float> pairs;
  for (Token token = lexer.next(); token.kind != TokenKind::end; token = lexer.next()) {
    auto value = to_float(token.text);
    if (!value) {
      report.error(lexer.where(token), "a spectrum file holds pairs of numbers; found " + describe(token));
      return std::nullopt;
    }
    pairs.push_back(*value);
  }
  auto sampled = sampled_from_pairs(pairs, where, report);
  if (!sampled) return std::nullopt;
  return SpectrumValue(std::move(*sampled));
}

}  // namespace

std::optional<SpectrumValue> named_spectrum(const std::string& name, const std::string& folder,
                                            const SourceLocation& where, Reporter& report) {
  const std::vector<std::string_view> names = named_spectra();
  if (std::find(names.begin(), names.end(), name) != names.end()) return SpectrumValue(NamedSpectrum{name});
  std::string path = resolve_path(folder, name);
  if (is_regular_file(path)) return read_spectrum_file(path, where, report);
  std::string_view near = nearest_name(name, names);
  report.error(where, "'" + printable(name) + "' is neither a named spectrum nor a file",
               near.empty() ? "examples of named spectra: metal-Cu-eta, glass-BK7, stdillum-D65"
                            : "did you mean '" + std::string(near) + "'?");
  return std::nullopt;
}

}  // namespace montelux::pbrt
