// From "x=0:pi/2,y=0:x" or "disk:radius=2" to a domain.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/domain/domain.h"
#include "lab/expression/text_part.h"
#include "parameter/choice.h"

namespace montelux::lab {
namespace {

class Reader {
 public:
  void read(const std::string& text) {
    text_ = text;
    const std::size_t equals = text.find('='), colon = text.find(':');
    if (text.find_first_not_of(' ') == std::string::npos) return complain(0, 1, "a domain is missing");
    if (equals == std::string::npos || colon < equals)
      read_shape();
    else
      read_sides(split({text_, 0}, ','));
  }

  // Further errors would not change that the domain is rejected.
  bool full() const { return factors_.size() + mistakes_.size() > max_dimensions; }

  ParsedDomain finish() {
    std::size_t dimension = 0;
    for (const DomainFactor& f : factors_) dimension += std::visit([](const auto& x) { return x.dimension(); }, f);
    if (mistakes_.empty() && dimension > max_dimensions)
      complain(0, text_.size(),
               fmt::format("the domain has {} dimensions; the maximum is {}", dimension, max_dimensions));
    ParsedDomain result{std::nullopt, std::move(mistakes_)};
    if (result.mistakes.empty()) result.domain.emplace(std::move(factors_));
    return result;
  }

 private:
  void complain(std::size_t position, std::size_t length, std::string message) {
    mistakes_.push_back({text_, {position, std::max<std::size_t>(1, length), std::move(message)}});
  }
  void complain(TextPart part, std::string message) { complain(part.begin, part.text.size(), std::move(message)); }

  std::optional<Expression> read_expression(TextPart part, const std::vector<std::string>& variables) {
    CompiledExpression compiled = compile(part.text, variables);
    for (TextMistake& m : compiled.mistakes) complain(part.begin + m.position, m.length, std::move(m.message));
    return std::move(compiled.expression);
  }

  // Adds a factor unless one of its names is already used.
  void add(DomainFactor factor, TextPart where) {
    std::vector<std::string> names = std::visit([](const auto& f) { return f.names(); }, factor);
    for (const std::string& name : names)
      if (std::ranges::find(names_, name) != names_.end())
        return complain(where, fmt::format("there are two variables \"{}\"", name));
    names_.insert(names_.end(), names.begin(), names.end());
    factors_.push_back(std::move(factor));
  }

  // The intervals up to the maximum number.
  void read_sides(const std::vector<TextPart>& parts) {
    for (const TextPart& part : parts) {
      if (factors_.size() + mistakes_.size() >= max_dimensions)
        return complain(trimmed(part), factors_.size() < max_dimensions
                                           ? "there are too many errors to continue"
                                           : fmt::format("the domain has more than {} dimensions", max_dimensions));
      read_side(trimmed(part));
    }
  }

  // "x=0:1"
  void read_side(TextPart part) {
    const std::vector<TextPart> halves = split(part, '=', 2);
    if (halves.size() < 2 && find_entity(domain_table(), split(part, ':').front().text))
      return complain(part, "a named domain needs a separate --over; several give their product");
    if (halves.size() < 2) return complain(part, "an interval is written name=low:high, for example x=0:1");
    const TextPart name = trimmed(halves[0]);
    if (!valid_variable(name.text))
      return complain(name,
                      fmt::format("\"{}\" cannot be a variable: names start with a letter, followed by letters and "
                                  "digits, and must not be a function or constant",
                                  name.text));
    const std::vector<TextPart> bounds = split(halves[1], ':');
    if (bounds.size() != 2) return complain(trimmed(halves[1]), "bounds are written low:high, for example 0:1");
    const std::size_t before = mistakes_.size();
    auto low = read_expression(trimmed(bounds[0]), names_), high = read_expression(trimmed(bounds[1]), names_);
    if (!low || !high) return keep_name(name);
    Side side{std::string(name.text), std::move(*low), std::move(*high)};
    check_bounds(side, trimmed(bounds[0]), trimmed(bounds[1]));
    if (mistakes_.size() == before)
      add(std::move(side), name);
    else
      keep_name(name);
  }

  // So that an error in its bounds does not make a variable unknown elsewhere.
  void keep_name(TextPart name) { names_.emplace_back(name.text); }

  void check_bounds(Side& side, TextPart low, TextPart high) {
    const std::vector<double> nothing(names_.size(), 0.5);
    const auto fixed = [&](const Expression& e) -> std::optional<double> {
      return e.constant() ? std::optional(e(nothing)) : std::nullopt;
    };
    const auto a = fixed(side.low), b = fixed(side.high);
    side.from_minus_infinity = a && std::isinf(*a) && *a < 0;
    side.to_infinity = b && std::isinf(*b) && *b > 0;
    if (a && (std::isnan(*a) || (std::isinf(*a) && *a > 0))) complain(low, "a lower bound must be finite or -inf");
    if (b && (std::isnan(*b) || (std::isinf(*b) && *b < 0))) complain(high, "an upper bound must be finite or inf");
    if (!a || !b) return;
    if (*a >= *b)
      complain(low.begin, high.begin + high.text.size() - low.begin, "the lower bound is not below the upper one");
    side.fixed = std::pair(*a, *b);
  }

  // "disk:radius=2"
  void read_shape() {
    const std::vector<TextPart> halves = split({text_, 0}, ':', 2);
    const TextPart name = trimmed(halves[0]);
    const EntitySpec* entry = find_entity(domain_table(), name.text);
    if (!entry)
      return complain(
          name, unknown_name("domain", name.text, names_of(domain_table())).message + "; an interval is written x=0:1");
    settings_.clear();
    const std::size_t before = mistakes_.size();
    if (halves.size() > 1)
      for (const TextPart& part : split(halves[1], ',')) read_setting(*entry, trimmed(part));
    auto factors = shape(name.text);
    if (mistakes_.size() > before) return;
    for (DomainFactor& factor : factors) add(std::move(factor), name);
  }

  void read_setting(const EntitySpec& entry, TextPart part) {
    const std::vector<TextPart> halves = split(part, '=', 2);
    const TextPart name = trimmed(halves[0]);
    std::vector<std::string_view> valid;
    for (const ParameterSpec& p : entry.parameters) valid.push_back(p.name);
    if (std::ranges::find(valid, name.text) == valid.end())
      return complain(name, unknown_name(fmt::format("setting of {}", entry.name), name.text, valid).message);
    if (halves.size() < 2 || trimmed(halves[1]).text.empty())
      return complain(part, fmt::format("{0} is written {0}=VALUE", name.text));
    settings_.emplace_back(name.text, trimmed(halves[1]));
  }

  const TextPart* setting(std::string_view name) const {
    const auto it = std::ranges::find(settings_, name, &std::pair<std::string_view, TextPart>::first);
    return it == settings_.end() ? nullptr : &it->second;
  }

  // A number, which may be an expression such as pi/2.
  std::optional<double> number(TextPart part) {
    auto e = read_expression(part, {});
    if (!e) return std::nullopt;
    const double value = (*e)({});
    if (std::isfinite(value)) return value;
    complain(part, "a finite number is needed here");
    return std::nullopt;
  }

  double positive(std::string_view name, double otherwise) {
    const TextPart* part = setting(name);
    if (!part) return otherwise;
    const auto value = number(*part);
    if (value && *value <= 0) complain(*part, fmt::format("the {} must be above 0", name));
    return value.value_or(otherwise);
  }

  std::size_t dimension(std::size_t otherwise) {
    const TextPart* part = setting("dimension");
    if (!part) return otherwise;
    const auto value = number(*part);
    if (value && *value >= 1 && *value <= double(max_dimensions) && *value == std::floor(*value))
      return std::size_t(*value);
    if (value) complain(*part, fmt::format("the dimension must be a whole number from 1 to {}", max_dimensions));
    return otherwise;
  }

  // "(0, 1)" or "(0, 1, 2)"; returns the number of coordinates, 0 if there is no such setting.
  std::size_t corner(std::string_view name, std::array<double, 3>& point) {
    const TextPart* part = setting(name);
    if (!part) return 0;
    const std::string_view t = part->text;
    std::vector<TextPart> coordinates;
    if (t.size() >= 2 && t.front() == '(' && t.back() == ')')
      coordinates = split({t.substr(1, t.size() - 2), part->begin + 1}, ',');
    if (coordinates.size() != 2 && coordinates.size() != 3) {
      complain(*part, "a corner is written (x, y) or (x, y, z)");
      return 0;
    }
    point = {};
    for (std::size_t k = 0; k < coordinates.size(); ++k) point[k] = number(trimmed(coordinates[k])).value_or(0);
    return coordinates.size();
  }

  Triangle triangle() {
    Triangle t;
    std::size_t min_coordinates = 3, max_coordinates = 0;
    const std::string_view names[] = {"a", "b", "c"};
    for (std::size_t k = 0; k < 3; ++k)
      if (const std::size_t n = corner(names[k], t.corners[k]))
        min_coordinates = std::min(min_coordinates, n), max_coordinates = std::max(max_coordinates, n);
    t.in_space = max_coordinates == 3;
    if (max_coordinates > min_coordinates)
      complain(0, text_.size(), "all corners must have two coordinates, or all three");
    if (!(*t.volume() > 0)) complain(0, text_.size(), "the corners are collinear");
    return t;
  }

  bool projected() {
    const TextPart* part = setting("measure");
    if (!part || part->text == "solid-angle") return false;
    if (part->text != "projected")
      complain(*part, unknown_name("measure", part->text, {"solid-angle", "projected"}).message);
    return true;
  }

  std::vector<DomainFactor> shape(std::string_view name) {
    if (name == "disk") return {Disk{positive("radius", 1)}};
    if (name == "ball") return {Ball{positive("radius", 1)}};
    if (name == "sphere") return {Sphere{positive("radius", 1)}};
    if (name == "hemisphere") return {Hemisphere{projected()}};
    if (name == "triangle") return {triangle()};
    if (name == "simplex") return {Simplex{dimension(2)}};
    std::vector<DomainFactor> sides;
    for (std::size_t k = 1, n = dimension(3); k <= n; ++k)
      sides.push_back(Side{fmt::format("x{}", k), *compile("0", {}).expression, *compile("1", {}).expression, false,
                           false, std::pair(0.0, 1.0)});
    return sides;
  }

  std::string text_;
  std::vector<DomainFactor> factors_;
  std::vector<std::string> names_;
  std::vector<DomainMistake> mistakes_;
  std::vector<std::pair<std::string_view, TextPart>> settings_;
};

}  // namespace

ParsedDomain parse_domain(const std::vector<std::string>& texts) {
  Reader reader;
  for (const std::string& text : texts)
    if (!reader.full()) reader.read(text);
  return reader.finish();
}

}  // namespace montelux::lab
