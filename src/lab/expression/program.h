// A compiled expression: straight-line code over columns of numbers, a block of points at a time.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "lab/expression/table.h"

namespace montelux::lab {

enum class Operation : std::uint8_t {
  add,
  subtract,
  multiply,
  divide,
  power,
  less,
  greater,
  less_equal,
  greater_equal,
  equal,
  not_equal,
  both,
  either,
  negate,
  negation,  // 1 for 0, else 0
  choose,    // the first is not 0 ? second : third
  call
};

// The location of a number: a column of the input, a constant, or a slot written by an earlier instruction.
struct Operand {
  enum class Kind : std::uint8_t { column, constant, slot } kind = Kind::constant;
  std::size_t index = 0;
  double value = 0;
};

// Writes slot `target`. Binary operations and `choose` take 2 and 3 operands, calls one for each argument.
struct Instruction {
  Operation operation;
  std::size_t target = 0;
  std::vector<Operand> operands;
  const NamedFunction* function = nullptr;
};

struct Program {
  std::vector<Instruction> instructions;
  Operand result;
  std::size_t slots = 0;

  // Sets values[i] to the expression at columns[0][i], columns[1][i], ... A pure function.
  void run(std::span<const double* const> columns, std::span<double> values) const;
};

}  // namespace montelux::lab
