// The grammar is muparser's; its byte code is translated here to straight-line code over columns. So the library
// is not needed to evaluate an expression, and threads share no state.
#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>

#include "lab/expression/scan.h"

namespace montelux::lab {
namespace {

// The code of the library's token; its versions spell the name differently.
template <class Function>
auto raw_function(const Function& f) {
  if constexpr (requires { f.cb._pRawFun; })
    return reinterpret_cast<void*>(f.cb._pRawFun);
  else
    return reinterpret_cast<void*>(f.ptr);
}

double negative(double x) { return -x; }
double positive(double x) { return x; }
double is_zero(double x) { return x == 0 ? 1.0 : 0.0; }

// The parser with our names instead of its own, whose pi has 13 digits.
void prepare(mu::Parser& parser, const std::vector<std::string>& variables, std::vector<double>& values) {
  parser.ClearFun();
  parser.ClearConst();
  parser.ClearInfixOprt();
  parser.DefineInfixOprt("-", negative);
  parser.DefineInfixOprt("+", positive);
  parser.DefineInfixOprt("!", is_zero);
  for (const NamedConstant& c : expression_constants()) parser.DefineConst(std::string(c.name), c.value);
  for (const NamedFunction& f : expression_functions()) {
    const std::string name(f.name);
    if (f.one) parser.DefineFun(name, f.one);
    if (f.two) parser.DefineFun(name, f.two);
    if (f.three) parser.DefineFun(name, f.three);
    if (f.any) parser.DefineFun(name, f.any);
  }
  for (std::size_t i = 0; i < variables.size(); ++i) parser.DefineVar(variables[i], &values[i]);
}

const NamedFunction* function_of(void* code) {
  for (const NamedFunction& f : expression_functions())
    for (void* candidate : {reinterpret_cast<void*>(f.one), reinterpret_cast<void*>(f.two),
                            reinterpret_cast<void*>(f.three), reinterpret_cast<void*>(f.any)})
      if (candidate && candidate == code) return &f;
  return nullptr;
}

struct NotTranslated {};

// Translates reverse Polish notation to instructions. The slot of a pending operand is its height on the stack.
class Translator {
 public:
  explicit Translator(const std::vector<double>& values) : values_(values) {}

  Program translate(const mu::ParserByteCode& code) {
    const mu::SToken* tokens = code.GetBase();
    for (std::size_t i = 0; i < code.GetSize() && tokens[i].Cmd != mu::cmEND; ++i) take(tokens[i]);
    if (stack_.size() != 1) throw NotTranslated{};
    program_.result = stack_.front();
    return std::move(program_);
  }

 private:
  void take(const mu::SToken& t) {
    switch (t.Cmd) {
      case mu::cmVAR:
        return push(column(t.Val.ptr));
      case mu::cmVAL:
        return push({Operand::Kind::constant, 0, t.Val.data2});
      case mu::cmVARPOW2:
        return power(t, 2);
      case mu::cmVARPOW3:
        return power(t, 3);
      case mu::cmVARPOW4:
        return power(t, 4);
      case mu::cmVARMUL:  // variable * data + data2
        push(column(t.Val.ptr));
        push({Operand::Kind::constant, 0, t.Val.data});
        emit(Operation::multiply, 2);
        if (t.Val.data2 == 0) return;
        push({Operand::Kind::constant, 0, t.Val.data2});
        return emit(Operation::add, 2);
      case mu::cmIF:
      case mu::cmELSE:
        return;
      case mu::cmENDIF:
        return emit(Operation::choose, 3);
      case mu::cmFUNC:
        return call(raw_function(t.Fun), std::size_t(std::abs(t.Fun.argc)));
      default:
        return binary(t.Cmd);
    }
  }

  void binary(mu::ECmdCode code) {
    static constexpr std::pair<mu::ECmdCode, Operation> operations[] = {
        {mu::cmADD, Operation::add},    {mu::cmSUB, Operation::subtract},  {mu::cmMUL, Operation::multiply},
        {mu::cmDIV, Operation::divide}, {mu::cmPOW, Operation::power},     {mu::cmLT, Operation::less},
        {mu::cmGT, Operation::greater}, {mu::cmLE, Operation::less_equal}, {mu::cmGE, Operation::greater_equal},
        {mu::cmEQ, Operation::equal},   {mu::cmNEQ, Operation::not_equal}, {mu::cmLAND, Operation::both},
        {mu::cmLOR, Operation::either}};
    for (auto [from, to] : operations)
      if (from == code) return emit(to, 2);
    throw NotTranslated{};
  }

  void power(const mu::SToken& t, double exponent) {
    push(column(t.Val.ptr));
    push({Operand::Kind::constant, 0, exponent});
    emit(Operation::power, 2);
  }

  void call(void* code, std::size_t arguments) {
    if (code == reinterpret_cast<void*>(&positive)) return;
    if (code == reinterpret_cast<void*>(&negative)) return emit(Operation::negate, 1);
    if (code == reinterpret_cast<void*>(&is_zero)) return emit(Operation::negation, 1);
    const NamedFunction* function = function_of(code);
    if (!function) throw NotTranslated{};
    emit(Operation::call, arguments, function);
  }

  Operand column(const double* variable) const {
    return {Operand::Kind::column, std::size_t(variable - values_.data()), 0};
  }
  void push(Operand o) { stack_.push_back(o); }
  void emit(Operation operation, std::size_t operands, const NamedFunction* function = nullptr) {
    if (stack_.size() < operands) throw NotTranslated{};
    const std::size_t target = stack_.size() - operands;
    const auto first = stack_.begin() + std::ptrdiff_t(target);
    program_.instructions.push_back({operation, target, {first, stack_.end()}, function});
    program_.slots = std::max(program_.slots, target + 1);
    stack_.resize(target);
    push({Operand::Kind::slot, target, 0});
  }

  const std::vector<double>& values_;
  Program program_;
  std::vector<Operand> stack_;
};

std::string arguments_text(std::string_view name) {
  const NamedFunction* f = find_function(name);
  if (!f) return fmt::format("{} has the wrong number of arguments", name);
  if (f->arguments == 0) return fmt::format("{} takes at least one argument", name);
  return fmt::format("{} takes {} argument{}", name, f->arguments, f->arguments == 1 ? "" : "s");
}

// The library's error message in our wording.
TextMistake mistake_of(const mu::ParserError& error, std::string_view text) {
  const std::size_t position = error.GetPos() < 0 ? 0 : std::min(std::size_t(error.GetPos()), text.size());
  const std::string& token = error.GetToken();
  const auto at = [&](std::string message) {
    return TextMistake{position, std::max<std::size_t>(1, token.size()), std::move(message)};
  };
  switch (error.GetCode()) {
    case mu::ecUNEXPECTED_EOF:
      return {text.size(), 1, "the expression ends too early"};
    case mu::ecUNEXPECTED_OPERATOR:
      return at(fmt::format("\"{}\" has no left operand", token));
    case mu::ecTOO_MANY_PARAMS:
    case mu::ecTOO_FEW_PARAMS:
      return {position, 1, arguments_text(token)};
    case mu::ecMISSING_ELSE_CLAUSE:
      return {text.find('?') == std::string_view::npos ? 0 : text.find('?'), 1,
              "the other value is missing: condition ? value : other value"};
    case mu::ecMISPLACED_COLON:
      return at("a colon is only valid in condition ? value : other value");
    case mu::ecEXPRESSION_TOO_LONG:
      return {0, 1, "the expression is too long"};
    default:
      return at(token.empty() ? "this is not a valid expression" : fmt::format("\"{}\" is not expected here", token));
  }
}

}  // namespace

CompiledExpression compile(std::string_view text, const std::vector<std::string>& variables) {
  CompiledExpression result;
  result.mistakes = scan_mistakes(text, variables);
  if (!result.mistakes.empty()) return result;
  std::vector<double> values(variables.size(), 0.5);
  try {
    mu::Parser parser;
    prepare(parser, variables, values);
    parser.SetExpr(std::string(text));
    // The byte code is created by the first evaluation.
    int results = 0;
    parser.Eval(results);
    if (results != 1) {
      const std::size_t comma = text.rfind(',');
      result.mistakes.push_back({comma, 1, "one value is expected; commas are only valid between arguments"});
      return result;
    }
    result.expression = Expression(std::string(text), Translator(values).translate(parser.GetByteCode()));
  } catch (const mu::ParserError& error) {
    result.mistakes.push_back(mistake_of(error, text));
  } catch (const NotTranslated&) {
    result.mistakes.push_back({0, text.size(), "this is not a valid expression"});
  }
  return result;
}

}  // namespace montelux::lab
