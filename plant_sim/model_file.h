// A model file: which plant, its parameters and initial state, which effects are added to it, and
// the gain of the loop that it is meant to be run in. TOML:
//
//   schema_version = 1
//   name = "thesis"
//   plant = "hydraulic_actuator"
//   step_s = 0.001
//   motion = "rotary"     # y is an angle (rad), a force a torque (N m), a mass an inertia (kg m2)
//   [parameters]          # every parameter of the plant that differs from its default
//   mass_kg = 50.0
//   [priors]              # relative standard deviation of a value; 0 holds it in every fit
//   mass_kg = 0.02
//   [initial]
//   y_m = 0.305
//   [effects.friction]    # presence adds the effect; absent parameters are neutral
//   coulomb_N = 100.0
//   [formula_effects.NAME]  # a user's own effect (formula/formula_effect.h), then one like others
//   [curve_effects.NAME]    # the same as a table, present with its values (formula/curve_effect.h)
//   [[change]]           # a parameter changes within a record: change.h
//   [loop]
//   kp_V_per_m = 100.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "plant_sim/change.h"
#include "plant_sim/formula/formula.h"
#include "plant_sim/parameter.h"

namespace config::schema {
class Document;
class Visitor;
}  // namespace config::schema

namespace plant_sim {

struct ModelFile {
  /// An effect and its parameter values.
  struct Effect {
    std::string name;
    bool present = false;
    std::vector<NamedValue> parameters;
  };
  struct Loop {
    double kp_V_per_m = 100.0;
  };

  std::string name;
  std::string plant = "hydraulic_actuator";
  double step_s = 0.001;
  std::string motion;                  ///< "linear", "rotary", or empty: linear
  std::vector<NamedValue> parameters;  ///< all parameters of the plant, defaults filled in
  std::vector<NamedValue> priors;      ///< in the order of `parameters`; NaN = the plant's own
  std::vector<NamedValue> initial;     ///< NaN = the plant's own choice (pressures at rest)
  std::vector<formula::FormulaEffect> formula_effects;  ///< as declared, then the curves
  std::vector<Effect> effects;  ///< the library's, then the formulas; present or not
  /// Changes of parameters during one record, in the record's time; at most one a parameter.
  std::vector<Change> changes;
  Loop loop;

  /// A model with the plant's defaults and no effect.
  ModelFile();
  void visit(config::schema::Visitor& v);

  /// Declares a user's own effect, absent, in place of one of the same name. Throws
  /// config::schema::ConfigError when it is not one that can be simulated; `file` is for the
  /// message.
  void declare(const formula::FormulaEffect& effect, const std::string& file);
  /// The formulas ready for simulation. Throws like declare() when one does not parse.
  [[nodiscard]] formula::Formulas formulas() const;

  /// True when y is an angle in rad: names keep their suffixes, `_m` stands for rad, `_N` for N m
  /// and `_kg` for kg m2.
  [[nodiscard]] bool rotary() const { return motion == "rotary"; }
  /// Relative standard deviation between rig and file of parameters[i]; 0 = taken as known.
  [[nodiscard]] double uncertainty_ratio(std::size_t i) const;

  /// The value named "mass_kg", "friction.coulomb_N", "initial.y_m" or "change.mass_kg.at_s"; null
  /// when unknown. Writing to an effect's parameter through this makes the effect present.
  double* value(std::string_view typed);

 private:
  void list_effects();
  std::vector<formula::FormulaEffect> take_curves();
  void visit_curves(config::schema::Visitor& v, std::vector<formula::FormulaEffect> curves);
};

/// The model as it is before any change.
[[nodiscard]] ModelFile without_changes(ModelFile model);

/// Throws config::schema::ConfigError for a model with a [[change]]: it describes one record, and
/// no rig that runs.
void require_constant(const ModelFile& model);

/// Throws config::schema::ConfigError for a missing file, an unknown key or a bad value.
[[nodiscard]] ModelFile load_model(const std::filesystem::path& file,
                                   const std::vector<std::string>& assignments = {});
/// The same from a document.
[[nodiscard]] ModelFile read_model(const config::schema::Document& document);
/// The model with NaN for every value that its file leaves to a default.
[[nodiscard]] ModelFile stated_values(const ModelFile& model,
                                      const config::schema::Document& document);
/// TOML text that load_model() reads back to the same values.
[[nodiscard]] std::string print_model(const ModelFile& model);

}  // namespace plant_sim
