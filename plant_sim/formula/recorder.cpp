#include "plant_sim/formula/recorder.h"

#include <muParser.h>
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <deque>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/spelling.h"
#include "plant_sim/formula/expression_graph.h"

namespace plant_sim::formula {
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
  std::erase(names, "");
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
    for (std::size_t i = 0; i < variables.size(); ++i) {
      if (!variables[i].empty()) define(variables[i], ExpressionGraph::input(i));
    }
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
