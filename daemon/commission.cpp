#include "daemon/commission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>

#include "config/schema/error.h"
#include "daemon/commission_session.h"

namespace monitor {
namespace {

using config::schema::bad_config;
using config::schema::UsageError;

/// Share of [valve] limit_V when the backend does not know the fastest rod speed.
constexpr double kBlindShare = 0.05;
constexpr double kMaxShare = 0.1;

/// Holds the control socket, so that no daemon runs on this rig meanwhile; throws when one does.
/// Null where no daemon could have its socket.
std::unique_ptr<io::ControlSocket> claim(const DaemonConfig& config) {
  const std::filesystem::path socket = config.control.socket;
  std::error_code ignored;
  if (socket.empty() || !std::filesystem::is_directory(socket.parent_path(), ignored)) return {};
  return std::make_unique<io::ControlSocket>(config.control, config.file);
}

control::CommissioningLimits limits_of(const DaemonConfig& config, const CommissionOptions& o,
                                       const hal::OpenContext& opening, std::ostream& out) {
  control::CommissioningLimits limits;
  limits.max_travel_m = o.max_travel_m;
  limits.home_travel_m = o.home_travel_m;
  limits.pulse_s = o.pulse_s;
  limits.max_speed_mps = std::isnan(o.max_speed_mps) ? o.max_travel_m / 0.1 : o.max_speed_mps;
  const double limit_V = config.rig.valve().limit_V;
  // A pulse without a reading ends up to two periods late.
  const double worst_mps_per_V = config.rig.worst_speed_mps(opening) / limit_V;
  const double blind_m_per_V = worst_mps_per_V * (o.pulse_s + 2.0 * opening.sample_time_s);
  limits.authority_V = o.authority_V;
  if (std::isnan(o.authority_V)) {
    limits.authority_V = std::isnan(blind_m_per_V)
                             ? kBlindShare * limit_V
                             : std::min(kMaxShare * limit_V, o.max_travel_m / blind_m_per_V);
  }
  if (limits.authority_V > limit_V) {
    throw UsageError(fmt::format("--authority: is {:g}; allowed: up to [valve] limit_V, {:g}",
                                 limits.authority_V, limit_V));
  }
  out << fmt::format(
             "Commissioning \"{}\": {:.3g} V about null {:.3g} V, rod within {:.1f} mm, below "
             "{:.1f} mm/s",
             config.rig_id, limits.authority_V, config.rig.valve().null_V,
             limits.max_travel_m * 1e3, limits.max_speed_mps * 1e3)
      << '\n';
  out << (std::isnan(blind_m_per_V)
              ? std::string("If the sensor is dead, only the authority limits the travel: the "
                            "backend does not state the maximum rod speed")
              : fmt::format("If the sensor is dead, the rod moves by {:.1f} mm at most",
                            blind_m_per_V * limits.authority_V * 1e3))
      << std::endl;
  return limits;
}

}  // namespace

int commission(DaemonConfig& config, const CommissionOptions& options, std::ostream& out) {
  if (!config.drives_valve()) {
    throw bad_config(config.file + ": [valve] backend", "is \"none\", which drives no valve",
                     "a backend that drives a valve");
  }
  if (options.virtual_time && !config.rig.harmless()) {
    throw UsageError("--clock virtual: the rig has real devices; allowed: realtime");
  }
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::absolute(options.out).parent_path();
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw UsageError("--commission: " + folder.string() + " is not a folder");
  }
  const double sample_time_s = 1.0 / config.loop.rate_Hz;
  const hal::OpenContext opening{config.file, config.folder, sample_time_s,
                                 config.rig.valve().null_V, config.rig.valve().limit_V};
  OperatorPrompt prompt(out, options.yes);
  std::unique_ptr<io::ControlSocket> claimed;
  if (!options.virtual_time) claimed = claim(config);
  const control::CommissioningLimits limits = limits_of(config, options, opening, out);
  const hal::Devices devices = config.rig.open(opening);
  return CommissionSession(config, options, limits, prompt, out).run(devices, sample_time_s);
}

}  // namespace monitor
