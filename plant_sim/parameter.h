// Description of each parameter of a plant or an effect: the one list from which model files
// are read, changes are checked and the library is printed.
#pragma once

#include <string>

namespace plant_sim {

/// All numbers in the unit of the name's suffix.
struct ParameterInfo {
  const char* name;
  const char* what;
  double min;      ///< smallest allowed value
  double max;      ///< largest allowed value
  double typical;  ///< typical size: where searches start
  double neutral;  ///< value without effect (effects), or the default (plants)
  /// Plants: relative standard deviation between rig and model file; 0 = taken as known, because
  /// the record cannot separate it from the others or because it is easily measured.
  double uncertainty_ratio = 0.0;
  /// Effects: 0 = main parameters; above 0, the number of a refinement, whose parameters are added
  /// and removed together.
  int refinement = 0;
  /// Effects: number of the refinement whose place this one takes; 0 stands beside all.
  int instead_of = 0;
  /// Effects: 2 where the simulation begins to change with the square of the value: a fit then
  /// moves the square.
  int order = 1;
};

/// A named value of a model file.
struct NamedValue {
  std::string name;
  double value;
};

}  // namespace plant_sim
