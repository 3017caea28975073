#include "lab/statement/statement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/expression/text_part.h"
#include "lab/statement/density_check.h"
#include "lab/statement/value_text.h"
#include "parameter/choice.h"

namespace montelux::lab {
namespace {

bool any_of_kind(const std::vector<Method>& methods, MethodKind kind) {
  return std::ranges::any_of(methods, [kind](const Method& m) { return m.kind == kind; });
}

class Reader {
 public:
  Reader(const IntegralStatement& statement, const std::vector<Method>& methods)
      : statement_(statement), methods_(methods) {}

  StatementReading read() {
    read_domain();
    if (!domain_) return std::move(reading_);
    auto integrand = expression("the integrand", {statement_.integrand, 0}, statement_.integrand, variables());
    if (integrand) {
      stated_.domain = domain_;
      stated_.problem.integrand = {domain_->dimension(), on_cube(domain_, *integrand)};
    }
    for (const std::string& text : statement_.densities) read_density(text);
    read_control();
    read_target();
    // Measuring needs an integrand and densities that can be evaluated.
    if (reading_.mistakes.empty()) check_densities();
    if (reading_.mistakes.empty()) check_coverage();
    if (reading_.mistakes.empty()) check_control_integral();
    check_methods();
    if (reading_.mistakes.empty()) reading_.stated = std::move(stated_);
    return std::move(reading_);
  }

 private:
  const std::vector<std::string>& variables() const { return domain_->variables(); }
  void complain(std::string message) { reading_.mistakes.push_back(std::move(message)); }
  void complain(std::string_view what, const std::string& whole, TextMistake m) {
    m.message = fmt::format("{}: {}", what, m.message);
    complain(explain(whole, m));
  }

  std::optional<Expression> expression(std::string_view what, TextPart part, const std::string& whole,
                                       const std::vector<std::string>& names) {
    CompiledExpression compiled = compile(part.text, names);
    for (TextMistake& m : compiled.mistakes) {
      m.position += part.begin;
      complain(what, whole, std::move(m));
    }
    return std::move(compiled.expression);
  }

  void read_domain() {
    ParsedDomain parsed = parse_domain(statement_.over);
    for (const DomainMistake& m : parsed.mistakes) complain("--over", m.text, m.mistake);
    if (parsed.domain)
      domain_ = std::make_shared<const Domain>(std::move(*parsed.domain));
    else  // report now what is wrong for any variables
      for (const TextMistake& m : compile(statement_.integrand, {}).mistakes)
        if (!m.message.starts_with("unknown name")) complain("the integrand", statement_.integrand, m);
  }

  // "2*x, inverse=sqrt(u), sampling=table, bound=2"
  void read_density(const std::string& text) {
    const std::vector<TextPart> parts = split({text, 0}, ',');
    UserDensity density;
    if (auto e = expression("--pdf", trimmed(parts[0]), text, variables()))
      density.density = density_on_cube(domain_, std::move(*e));
    for (std::size_t i = 1; i < parts.size(); ++i) read_setting(density, trimmed(parts[i]), text);
    stated_.problem.densities.push_back(std::move(density));
    stated_.densities.push_back({text, 1, 0, std::nullopt});
  }

  void read_setting(UserDensity& density, TextPart part, const std::string& text) {
    const std::vector<TextPart> halves = split(part, '=', 2);
    const TextPart name = trimmed(halves[0]), value = halves.size() > 1 ? trimmed(halves[1]) : TextPart{};
    const auto wrong = [&](TextPart where, std::string message) {
      complain("--pdf", text, {where.begin, std::max<std::size_t>(1, where.text.size()), std::move(message)});
    };
    if (name.text == "inverse" && !value.text.empty()) return read_inverse(density, value, text);
    if (name.text == "bound" && !value.text.empty()) {
      const auto e = expression("--pdf", value, text, {});
      if (e && !((*e)({}) > 0)) wrong(value, "the bound of a density must be above 0");
      if (e) density.bound = (*e)({});
    } else if (name.text == "sampling" && !value.text.empty()) {
      if (value.text == "table")
        density.sampling = DensitySampling::table;
      else if (value.text == "rejection")
        density.sampling = DensitySampling::rejection;
      else
        wrong(value, unknown_name("way of sampling", value.text, {"table", "rejection"}).message);
    } else {
      wrong(name, name.text == "inverse" || name.text == "bound" || name.text == "sampling"
                      ? fmt::format("{0} is written {0}=VALUE", name.text)
                      : unknown_name("setting of a density", name.text, {"inverse", "sampling", "bound"}).message);
    }
  }

  // One expression for each variable of the domain, of uniform numbers: u, or u1, u2, ...
  void read_inverse(UserDensity& density, TextPart part, const std::string& text) {
    const std::size_t dimension = domain_->dimension();
    if (!domain_->invertible())
      return complain("--pdf", text, {part.begin, part.text.size(), "an inverse needs a domain of intervals"});
    std::vector<TextPart> components{part};
    if (dimension > 1) {
      const bool list = part.text.size() > 2 && part.text.front() == '(' && part.text.back() == ')';
      if (list) components = split({part.text.substr(1, part.text.size() - 2), part.begin + 1}, ',');
    }
    if (components.size() != dimension)
      return complain("--pdf", text,
                      {part.begin, part.text.size(),
                       fmt::format("the inverse has a component for each of {}: inverse=(..., ...)",
                                   fmt::join(variables(), ", "))});
    std::vector<std::string> names;
    for (std::size_t d = 1; d <= dimension; ++d) names.push_back(dimension == 1 ? "u" : fmt::format("u{}", d));
    std::vector<Expression> inverse;
    for (TextPart component : components)
      if (auto e = expression("--pdf", trimmed(component), text, names)) inverse.push_back(std::move(*e));
    if (inverse.size() != dimension) return;
    density.inverse = inverse_on_cube(domain_, std::move(inverse));
    density.sampling = DensitySampling::inverse;
  }

  void read_control() {
    const auto& text = statement_.control;
    const auto& value = statement_.control_integral;
    if (value && !text) complain("--control-integral is given without --control EXPR");
    if (text && !value) complain("--control needs its integral over the domain: --control-integral VALUE");
    std::optional<Expression> control, integral;
    if (text) control = expression("--control", {*text, 0}, *text, variables());
    if (value) integral = expression("--control-integral", {*value, 0}, *value, {});
    if (!control || !integral) return;
    const double number = (*integral)({});
    if (!std::isfinite(number)) return complain("--control-integral is not finite");
    stated_.problem.control = ControlVariate{on_cube(domain_, *control), number};
  }

  void read_target() {
    if (!statement_.target) return;
    if (auto e = expression("--target", {*statement_.target, 0}, *statement_.target, variables()))
      stated_.problem.target = density_on_cube(domain_, std::move(*e));
  }

  // Where a point of the cube lies in the domain: "x = 0.25, y = 1".
  std::string place(const std::vector<double>& cube) const {
    const std::vector<char> all(variables().size(), 1);
    const DomainPoints p = domain_->map({cube, cube.size(), 1}, all);
    std::string text;
    for (std::size_t k = 0; k < variables().size(); ++k)
      text += fmt::format("{}{} = {:.4g}", k == 0 ? "" : ", ", variables()[k], *p.columns[k]);
    return text;
  }

  void check_densities() {
    for (std::size_t k = 0; k < stated_.densities.size(); ++k) {
      UserDensity& density = stated_.problem.densities[k];
      DensityFacts& facts = stated_.densities[k];
      const DensityCheck check = check_density(density.density, domain_->dimension());
      facts.integral = check.integral, facts.standard_error = check.standard_error;
      const std::string name = fmt::format("--pdf \"{}\"", facts.text);
      if (check.non_finite > 0) complain(fmt::format("{}: not finite at {} of 65536 points", name, check.non_finite));
      if (check.negative_at) complain(fmt::format("{}: negative at {}", name, place(*check.negative_at)));
      if (check.non_finite > 0 || check.negative_at) continue;
      if (!(check.integral > 0)) {
        complain(fmt::format("{}: 0 everywhere in the domain", name));
      } else if (statement_.normalize_densities) {
        density.scale = 1 / check.integral;
        facts.scaled_by = density.scale;
      } else if (std::abs(check.integral - 1) > std::max(1e-4, 6 * check.standard_error)) {
        complain(fmt::format("{}: integrates to {} over the domain, not to 1 (--normalize-pdf divides by it)", name,
                             value_with_error(check.integral, check.standard_error)));
        continue;
      }
      if (density.inverse && inverse_disagreement(density, domain_->dimension()) > 8)
        complain(fmt::format("{}: the points of the inverse are not distributed like the density", name));
    }
  }

  void check_control_integral() {
    if (!stated_.problem.control) return;
    const ControlCheck check = check_control(*stated_.problem.control, domain_->dimension());
    if (!check.contradicts) return;
    complain(
        fmt::format("--control-integral {}: samples of --control \"{}\" give {}, which excludes it at the level {:g}",
                    *statement_.control_integral, *statement_.control,
                    value_with_error(check.integral, check.standard_error), ControlCheck::level));
  }

  void check_coverage() {
    const Problem& problem = stated_.problem;
    if (problem.densities.empty()) return;
    const std::span<const UserDensity> all = problem.densities;
    if (any_of_kind(methods_, MethodKind::importance))
      report_missed(missed_by(problem, all.first(1)), fmt::format("--pdf \"{}\"", stated_.densities[0].text));
    else if (any_of_kind(methods_, MethodKind::mis))
      report_missed(missed_by(problem, all), all.size() == 1 ? "the density" : "every density");
  }

  void report_missed(const MissedIntegral& missed, const std::string& what) {
    if (missed.value == 0 && missed.standard_error == 0) return;
    const std::string message =
        fmt::format("{} is 0 where the integrand is not: the estimate misses {} of the integral", what,
                    value_with_error(missed.value, missed.standard_error));
    if (statement_.allow_missed)
      reading_.notes.push_back(message);
    else
      complain(message + " (--allow-missed accepts that bias)");
  }

  void check_methods() {
    for (MethodKind kind : {MethodKind::importance, MethodKind::mis})
      if (any_of_kind(methods_, kind) && statement_.densities.empty())
        complain(fmt::format("the method {} needs a density: --pdf '...'", name_of(kind)));
    if (any_of_kind(methods_, MethodKind::control) && !statement_.control)
      complain("the method control needs --control EXPR and --control-integral VALUE");
  }

  const IntegralStatement& statement_;
  const std::vector<Method>& methods_;
  std::shared_ptr<const Domain> domain_;
  StatedProblem stated_;
  StatementReading reading_;
};

}  // namespace

StatementReading read_statement(const IntegralStatement& statement, const std::vector<Method>& methods) {
  return Reader(statement, methods).read();
}

}  // namespace montelux::lab
