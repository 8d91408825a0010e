#include "workbench/reproduce/thesis_scenarios.h"

#include <cassert>
#include <cmath>
#include <string>

#include "config/schema/document.h"
#include "workbench/simulate/closed_loop.h"

namespace workbench::reproduce {

Scenario shipped(std::string_view model) {
  const std::string name = std::string(model) + ".toml";
  return simulate::read_scenario(config::schema::Document::parse(shipped_model_text(name), name));
}

Scenario calibrated() { return shipped("thesis_calibrated"); }

Scenario with(Scenario scenario, std::string_view parameter, double value) {
  double* target = scenario.model.value(parameter);
  assert(target != nullptr);
  *target = value;
  return scenario;
}

Scenario with_fault(Scenario scenario, std::string_view parameter, double value, double at_s,
                    double ramp_s) {
  plant_sim::Change change;
  change.parameter = parameter;
  change.at_s = at_s;
  change.value = value;
  change.ramp_s = ramp_s;
  scenario.faults.push_back(change);
  return scenario;
}

Scenario with_real_instruments(Scenario scenario) {
  scenario.instruments = {5e-6, 2e-6, 12, 10.0};
  return scenario;
}

ScenarioRecord run(const Scenario& scenario, double duration_s, std::uint64_t seed) {
  simulate::ClosedLoop loop(scenario, seed);
  const auto samples = static_cast<std::size_t>(std::llround(duration_s / simulate::kSampleTime_s));
  ScenarioRecord record;
  record.u_V.reserve(samples);
  record.y_m.reserve(samples);
  for (std::size_t k = 0; k < samples; ++k) {
    const simulate::LoopRow row = loop.step();
    record.u_V.push_back(row.u_applied_V);
    record.y_m.push_back(row.y_m - kOffset_m);
  }
  return record;
}

}  // namespace workbench::reproduce
