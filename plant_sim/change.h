// A change of one of a plant's parameters in time: a fault of a simulated rig, or what a record
// shows to have happened to a real one.
//
//   step         the new value from at_s on
//   ramp         linear from at_s over ramp_s
//   exponential  towards the new value from at_s on, as in warming up
#pragma once

#include <limits>
#include <string>

namespace config::schema {
class Visitor;
}

namespace plant_sim {

/// One change. Exactly one of value and factor is given (the other is NaN).
struct Change {
  std::string parameter;  ///< "supply_pressure_Pa" or "friction.coulomb_N"
  double at_s = 0.0;      ///< when it starts
  double value = std::numeric_limits<double>::quiet_NaN();  ///< in the parameter's own unit
  double factor =
      std::numeric_limits<double>::quiet_NaN();  ///< factor on the value at construction
  double ramp_s = 0.0;                           ///< 0 = a step
  double time_constant_s = 0.0;                  ///< the exponential's; 0 = no exponential

  void visit(config::schema::Visitor& v);
};

struct ParameterInfo;

/// The value that a change of a parameter leads to, from the one `before` it. Throws
/// config::schema::ConfigError unless one of value and factor is given, the new value is in the
/// parameter's range, a factor finds a number other than 0, and the change is a ramp or an
/// exponential, not both; `where` is the place in a file.
[[nodiscard]] double target_of(const Change& change, const ParameterInfo& info, double before,
                               const std::string& where);

}  // namespace plant_sim
