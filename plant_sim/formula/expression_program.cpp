#include "plant_sim/formula/expression_program.h"

namespace plant_sim::formula {

ExpressionProgramView view_of(const ExpressionProgram& program) {
  const auto part =
      [](const std::vector<ExpressionProgram::Instruction>& all) -> ExpressionProgramView::Part {
    return {all.data(), all.data() + all.size()};
  };
  const std::size_t registers = ExpressionProgram::kVariables + program.parameters +
                                program.constants.size() + program.steady.size() +
                                program.moving.size();
  return {program.parameters,   program.constants.data(), program.constants.size(),
          part(program.steady), part(program.moving),     program.reads.data(),
          program.reads.size(), program.result,           registers};
}

}  // namespace plant_sim::formula
