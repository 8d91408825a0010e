#include "workbench/simulate/scenario.h"

#include <utility>

#include "config/schema/document.h"

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

void Instruments::visit(config::schema::Visitor& v) {
  v.number({"encoder_resolution_m", "one step of the position encoder; 0: none"},
           encoder_resolution_m, {0.0, 1.0});
  v.number({"noise_m", "standard deviation of the position noise"}, noise_m, {0.0, 1.0});
  v.integer({"dac_bits", "resolution of the D/A converter; 0: no steps"}, dac_bits, {0, 32});
  v.number({"dac_range_V", "the D/A converter gives -range to +range"}, dac_range_V,
           {1e-3, 1000.0});
  v.number({"pressure_noise_Pa", "standard deviation of each pressure's noise"}, pressure_noise_Pa,
           {0.0, 1e9});
}

void Scenario::visit(config::schema::Visitor& v) {
  model.visit(v);
  v.table({"reference", "the motion asked for"},
          [&](config::schema::Visitor& t) { reference.visit(t); });
  v.table({"instruments", "encoder, noise and D/A converter"},
          [&](config::schema::Visitor& t) { instruments.visit(t); });
  visit_list(v, {"fault", "changes of parameters at scheduled times"}, faults);
  visit_list(v, {"sensor_fault", "faults of the position sensor"}, sensor_faults);
}

Scenario read_scenario(const config::schema::Document& document) {
  Scenario scenario;
  document.read([&](config::schema::Visitor& v) { scenario.visit(v); });
  // The checks between a model's values are where models are read.
  scenario.model = plant_sim::read_model(
      config::schema::Document::parse(plant_sim::print_model(scenario.model), document.name()));
  scenario.folder = document.folder();
  return scenario;
}

}  // namespace workbench::simulate
