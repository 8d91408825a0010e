// Proportional position controller with a limit of range and of slew.
//
//   u = null + Kp (r - y), then |u - null| <= limit, then |u_k - u_{k-1}| <= slew Ts
//
// u, null, limit in V; Kp in V/m; slew in V/s. A start begins at null, so that the slew limit
// prevents a jump.
#pragma once

#include <limits>

#include "config/schema/visitor.h"

namespace monitor::control {

struct ControllerConfig {
  double kp_V_per_m = 100.0;
  void visit(config::schema::Visitor& v);
};

struct ValveLimits {
  double null_V = 0.0;
  double limit_V = 10.0;
  double slew_V_per_s = std::numeric_limits<double>::infinity();
};

struct ValveCommand {
  double requested_V = 0.0;  ///< before limits
  double limited_V = 0.0;    ///< to write to the valve
  bool saturated = false;    ///< the range or slew limit was active
};

class Controller {
 public:
  Controller(const ControllerConfig& config, const ValveLimits& limits,
             double sample_time_s) noexcept;

  /// Restarts the slew limit from null.
  void reset() noexcept { last_V_ = limits_.null_V; }
  [[nodiscard]] double null_V() const noexcept { return limits_.null_V; }
  /// `periods` >= 1 since the last call, so that the slew limit counts time, not calls.
  ValveCommand update(double reference_m, double y_m, int periods = 1) noexcept;

 private:
  double kp_V_per_m_;
  ValveLimits limits_;
  double step_V_;  ///< slew allowance of one period
  double last_V_;
};

}  // namespace monitor::control
