#include "workbench/simulate/sensor_fault.h"

#include <utility>

namespace workbench::simulate {
namespace {

/// Times that differ by rounding are the same.
constexpr double kSlack_s = 1e-9;

}  // namespace

void SensorFault::visit(config::schema::Visitor& v) {
  v.choice({"kind", "kind of fault", true}, kind, {"offset", "drift", "scale", "freeze"});
  v.number({"at_s", "start time", true}, at_s, {0.0, 1e9});
  if (kind != "freeze") v.number({"size", "m, m/s or a ratio", true}, size, {-10.0, 10.0});
}

FaultySensor::FaultySensor(std::vector<SensorFault> faults) {
  for (SensorFault& fault : faults) entries_.push_back({std::move(fault)});
}

double FaultySensor::signal_m(double t_s, double y_m) noexcept {
  for (Entry& entry : entries_) {
    const SensorFault& fault = entry.fault;
    if (t_s < fault.at_s - kSlack_s || fault.kind == "freeze") continue;
    if (!entry.started) entry.held_m = y_m;
    entry.started = true;
    if (fault.kind == "offset") y_m += fault.size;
    if (fault.kind == "drift") y_m += fault.size * (t_s - fault.at_s);
    if (fault.kind == "scale") y_m = entry.held_m + (1.0 + fault.size) * (y_m - entry.held_m);
  }
  return y_m;
}

double FaultySensor::reading_m(double t_s, double encoder_m) noexcept {
  for (Entry& entry : entries_) {
    if (entry.fault.kind != "freeze" || t_s < entry.fault.at_s - kSlack_s) continue;
    if (!entry.started) entry.held_m = last_m_;
    entry.started = true;
    encoder_m = entry.held_m;
  }
  last_m_ = encoder_m;
  return encoder_m;
}

}  // namespace workbench::simulate
