#include "lab/expression/program.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

namespace montelux::lab {
namespace {

// The number of points at a time: a dozen slots fit the first-level cache.
constexpr std::size_t block = 256;

// An operand for one block: an array, or the same number everywhere.
struct View {
  const double* array = nullptr;
  double number = 0;
};

template <class F>
void apply(F f, View a, View b, std::size_t n, double* out) {
  if (a.array && b.array)
    for (std::size_t i = 0; i < n; ++i) out[i] = f(a.array[i], b.array[i]);
  else if (a.array)
    for (std::size_t i = 0; i < n; ++i) out[i] = f(a.array[i], b.number);
  else if (b.array)
    for (std::size_t i = 0; i < n; ++i) out[i] = f(a.number, b.array[i]);
  else
    std::fill_n(out, n, f(a.number, b.number));
}

double whole_power(double x, int n) {
  double result = 1;
  for (int k = std::abs(n); k > 0; k >>= 1, x *= x)
    if (k & 1) result *= x;
  return n < 0 ? 1 / result : result;
}

// Small integer exponents, which are frequent, by multiplication.
void power(View a, View b, std::size_t n, double* out) {
  const bool whole = !b.array && std::abs(b.number) <= 32 && b.number == std::floor(b.number);
  if (whole && b.number == 2)
    apply([](double x, double) { return x * x; }, a, b, n, out);
  else if (whole && b.number == 3)
    apply([](double x, double) { return x * x * x; }, a, b, n, out);
  else if (whole)
    apply([](double x, double y) { return whole_power(x, int(y)); }, a, b, n, out);
  else if (!b.array && b.number == 0.5)
    apply([](double x, double) { return std::sqrt(x); }, a, b, n, out);
  else
    apply([](double x, double y) { return std::pow(x, y); }, a, b, n, out);
}

void choose(View which, View yes, View no, std::size_t n, double* out) {
  for (std::size_t i = 0; i < n; ++i) {
    const bool first = (which.array ? which.array[i] : which.number) != 0;
    const View& v = first ? yes : no;
    out[i] = v.array ? v.array[i] : v.number;
  }
}

void operate(Operation operation, View a, View b, std::size_t n, double* out) {
  switch (operation) {
    case Operation::add:
      return apply([](double x, double y) { return x + y; }, a, b, n, out);
    case Operation::subtract:
      return apply([](double x, double y) { return x - y; }, a, b, n, out);
    case Operation::multiply:
      return apply([](double x, double y) { return x * y; }, a, b, n, out);
    case Operation::divide:
      return apply([](double x, double y) { return x / y; }, a, b, n, out);
    case Operation::power:
      return power(a, b, n, out);
    case Operation::less:
      return apply([](double x, double y) { return x < y ? 1.0 : 0.0; }, a, b, n, out);
    case Operation::greater:
      return apply([](double x, double y) { return x > y ? 1.0 : 0.0; }, a, b, n, out);
    case Operation::less_equal:
      return apply([](double x, double y) { return x <= y ? 1.0 : 0.0; }, a, b, n, out);
    case Operation::greater_equal:
      return apply([](double x, double y) { return x >= y ? 1.0 : 0.0; }, a, b, n, out);
    case Operation::equal:
      return apply([](double x, double y) { return x == y ? 1.0 : 0.0; }, a, b, n, out);
    case Operation::not_equal:
      return apply([](double x, double y) { return x != y ? 1.0 : 0.0; }, a, b, n, out);
    case Operation::both:
      return apply([](double x, double y) { return x != 0 && y != 0 ? 1.0 : 0.0; }, a, b, n, out);
    case Operation::either:
      return apply([](double x, double y) { return x != 0 || y != 0 ? 1.0 : 0.0; }, a, b, n, out);
    case Operation::negate:
      return apply([](double x, double) { return -x; }, a, View{}, n, out);
    case Operation::negation:
      return apply([](double x, double) { return x == 0 ? 1.0 : 0.0; }, a, View{}, n, out);
    case Operation::choose:
    case Operation::call:
      return;
  }
}

}  // namespace

void Program::run(std::span<const double* const> columns, std::span<double> values) const {
  // One slot for each pending instruction, and one for each constant argument of a function.
  std::size_t max_operands = 0;
  for (const Instruction& i : instructions) max_operands = std::max(max_operands, i.operands.size());
  const auto memory = std::make_unique_for_overwrite<double[]>((slots + max_operands) * block);
  std::vector<const double*> arguments;
  for (std::size_t begin = 0; begin < values.size(); begin += block) {
    const std::size_t n = std::min(block, values.size() - begin);
    const auto view = [&](const Operand& o) -> View {
      if (o.kind == Operand::Kind::constant) return {nullptr, o.value};
      return {o.kind == Operand::Kind::column ? columns[o.index] + begin : memory.get() + o.index * block, 0};
    };
    for (const Instruction& i : instructions) {
      double* out = memory.get() + i.target * block;
      if (i.operation == Operation::call) {
        arguments.clear();
        for (const Operand& o : i.operands) {
          View v = view(o);
          if (!v.array) {
            double* filled = memory.get() + (slots + arguments.size()) * block;
            std::fill_n(filled, n, v.number);
            v.array = filled;
          }
          arguments.push_back(v.array);
        }
        i.function->batch(arguments, n, out);
      } else if (i.operation == Operation::choose) {
        choose(view(i.operands[0]), view(i.operands[1]), view(i.operands[2]), n, out);
      } else {
        operate(i.operation, view(i.operands[0]), i.operands.size() > 1 ? view(i.operands[1]) : View{}, n, out);
      }
    }
    const View last = view(result);
    if (last.array)
      std::copy_n(last.array, n, values.data() + begin);
    else
      std::fill_n(values.data() + begin, n, last.number);
  }
}

}  // namespace montelux::lab
