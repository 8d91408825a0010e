#include "workbench/simulate/closed_loop.h"

#include <cmath>
#include <string>

#include "config/schema/error.h"

namespace workbench::simulate {
namespace {

monitor::control::ValveLimits limits(const Instruments& instruments) {
  monitor::control::ValveLimits out;
  out.limit_V = instruments.dac_range_V;
  return out;
}

/// A plant moves by whole integration steps: any other step would make the periods longer or
/// shorter than the record says.
void check_step(double step_s) {
  constexpr double kWholeSteps = 1e-6;
  const double steps = kSampleTime_s / step_s;
  if (std::abs(steps - std::round(steps)) > kWholeSteps) {
    throw config::schema::bad_config(
        "step_s", "makes a period of " + std::to_string(steps) + " integration steps",
        "a whole number of steps in " + std::to_string(kSampleTime_s) + " s");
  }
}

std::vector<plant_sim::Change> faults_and_changes(const Scenario& scenario) {
  std::vector<plant_sim::Change> all = scenario.faults;
  all.insert(all.end(), scenario.model.changes.begin(), scenario.model.changes.end());
  return all;
}

}  // namespace

ClosedLoop::ClosedLoop(const Scenario& scenario, std::uint64_t seed)
    : plant_(plant_sim::make_plant(plant_sim::without_changes(scenario.model))),
      schedule_(faults_and_changes(scenario), *plant_),
      reference_(monitor::control::make_reference(scenario.reference, scenario.folder)),
      controller_({scenario.model.loop.kp_V_per_m}, limits(scenario.instruments), kSampleTime_s),
      sensor_(scenario.sensor_faults),
      encoder_(scenario.instruments.encoder_resolution_m, scenario.instruments.noise_m, seed),
      dac_{static_cast<int>(scenario.instruments.dac_bits), scenario.instruments.dac_range_V} {
  check_step(plant_->step_s());
}

LoopRow ClosedLoop::step() noexcept {
  LoopRow row{};
  row.t_s = static_cast<double>(next_) * kSampleTime_s;
  row.rod_m = plant_->reading_m();
  row.pressures = plant_->pressures();
  const double signal_m = sensor_.signal_m(row.t_s, row.rod_m);
  row.y_m = sensor_.reading_m(row.t_s, encoder_.read(signal_m));
  row.reference_m = reference_->at(row.t_s);
  const monitor::control::ValveCommand command = controller_.update(row.reference_m, row.y_m);
  row.u_requested_V = command.requested_V;
  row.u_applied_V = dac_.apply(command.limited_V);
  row.saturated = command.saturated;
  schedule_.advance(*plant_, row.u_applied_V, row.t_s, kSampleTime_s);
  ++next_;
  return row;
}

}  // namespace workbench::simulate
