#include "lab/expression/table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace montelux::lab {
namespace {

using Arguments = std::span<const double* const>;

// A row of the table for a function of one point; it is inlined into the loop over many.
template <auto f>
constexpr NamedFunction unary(std::string_view name, std::string_view meaning) {
  NamedFunction row{name, 1, meaning};
  row.one = [](double x) { return f(x); };
  row.batch = [](Arguments a, std::size_t count, double* out) {
    const double* x = a[0];
    for (std::size_t i = 0; i < count; ++i) out[i] = f(x[i]);
  };
  return row;
}
template <auto f>
constexpr NamedFunction binary(std::string_view name, std::string_view meaning) {
  NamedFunction row{name, 2, meaning};
  row.two = [](double x, double y) { return f(x, y); };
  row.batch = [](Arguments a, std::size_t count, double* out) {
    const double *x = a[0], *y = a[1];
    for (std::size_t i = 0; i < count; ++i) out[i] = f(x[i], y[i]);
  };
  return row;
}
template <auto f>
constexpr NamedFunction ternary(std::string_view name, std::string_view meaning) {
  NamedFunction row{name, 3, meaning};
  row.three = [](double x, double y, double z) { return f(x, y, z); };
  row.batch = [](Arguments a, std::size_t count, double* out) {
    const double *x = a[0], *y = a[1], *z = a[2];
    for (std::size_t i = 0; i < count; ++i) out[i] = f(x[i], y[i], z[i]);
  };
  return row;
}
// A function with any number of arguments, from one that combines two. `mean` divides by their number.
template <auto f, bool mean = false>
constexpr NamedFunction folded(std::string_view name, std::string_view meaning) {
  NamedFunction row{name, 0, meaning};
  row.any = [](const double* x, int n) {
    double value = x[0];
    for (int k = 1; k < n; ++k) value = f(value, x[k]);
    return mean ? value / n : value;
  };
  row.batch = [](Arguments a, std::size_t count, double* out) {
    for (std::size_t i = 0; i < count; ++i) {
      double value = a[0][i];
      for (std::size_t k = 1; k < a.size(); ++k) value = f(value, a[k][i]);
      out[i] = mean ? value / double(a.size()) : value;
    }
  };
  return row;
}

constexpr double infinity = std::numeric_limits<double>::infinity();

// Not a number if an argument is not: a maximum must not hide it.
double larger(double a, double b) { return a > b || std::isnan(a) ? a : b; }
double smaller(double a, double b) { return a < b || std::isnan(a) ? a : b; }
double smoothstep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}
// lgamma of the C library writes a global sign; this one does not.
double log_gamma(double x) {
  int sign = 0;
  return lgamma_r(x, &sign);
}

constexpr std::array constants{
    NamedConstant{"pi", std::numbers::pi, "3.14159..."},
    NamedConstant{"e", std::numbers::e, "2.71828..."},
    NamedConstant{"tau", 2 * std::numbers::pi, "2 pi"},
    NamedConstant{"inf", infinity, "infinity, for bounds"},
};

constexpr std::array functions{
    unary<[](double x) { return std::sin(x); }>("sin", "sine of an angle in radians"),
    unary<[](double x) { return std::cos(x); }>("cos", "cosine"),
    unary<[](double x) { return std::tan(x); }>("tan", "tangent"),
    unary<[](double x) { return std::asin(x); }>("asin", "inverse of sin, in [-pi/2, pi/2]"),
    unary<[](double x) { return std::acos(x); }>("acos", "inverse of cos, in [0, pi]"),
    unary<[](double x) { return std::atan(x); }>("atan", "inverse of tan, in (-pi/2, pi/2)"),
    unary<[](double x) { return std::sinh(x); }>("sinh", "hyperbolic sine"),
    unary<[](double x) { return std::cosh(x); }>("cosh", "hyperbolic cosine"),
    unary<[](double x) { return std::tanh(x); }>("tanh", "hyperbolic tangent"),
    unary<[](double x) { return std::asinh(x); }>("asinh", "inverse of sinh"),
    unary<[](double x) { return std::acosh(x); }>("acosh", "inverse of cosh"),
    unary<[](double x) { return std::atanh(x); }>("atanh", "inverse of tanh"),
    unary<[](double x) { return std::exp(x); }>("exp", "e to the power x"),
    unary<[](double x) { return std::expm1(x); }>("expm1", "exp(x) - 1, exact near 0"),
    unary<[](double x) { return std::log(x); }>("log", "natural logarithm"),
    unary<[](double x) { return std::log(x); }>("ln", "natural logarithm"),
    unary<[](double x) { return std::log1p(x); }>("log1p", "log(1 + x), exact near 0"),
    unary<[](double x) { return std::log2(x); }>("log2", "logarithm to base 2"),
    unary<[](double x) { return std::log10(x); }>("log10", "logarithm to base 10"),
    unary<[](double x) { return std::sqrt(x); }>("sqrt", "square root"),
    unary<[](double x) { return std::cbrt(x); }>("cbrt", "cube root"),
    unary<[](double x) { return std::fabs(x); }>("abs", "absolute value"),
    unary<[](double x) { return double((x > 0) - (x < 0)); }>("sign", "-1, 0 or 1"),
    unary<[](double x) { return std::floor(x); }>("floor", "largest whole number not above x"),
    unary<[](double x) { return std::ceil(x); }>("ceil", "smallest whole number not below x"),
    unary<[](double x) { return std::round(x); }>("round", "nearest whole number"),
    unary<[](double x) { return std::trunc(x); }>("trunc", "x without its fraction"),
    unary<[](double x) { return x - std::floor(x); }>("frac", "x - floor(x)"),
    unary<[](double x) { return std::erf(x); }>("erf", "error function"),
    unary<[](double x) { return std::erfc(x); }>("erfc", "1 - erf(x)"),
    unary<[](double x) { return std::tgamma(x); }>("gamma", "gamma function"),
    unary<log_gamma>("lgamma", "logarithm of |gamma(x)|"),
    unary<[](double x) { return x < 0 ? 0.0 : 1.0; }>("heaviside", "0 below 0, else 1"),
    binary<[](double x, double y) { return std::pow(x, y); }>("pow", "pow(x, y): x to the power y"),
    binary<[](double y, double x) { return std::atan2(y, x); }>("atan2", "atan2(y, x): angle of the point (x, y)"),
    binary<[](double x, double y) { return std::hypot(x, y); }>("hypot", "hypot(x, y): sqrt(x^2 + y^2)"),
    binary<[](double x, double y) { return x - y * std::floor(x / y); }>("mod", "mod(x, y): x - y floor(x/y)"),
    binary<[](double edge, double x) { return x < edge ? 0.0 : 1.0; }>("step",
                                                                       "step(edge, x): 0 below the edge, else 1"),
    ternary<[](double x, double low, double high) { return smaller(larger(x, low), high); }>("clamp",
                                                                                             "clamp(x, low, high)"),
    ternary<[](double a, double b, double t) { return a + t * (b - a); }>("lerp", "lerp(a, b, t): a + t (b - a)"),
    ternary<smoothstep>("smoothstep", "smoothstep(low, high, x): from 0 to 1 by a cubic"),
    folded<smaller>("min", "smallest argument"),
    folded<larger>("max", "largest argument"),
    folded<[](double a, double b) { return a + b; }>("sum", "sum of the arguments"),
    folded<[](double a, double b) { return a + b; }, true>("avg", "mean of the arguments"),
};

}  // namespace

std::span<const NamedConstant> expression_constants() { return constants; }
std::span<const NamedFunction> expression_functions() { return functions; }

}  // namespace montelux::lab
