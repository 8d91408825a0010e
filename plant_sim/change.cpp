#include "plant_sim/change.h"

#include <fmt/format.h>

#include <cmath>

#include "config/schema/error.h"
#include "config/schema/visitor.h"
#include "plant_sim/parameter.h"

namespace plant_sim {
namespace {

/// Beyond seconds since 1970.
constexpr double kLargestTime_s = 1e10;

}  // namespace

void Change::visit(config::schema::Visitor& v) {
  v.text({"parameter", "a parameter of the model, as effect.name for an effect's", true},
         parameter);
  v.number({"at_s", "start time", true}, at_s, {-kLargestTime_s, kLargestTime_s});
  v.number({"value", "the new value"}, value);
  v.number({"factor", "the new value as a factor of the old"}, factor);
  v.number({"ramp_s", "time it takes; 0 is a step"}, ramp_s, {0.0, 1e9});
  v.number({"time_constant_s", "time constant of an exponential change; 0 is none"},
           time_constant_s, {0.0, 1e9});
}

double target_of(const Change& change, const ParameterInfo& info, double before,
                 const std::string& where) {
  using config::schema::bad_config;
  if (std::isnan(change.value) == std::isnan(change.factor)) {
    throw bad_config(where, "needs one of value and factor", "value or factor");
  }
  if (!std::isnan(change.factor) && (before == 0.0 || !std::isfinite(before))) {
    throw bad_config(
        where,
        std::string("has a factor, and the parameter is ") + (before == 0.0 ? "0" : "infinite"),
        "value");
  }
  if (change.ramp_s > 0.0 && change.time_constant_s > 0.0) {
    throw bad_config(where, "has both ramp_s and time_constant_s", "one of them");
  }
  const double to = std::isnan(change.value) ? change.factor * before : change.value;
  if (!(to >= info.min && to <= info.max)) {
    throw bad_config(where, fmt::format("to {:g} is out of range", to),
                     fmt::format("{:g} to {:g}", info.min, info.max));
  }
  return to;
}

}  // namespace plant_sim
