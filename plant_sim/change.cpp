#include "plant_sim/change.h"

#include "config/schema/visitor.h"

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

}  // namespace plant_sim
