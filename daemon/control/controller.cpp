#include "daemon/control/controller.h"

#include <algorithm>

namespace monitor::control {

void ControllerConfig::visit(config::schema::Visitor& v) {
  v.number({"kp_V_per_m", "proportional gain"}, kp_V_per_m, {0.0, 1e6});
}

Controller::Controller(const ControllerConfig& config, const ValveLimits& limits,
                       double sample_time_s) noexcept
    : kp_V_per_m_(config.kp_V_per_m),
      limits_(limits),
      step_V_(limits.slew_V_per_s * sample_time_s),
      last_V_(limits.null_V) {}

ValveCommand Controller::update(double reference_m, double y_m, int periods) noexcept {
  ValveCommand command;
  command.requested_V = limits_.null_V + kp_V_per_m_ * (reference_m - y_m);
  const double ranged_V = std::clamp(command.requested_V, limits_.null_V - limits_.limit_V,
                                     limits_.null_V + limits_.limit_V);
  const double step_V = step_V_ * periods;
  command.limited_V = std::clamp(ranged_V, last_V_ - step_V, last_V_ + step_V);
  command.saturated = command.limited_V != command.requested_V;
  last_V_ = command.limited_V;
  return command;
}

}  // namespace monitor::control
