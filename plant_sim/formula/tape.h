// A formula as a list of operations, for double and for lanes alike: parsed once (recorder.h), run
// as often as the plant steps, without allocation and without a branch on a value.
//
// Every intermediate result has a register of its own. In order: variables, parameters, constants,
// what follows from parameters alone (found once per change), what moves with the variables.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "plant_sim/formula/operations.h"

namespace plant_sim {

struct Tape {
  /// Of every formula, used or not: no site has more.
  static constexpr std::size_t kVariables = 2;

  struct Instruction {
    Op op;
    std::uint16_t a, b, c;  ///< registers of the operands; those that op does not take are 0
  };

  std::size_t parameters = 0;
  std::vector<double> constants;
  std::vector<Instruction> steady;  ///< of parameters alone
  std::vector<Instruction> moving;
  std::size_t result = 0;
  std::vector<bool> uses;  ///< which parameters have a part in the result
};

/// A tape as plain pointers into it: code that is compiled once per instruction set shares no
/// function with the rest of the program (lane_ensemble.h).
struct TapeView {
  struct Part {
    const Tape::Instruction* first;
    const Tape::Instruction* last;
  };
  std::size_t parameters;
  const double* constants;
  std::size_t constant_count;
  Part steady, moving;
  std::size_t result;
  std::size_t registers;
};
[[nodiscard]] TapeView view_of(const Tape& tape);

/// The registers of one tape. The tape must outlive it.
template <class S>
class TapeRun {
 public:
  explicit TapeRun(const TapeView& tape) : tape_(tape), registers_(tape.registers) {
    S* into = registers_.data() + Tape::kVariables + tape_.parameters;
    for (std::size_t i = 0; i < tape_.constant_count; ++i) *into++ = S(tape_.constants[i]);
  }

  /// As many as the tape has parameters.
  void set_parameters(const S* values) {
    S* into = registers_.data() + Tape::kVariables;
    for (std::size_t i = 0; i < tape_.parameters; ++i) *into++ = values[i];
    run(tape_.steady, Tape::kVariables + tape_.parameters + tape_.constant_count);
  }

  /// The formula's value; may be infinite or no number.
  [[nodiscard]] S operator()(const S& first, const S& second) const {
    S* const at = registers_.data();
    at[0] = first;
    at[1] = second;
    const TapeView::Part& part = tape_.moving;
    run(part, tape_.registers - static_cast<std::size_t>(part.last - part.first));
    return at[tape_.result];
  }

 private:
  /// Kept out of the plant's equations, which are one function.
  [[gnu::noinline]] void run(const TapeView::Part& part, std::size_t into) const {
    S* const at = registers_.data();
    for (const Tape::Instruction* i = part.first; i != part.last; ++i) {
      at[into++] = apply(i->op, at[i->a], at[i->b], at[i->c]);
    }
  }

  TapeView tape_;
  mutable std::vector<S> registers_;
};

}  // namespace plant_sim
