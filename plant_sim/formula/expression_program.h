// A formula as a list of operations, for double and for SIMD lanes: parsed once (recorder.h), run
// at every step of the plant without allocation and without a branch on a value.
//
// Every intermediate result has its own register. In order: variables, parameters, constants,
// results of parameters alone (evaluated once per change), results that depend on the variables.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "plant_sim/formula/operations.h"
#include "plant_sim/formula/signals.h"

namespace plant_sim::formula {

struct ExpressionProgram {
  /// Number of variables of every formula, used or not: its signals.
  static constexpr std::size_t kVariables = kSignals;

  struct Instruction {
    Op op;
    std::uint16_t a, b, c;  ///< registers of the operands; unused ones are 0
  };

  std::size_t parameters = 0;
  std::vector<double> constants;
  std::vector<Instruction> steady;  ///< depend on parameters alone
  std::vector<Instruction> moving;
  std::size_t result = 0;
  std::vector<bool> uses;            ///< parameters that the result depends on
  std::vector<std::uint16_t> reads;  ///< variables that it depends on
};

/// A program as plain pointers: code that is compiled once per instruction set shares no
/// function with the rest of the program (lane_ensemble.h).
struct ExpressionProgramView {
  struct Part {
    const ExpressionProgram::Instruction* first;
    const ExpressionProgram::Instruction* last;
  };
  std::size_t parameters;
  const double* constants;
  std::size_t constant_count;
  Part steady, moving;
  const std::uint16_t* reads;
  std::size_t read_count;
  std::size_t result;
  std::size_t registers;
};
[[nodiscard]] ExpressionProgramView view_of(const ExpressionProgram& program);

/// Evaluates a program; owns its registers. The program must outlive it.
template <class S>
class ExpressionEvaluator {
 public:
  explicit ExpressionEvaluator(const ExpressionProgramView& program)
      : program_(program), registers_(program.registers) {
    S* into = registers_.data() + ExpressionProgram::kVariables + program_.parameters;
    for (std::size_t i = 0; i < program_.constant_count; ++i) *into++ = S(program_.constants[i]);
  }

  /// `values`: one per parameter of the program.
  void set_parameters(const S* values) {
    S* into = registers_.data() + ExpressionProgram::kVariables;
    for (std::size_t i = 0; i < program_.parameters; ++i) *into++ = values[i];
    run(program_.steady,
        ExpressionProgram::kVariables + program_.parameters + program_.constant_count);
  }

  /// Value of the formula at kVariables `variables`; may be infinite or NaN.
  [[nodiscard]] S operator()(const S* variables) const {
    S* const at = registers_.data();
    for (std::size_t i = 0; i < program_.read_count; ++i) {
      at[program_.reads[i]] = variables[program_.reads[i]];
    }
    const ExpressionProgramView::Part& part = program_.moving;
    run(part, program_.registers - static_cast<std::size_t>(part.last - part.first));
    return at[program_.result];
  }

 private:
  /// Kept out of the plant's equations, which are one function.
  [[gnu::noinline]] void run(const ExpressionProgramView::Part& part, std::size_t into) const {
    S* const at = registers_.data();
    for (const ExpressionProgram::Instruction* i = part.first; i != part.last; ++i, ++into) {
      const S& a = at[i->a];
      const S& b = at[i->b];
      const S& c = at[i->c];
      switch (i->op) {  // the most frequent operations without a call
        case Op::multiply:
          at[into] = a * b;
          break;
        case Op::multiply_add:
          at[into] = a * b + c;
          break;
        case Op::add:
          at[into] = a + b;
          break;
        case Op::subtract:
          at[into] = a - b;
          break;
        case Op::limit:
          at[into] = max(min(a, b), c);
          break;
        default:
          at[into] = apply(i->op, a, b, c);
      }
    }
  }

  ExpressionProgramView program_;
  mutable std::vector<S> registers_;
};

}  // namespace plant_sim::formula
