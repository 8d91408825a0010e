// A declared formula made ready to be simulated, and the checks that it must pass before.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plant_sim/formula/curve_evaluator.h"
#include "plant_sim/formula/expression_program.h"
#include "plant_sim/formula/formula_effect.h"
#include "plant_sim/parameter.h"

namespace plant_sim::formula {

/// Plausible range of a formula's variable, in its own unit.
struct VariableRange {
  double min = 0.0;
  double max = 0.0;
};

struct Formula {
  std::string name;
  FormulaSite place;
  ExpressionProgram program;
  ExpressionProgram memory;  ///< dz/dt, where it remembers
  bool remembers = false;
  std::optional<CurveTable> curve;  ///< evaluated in the place of `program`, which says the same
  std::vector<ParameterInfo> parameters;
  std::array<VariableRange, kSignals> ranges;  ///< one per signal; 0..0 where there is none
  /// Signals whose values the formula or its memory depends on.
  [[nodiscard]] std::vector<Signal> reads() const;
};

/// A formula as plain pointers, for simulation.
struct FormulaView {
  const char* name;
  FormulaSite place;
  const ParameterInfo* parameters;
  ExpressionProgramView program;
  ExpressionProgramView memory;
  bool remembers;
  CurveView curve;
  VariableRange ranges[kSignals];
};

/// The formulas of a model. Must outlive the simulation that uses them.
class Formulas {
 public:
  Formulas() = default;
  explicit Formulas(std::vector<Formula> formulas);
  [[nodiscard]] const FormulaView* data() const;
  [[nodiscard]] std::size_t size() const;

 private:
  std::shared_ptr<const std::vector<Formula>> formulas_;  // copies share it: views stay valid
  std::vector<FormulaView> views_;
};

/// Plausible ranges of a formula's variables, given by the plant.
struct PlausibleRanges {
  VariableRange command_V{-10.0, 10.0};
  VariableRange opening_m;
  VariableRange flow_m3ps;
  VariableRange pressure_Pa;
  VariableRange position_m;
  VariableRange speed_mps{-2.0, 2.0};
  VariableRange acceleration_mps2{-100.0, 100.0};
  bool has_opening = true;    ///< the plant has a spool
  bool has_pressures = true;  ///< the plant has chambers
};

/// Range in which the memory settles while the other signals are within theirs.
[[nodiscard]] VariableRange memory_range(const Formula& formula);

/// Checks the names and parses the formula. Throws config::schema::ConfigError; `where` is the
/// effect's table in a file.
[[nodiscard]] Formula compile(const FormulaEffect& effect, const PlausibleRanges& ranges,
                              const std::string& where);

/// Throws config::schema::ConfigError unless the ranges make sense, the formula has no
/// influence when its parameters are neutral, and is finite over the variables' ranges for any of
/// the parameters' least, largest and neutral values.
void check(const FormulaEffect& effect, const Formula& formula, const std::string& where);

[[nodiscard]] ParameterInfo info_of(const FormulaEffect::Parameter& parameter);

/// `text` where it stays for the life of the program.
[[nodiscard]] const char* interned(const std::string& text);

}  // namespace plant_sim::formula
