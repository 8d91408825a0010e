#include "plant_sim/formula/recorder.h"

#include <muParser.h>
#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <deque>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"

namespace plant_sim::formula {

// Expression graph of one formula during parsing: each operation is a node with its operands. Equal
// operations share a node, constant operations are folded, small integer powers become products.

class ExpressionGraph {
 public:
  /// Node handle, encoded as a negative double, because muParser passes only numbers. A
  /// non-negative number is a constant of the text.
  using Handle = double;
  static constexpr std::size_t kMostNodes = 1000;

  explicit ExpressionGraph(std::size_t parameters) : parameters_(parameters) {
    nodes_.resize(ExpressionProgram::kVariables + parameters);
  }

  [[nodiscard]] static Handle input(std::size_t index) { return handle(index); }
  Handle constant(double value);
  Handle operation(Op op, Handle a, Handle b, Handle c);
  [[nodiscard]] bool too_long() const { return nodes_.size() > kMostNodes; }

  [[nodiscard]] ExpressionProgram program(Handle result);

 private:
  enum class Kind { input, constant, operation };
  struct Node {
    Kind kind = Kind::input;
    double value = 0.0;
    Op op = Op::add;
    std::size_t a = 0, b = 0, c = 0;
  };

  static Handle handle(std::size_t node) { return -1.0 - static_cast<double>(node); }
  std::size_t node_of(Handle handle);
  std::size_t add(const Node& node);
  std::size_t power(std::size_t base, std::size_t exponent);
  std::size_t product(std::size_t base, int exponent);
  std::size_t record(Op op, std::size_t a, std::size_t b, std::size_t c);
  [[nodiscard]] bool fixed(std::size_t node) const { return nodes_[node].kind == Kind::constant; }

  std::size_t parameters_;
  std::vector<Node> nodes_;  ///< variables and parameters first; operands before their results
};

namespace {

constexpr double kMostProducts = 8.0;  // larger powers are left to pow()

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

std::size_t operands(Op op) {
  switch (op) {
    case Op::choose:
      return 3;
    case Op::negate:
      return 1;
    case Op::atan2:
    case Op::min:
    case Op::max:
      return 2;
    default:
      return op >= Op::abs ? 1 : 2;
  }
}

}  // namespace

std::size_t ExpressionGraph::node_of(Handle handle) {
  if (handle < 0.0) return static_cast<std::size_t>(-1.0 - handle);
  return add({Kind::constant, handle, Op::add, 0, 0, 0});
}

std::size_t ExpressionGraph::add(const Node& node) {
  for (std::size_t i = ExpressionProgram::kVariables + parameters_; i < nodes_.size(); ++i) {
    const Node& n = nodes_[i];
    const bool same = n.kind == Kind::constant
                          ? same_bits(n.value, node.value)
                          : n.op == node.op && n.a == node.a && n.b == node.b && n.c == node.c;
    if (n.kind == node.kind && same) return i;
  }
  nodes_.push_back(node);
  return nodes_.size() - 1;
}

ExpressionGraph::Handle ExpressionGraph::constant(double value) {
  return handle(add({Kind::constant, value, Op::add, 0, 0, 0}));
}

std::size_t ExpressionGraph::record(Op op, std::size_t a, std::size_t b, std::size_t c) {
  const std::size_t count = operands(op);
  if (count < 2) b = 0;
  if (count < 3) c = 0;
  if (fixed(a) && (count < 2 || fixed(b)) && (count < 3 || fixed(c))) {
    const double value = apply(op, nodes_[a].value, nodes_[b].value, nodes_[c].value);
    return add({Kind::constant, value, Op::add, 0, 0, 0});
  }
  if (op == Op::power && fixed(b)) return power(a, b);
  return add({Kind::operation, 0.0, op, a, b, c});
}

std::size_t ExpressionGraph::power(std::size_t base, std::size_t exponent) {
  const double n = nodes_[exponent].value;
  if (n == 0.5) return record(Op::sqrt, base, 0, 0);
  if (n != std::floor(n) || std::abs(n) > kMostProducts || n == 0.0) {
    return add({Kind::operation, 0.0, Op::power, base, exponent, 0});
  }
  const std::size_t whole = product(base, static_cast<int>(std::abs(n)));
  if (n > 0.0) return whole;
  return record(Op::divide, add({Kind::constant, 1.0, Op::add, 0, 0, 0}), whole, 0);
}

std::size_t ExpressionGraph::product(std::size_t base, int exponent) {
  if (exponent == 1) return base;
  const std::size_t half = product(base, exponent / 2);
  const std::size_t even = record(Op::multiply, half, half, 0);
  return exponent % 2 == 0 ? even : record(Op::multiply, even, base, 0);
}

ExpressionGraph::Handle ExpressionGraph::operation(Op op, Handle a, Handle b, Handle c) {
  const std::size_t first = node_of(a);
  const std::size_t second = node_of(b);
  const std::size_t third = node_of(c);
  return handle(record(op, first, second, third));
}

ExpressionProgram ExpressionGraph::program(Handle result) {
  const std::size_t end = node_of(result);
  std::vector<bool> needed(nodes_.size());
  std::vector<bool> moves(nodes_.size());
  needed[end] = true;
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    const Node& n = nodes_[i];
    if (!needed[i] || n.kind != Kind::operation) continue;
    const std::size_t count = operands(n.op);
    needed[n.a] = true;
    if (count > 1) needed[n.b] = true;
    if (count > 2) needed[n.c] = true;
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& n = nodes_[i];
    const std::size_t count = operands(n.op);
    moves[i] = n.kind == Kind::operation
                   ? moves[n.a] || (count > 1 && moves[n.b]) || (count > 2 && moves[n.c])
                   : i < ExpressionProgram::kVariables;
  }

  ExpressionProgram program;
  program.parameters = parameters_;
  std::vector<std::uint16_t> place(nodes_.size());
  std::uint16_t next = 0;
  for (std::size_t i = 0; i < ExpressionProgram::kVariables + parameters_; ++i) {
    place[i] = next++;
    if (i >= ExpressionProgram::kVariables) program.uses.push_back(needed[i]);
  }
  const auto each_needed = [&](Kind kind, bool moving, auto&& f) {
    for (std::size_t i = ExpressionProgram::kVariables + parameters_; i < nodes_.size(); ++i) {
      if (!needed[i] || nodes_[i].kind != kind || moves[i] != moving) continue;
      f(nodes_[i]);
      place[i] = next++;
    }
  };
  each_needed(Kind::constant, false, [&](const Node& n) { program.constants.push_back(n.value); });
  each_needed(Kind::operation, false, [&](const Node& n) {
    program.steady.push_back({n.op, place[n.a], place[n.b], place[n.c]});
  });
  each_needed(Kind::operation, true, [&](const Node& n) {
    program.moving.push_back({n.op, place[n.a], place[n.b], place[n.c]});
  });
  program.result = place[end];
  return program;
}

ExpressionProgramView view_of(const ExpressionProgram& program) {
  const auto part =
      [](const std::vector<ExpressionProgram::Instruction>& all) -> ExpressionProgramView::Part {
    return {all.data(), all.data() + all.size()};
  };
  const std::size_t registers = ExpressionProgram::kVariables + program.parameters +
                                program.constants.size() + program.steady.size() +
                                program.moving.size();
  return {program.parameters,
          program.constants.data(),
          program.constants.size(),
          part(program.steady),
          part(program.moving),
          program.result,
          registers};
}

namespace {

using config::schema::bad_config;

/// muParser calls plain functions: this is where they record.
thread_local ExpressionGraph* graph = nullptr;

double recorded(Op op, double a, double b = -1.0, double c = -1.0) {
  if (graph->too_long()) throw mu::ParserError(mu::ecEXPRESSION_TOO_LONG);
  return graph->operation(op, a, b, c);
}
template <Op kOp>
double of_one(double a) {
  return recorded(kOp, a);
}
template <Op kOp>
double of_two(double a, double b) {
  return recorded(kOp, a, b);
}
template <Op kOp>
double of_three(double a, double b, double c) {
  return recorded(kOp, a, b, c);
}

struct Operator {
  const char* name;
  double (*record)(double, double);
  unsigned precedence;
};
constexpr Operator kOperators[] = {
    {"+", of_two<Op::add>, mu::prADD_SUB},      {"-", of_two<Op::subtract>, mu::prADD_SUB},
    {"*", of_two<Op::multiply>, mu::prMUL_DIV}, {"/", of_two<Op::divide>, mu::prMUL_DIV},
    {"<", of_two<Op::less>, mu::prCMP},         {"<=", of_two<Op::less_equal>, mu::prCMP},
    {">", of_two<Op::greater>, mu::prCMP},      {">=", of_two<Op::greater_equal>, mu::prCMP},
    {"==", of_two<Op::equal>, mu::prCMP},       {"!=", of_two<Op::unequal>, mu::prCMP},
    {"&&", of_two<Op::both>, mu::prLAND},       {"||", of_two<Op::either>, mu::prLOR},
};

struct Function {
  const char* name;
  double (*record)(double);
};
constexpr Function kFunctions[] = {
    {"abs", of_one<Op::abs>},     {"sign", of_one<Op::sign>}, {"sqrt", of_one<Op::sqrt>},
    {"exp", of_one<Op::exp>},     {"ln", of_one<Op::ln>},     {"log10", of_one<Op::log10>},
    {"sin", of_one<Op::sin>},     {"cos", of_one<Op::cos>},   {"tan", of_one<Op::tan>},
    {"asin", of_one<Op::asin>},   {"acos", of_one<Op::acos>}, {"atan", of_one<Op::atan>},
    {"sinh", of_one<Op::sinh>},   {"cosh", of_one<Op::cosh>}, {"tanh", of_one<Op::tanh>},
    {"floor", of_one<Op::floor>},
};
struct PairFunction {
  const char* name;
  double (*record)(double, double);
};
constexpr PairFunction kPairFunctions[] = {
    {"atan2", of_two<Op::atan2>}, {"min", of_two<Op::min>}, {"max", of_two<Op::max>}};
constexpr const char* kChoose = "if";
constexpr const char* kPi = "pi";

mu::Parser bare_parser() {
  mu::Parser parser;
  parser.EnableOptimizer(false);
  parser.EnableBuiltInOprt(false);
  parser.ClearConst();
  parser.ClearFun();
  parser.ClearInfixOprt();
  parser.ClearPostfixOprt();
  parser.ClearOprt();
  for (const Operator& o : kOperators) parser.DefineOprt(o.name, o.record, o.precedence);
  parser.DefineOprt("^", of_two<Op::power>, mu::prPOW, mu::oaRIGHT);
  parser.DefineInfixOprt("-", of_one<Op::negate>);
  for (const Function& f : kFunctions) parser.DefineFun(f.name, f.record);
  for (const PairFunction& f : kPairFunctions) parser.DefineFun(f.name, f.record);
  parser.DefineFun(kChoose, of_three<Op::choose>);
  return parser;
}

const char* reason(int code) {
  switch (code) {
    case mu::ecUNEXPECTED_EOF:
      return "unexpected end";
    case mu::ecUNEXPECTED_OPERATOR:
      return "an operator without a value before it";
    case mu::ecUNEXPECTED_ARG_SEP:
      return "a comma outside of a function";
    case mu::ecUNEXPECTED_VAL:
    case mu::ecUNEXPECTED_VAR:
    case mu::ecUNEXPECTED_FUN:
      return "an operator is missing before it";
    case mu::ecUNEXPECTED_PARENS:
      return "unexpected parenthesis";
    case mu::ecMISSING_PARENS:
      return "unclosed parenthesis";
    case mu::ecTOO_MANY_PARAMS:
      return "too many arguments";
    case mu::ecTOO_FEW_PARAMS:
      return "too few arguments";
    case mu::ecEXPRESSION_TOO_LONG:
      return "the expression is too long";
    default:
      return "not an expression";
  }
}

/// Error message for a muParser error; positions count from 1.
config::schema::ConfigError refusal(const mu::ParserError& error, std::size_t length,
                                    std::vector<std::string> names, const std::string& where) {
  std::string token = error.GetToken();
  token.erase(std::find_if(token.rbegin(), token.rend(),
                           [](unsigned char c) { return std::isspace(c) == 0; })
                  .base(),
              token.end());
  const std::string place =
      " at character " +
      std::to_string(std::min(static_cast<std::size_t>(error.GetPos()), length) + 1);
  const std::vector<std::string>& words = formula_words();
  if (error.GetCode() == mu::ecEMPTY_EXPRESSION) return bad_config(where, "is empty");
  if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN && !token.empty()) {
    if (std::find(words.begin(), words.end(), token) != words.end()) {
      return bad_config(where, token + place + " is a function and needs (", token + "(...)");
    }
    if (std::isalpha(static_cast<unsigned char>(token[0])) != 0 || token[0] == '_') {
      names.insert(names.end(), words.begin(), words.end());
      const std::string near = config::schema::nearest(token, names);
      return bad_config(
          where,
          "unknown name " + token + place + (near.empty() ? "" : ", did you mean " + near + "?"),
          config::schema::joined(names));
    }
    if (token[0] == '=') {
      return bad_config(where, "an assignment" + place, "one expression; == compares");
    }
  }
  return bad_config(where, "does not parse" + place +
                               (token.empty() ? "" : ", near \"" + token + "\"") + ": " +
                               reason(error.GetCode()));
}

}  // namespace

const std::vector<std::string>& formula_words() {
  static const std::vector<std::string> words = [] {
    std::vector<std::string> all = {kPi, kChoose};
    for (const Function& f : kFunctions) all.emplace_back(f.name);
    for (const PairFunction& f : kPairFunctions) all.emplace_back(f.name);
    return all;
  }();
  return words;
}

ExpressionProgram record_formula(const std::string& text, const std::vector<std::string>& variables,
                                 const std::vector<std::string>& parameters,
                                 const std::string& where) {
  const std::size_t quote = text.find_first_of("\"'");
  if (quote != std::string::npos) {
    throw bad_config(where, "a string at character " + std::to_string(quote + 1), "numbers");
  }
  // muParser's own would take one side for good while it records
  const std::size_t branch = text.find_first_of("?:");
  if (branch != std::string::npos) {
    throw bad_config(where,
                     "unknown operator " + text.substr(branch, 1) + " at character " +
                         std::to_string(branch + 1),
                     "if(condition, yes, no)");
  }
  std::vector<std::string> names = variables;
  names.insert(names.end(), parameters.begin(), parameters.end());
  ExpressionGraph here(parameters.size());
  struct Scope {
    explicit Scope(ExpressionGraph& to) { graph = &to; }
    ~Scope() { graph = nullptr; }
  } const scope(here);
  try {
    mu::Parser parser = bare_parser();
    std::deque<double> handles;  // muParser keeps their addresses
    const auto define = [&](const std::string& name, double handle) {
      handles.push_back(handle);
      parser.DefineVar(name, &handles.back());
    };
    for (std::size_t i = 0; i < variables.size(); ++i)
      define(variables[i], ExpressionGraph::input(i));
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      define(parameters[i], ExpressionGraph::input(ExpressionProgram::kVariables + i));
    }
    define(kPi, here.constant(3.141592653589793));
    parser.SetExpr(text);
    int count = 0;
    const double* results = parser.Eval(count);
    if (count != 1) throw bad_config(where, "has a comma outside of a function", "one expression");
    return here.program(results[0]);
  } catch (const mu::ParserError& error) {
    throw refusal(error, text.size(), names, where);
  }
}

}  // namespace plant_sim::formula
