// The stand in simulation: plant, instruments and proportional controller, sample by sample, in the
// same order as the daemon's loop.
//
//   y_k = encoder(reading(t_k)),   u_k = sat(Kp (r_k - y_k)),   u_k held until t_k+1
//
// Kp comes from the model file's [loop].
#pragma once

#include <cstdint>
#include <memory>

#include "daemon/control/controller.h"
#include "plant_sim/instruments.h"
#include "plant_sim/plant.h"
#include "plant_sim/schedule.h"
#include "workbench/simulate/scenario.h"

namespace workbench::simulate {

/// Control and monitoring at 200 Hz, as in the thesis.
inline constexpr double kSampleTime_s = 0.005;

struct LoopRow {
  double t_s;
  double reference_m;
  double rod_m;  ///< reading of a sensor without steps, noise or fault
  double y_m;    ///< as measured
  double u_requested_V;
  double u_applied_V;  ///< after the limit and the D/A converter
  bool saturated;
  config::signals::Pressures pressures;  ///< when y was sampled, without a transducer's error
};

class ClosedLoop {
 public:
  /// Throws config::schema::ConfigError for a bad reference file, fault or step.
  ClosedLoop(const Scenario& scenario, std::uint64_t seed);

  /// The next sample; the plant then moves on by one period.
  LoopRow step() noexcept;

 private:
  std::unique_ptr<plant_sim::Plant> plant_;
  plant_sim::Schedule schedule_;
  std::unique_ptr<monitor::control::Reference> reference_;
  monitor::control::Controller controller_;
  FaultySensor sensor_;
  plant_sim::Encoder encoder_;
  plant_sim::DacRange dac_;
  std::int64_t next_ = 0;
};

}  // namespace workbench::simulate
