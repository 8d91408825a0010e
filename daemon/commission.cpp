#include "daemon/commission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <memory>
#include <ostream>

#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "daemon/commission_loop.h"
#include "daemon/control/calibration.h"
#include "daemon/operator_prompt.h"
#include "daemon/rt/privileges.h"
#include "daemon/safe_state_valve.h"

namespace monitor {

// One commissioning on open devices: runs the stages in order, asks the operator, reports and
// writes the calibration file.

class CommissionSession {
 public:
  CommissionSession(DaemonConfig& config, const CommissionOptions& options,
                    const control::CommissioningLimits& limits, OperatorPrompt& prompt,
                    std::ostream& out)
      : config_(config),
        options_(options),
        limits_(limits),
        out_(out),
        procedure_(limits),
        prompt_(prompt) {}

  /// Returns the exit code; throws config::schema::Error.
  int run(const hal::Devices& devices, double sample_time_s);

 private:
  /// Thrown when the operator stops or the procedure aborts; already reported.
  struct Ended {
    int exit_code;
  };

  void stages();
  void agree(const std::string& question);
  void stage(const char* name, const std::function<void()>& begin);
  void sign();
  void speeds();
  /// Drives to the stop or index and returns the reading there.
  double home(int direction, bool index);
  void homes();
  [[noreturn]] void abort(const std::string& why);
  void write(std::int64_t utc_us);

  DaemonConfig& config_;
  const CommissionOptions& options_;
  control::CommissioningLimits limits_;
  std::ostream& out_;
  control::Commissioning procedure_;
  control::Calibration found_;
  OperatorPrompt& prompt_;
  CommissionLoop* loop_ = nullptr;
};

namespace {

using config::schema::RunError;
using control::Failure;
using control::Stage;

std::string today(std::int64_t utc_us) {
  const std::time_t now = utc_us / 1'000'000;
  std::tm parts{};
  gmtime_r(&now, &parts);
  char date[16];
  std::strftime(date, sizeof date, "%Y-%m-%d", &parts);
  return date;
}

/// Advice appended to the failure.
const char* remedy(Failure failure) noexcept {
  switch (failure) {
    case Failure::travel:
      return "; set [valve] null_V closer to the voltage at which the rod stands still, or "
             "increase "
             "--max-travel-mm";
    case Failure::speed:
      return "; reduce --authority for smaller first steps";
    case Failure::no_motion:
      return "; check supply, enable and sensor, or increase --authority";
    case Failure::too_noisy:
      return "; increase --max-travel-mm";
    case Failure::too_slow:
      return "; increase --pulse";
    default:
      return "";
  }
}

}  // namespace

void CommissionSession::abort(const std::string& why) {
  out_ << "aborted at null, nothing written: " << why << std::endl;
  throw Ended{EXIT_FAILURE};
}

void CommissionSession::agree(const std::string& question) {
  const auto answer = prompt_.ask(question);
  if (prompt_.stopped()) {
    out_ << "stopped at null, nothing written" << std::endl;
    throw Ended{kStoppedExitCode};
  }
  if (!answer.value_or(false)) abort("not agreed");
}

void CommissionSession::stage(const char* name, const std::function<void()>& begin) {
  begin();
  if (!loop_->run_stage([this] { return options_.virtual_time ? false : prompt_.wait_stop(); })) {
    out_ << "stopped at null, nothing written" << std::endl;
    throw Ended{kStoppedExitCode};
  }
  if (loop_->stop() != CommissionLoop::Stop::none) {
    abort(fmt::format("{}: {}", name, to_string(loop_->stop())));
  }
  const Failure failure = procedure_.failure();
  if (failure == Failure::none || failure == Failure::reversed) return;
  abort(fmt::format("{}: {} (travel {:.2f} mm, final speed {:.1f} mm/s){}", name,
                    to_string(failure), procedure_.travel_m() * 1e3, procedure_.speed_mps() * 1e3,
                    remedy(failure)));
}

void CommissionSession::sign() {
  stage("sign", [this] { procedure_.begin(Stage::sign); });
  const control::Findings& f = procedure_.findings();
  out_ << fmt::format("sign:   {:+.3f} V moved the reading by {:+.3f} mm", f.sign_V, f.sign_m * 1e3)
       << std::endl;
  const bool fits = procedure_.failure() == Failure::none;
  std::string wrong = fits ? "" : "valve or rod sensor is reversed";
  if (prompt_.asks()) {
    const auto extended = prompt_.ask("Did the rod extend?");
    if (!extended) agree("");
    const bool retracts = *extended != (f.sign_V > 0.0);
    if (fits && retracts) wrong = "both valve and rod sensor are reversed";
    if (!fits) wrong = retracts ? "the valve is reversed" : "the rod sensor is reversed";
  }
  if (!wrong.empty()) {
    abort(wrong + ": reverse its sign in the configuration (valve: backend " +
          config_.rig.valve().backend + ", rod: backend " + config_.rig.rod_backend() + ")");
  }
}

void CommissionSession::speeds() {
  stage("speeds", [this] { procedure_.begin(Stage::speeds); });
  const control::Findings& f = procedure_.findings();
  found_.null_V = config_.rig.valve().null_V + f.null_V;
  found_.dead_zone_V = f.dead_zone_V;
  found_.gain_mps_per_V = f.gain_mps_per_V;
  found_.latency_s = f.latency_s;
  out_ << fmt::format(
              "speeds: null {:.4f} V, dead zone {:.4f} V wide, gain {:.2f} mm/s per V, latency "
              "{:.1f} ms",
              found_.null_V, f.dead_zone_V, f.gain_mps_per_V * 1e3, f.latency_s * 1e3)
       << std::endl;
}

double CommissionSession::home(int direction, bool index) {
  const char* where = direction > 0 ? "above" : "below";
  agree(fmt::format("Drive to the {} {}, up to {:.0f} mm, at {:.1f} mm/s?",
                    index ? "index" : "stop", where, limits_.home_travel_m * 1e3,
                    procedure_.target_mps() * 1e3));
  stage("home", [&] { procedure_.begin_home(direction, index); });
  const double y_m = procedure_.findings().home_m;
  out_ << fmt::format("home:   {} {} at a reading of {:.3f} mm", index ? "index" : "stop", where,
                      y_m * 1e3)
       << std::endl;
  return y_m;
}

void CommissionSession::homes() {
  if (!std::isnan(options_.stroke_m)) {
    const double below_m = home(-1, false);
    const double above_m = home(1, false);
    found_.rod_scale = options_.stroke_m / (above_m - below_m);
    out_ << fmt::format("scale:  1 m of reading is {:.5f} m of travel", found_.rod_scale)
         << std::endl;
    found_.home = "stop_above";
    found_.home_m = above_m;
    return;
  }
  if (options_.home == "none") return;
  const bool index = options_.home.starts_with("index");
  if (index && loop_->quality() == config::signals::Quality::good) {
    out_ << "home:   the sensor has already found its index, or has none" << std::endl;
    return;
  }
  found_.home_m = home(options_.home.ends_with("above") ? 1 : -1, index);
  found_.home = index ? "index" : options_.home;
}

void CommissionSession::stages() {
  stage("rest", [this] { procedure_.begin(Stage::rest); });
  const control::Findings& f = procedure_.findings();
  found_.noise_m = f.noise_m;
  out_ << fmt::format("rest:   noise {:.2f} um, drift {:.2f} mm/s at {:.3g} V", f.noise_m * 1e6,
                      f.drift_mps * 1e3, config_.rig.valve().null_V)
       << std::endl;
  agree(fmt::format("Apply pulses in both directions, up to {:.3g} V and {:.1f} mm?",
                    limits_.authority_V, limits_.max_travel_m * 1e3));
  sign();
  agree(fmt::format("Apply pulses in both directions, up to {:.1f} mm/s and {:.1f} mm?",
                    procedure_.target_mps() * 1e3, limits_.max_travel_m * 1e3));
  speeds();
  homes();
}

void CommissionSession::write(std::int64_t utc_us) {
  found_.rig_id = config_.rig_id;
  found_.date = today(utc_us);
  found_.wiring = wiring(config_);
  found_.authority_V = limits_.authority_V;
  found_.max_travel_m = limits_.max_travel_m;
  found_.max_speed_mps = limits_.max_speed_mps;
  config::record::write_whole(options_.out, control::print_calibration(found_));
  out_ << "written: " << options_.out.string() << std::endl;
  const hal::ValveConfig& valve = config_.rig.valve();
  const std::string against =
      control::contradiction(found_, valve.null_V, valve.limit_V, found_.wiring);
  if (!against.empty())
    out_ << "arming will be rejected with this configuration: " << against << std::endl;
}

int CommissionSession::run(const hal::Devices& devices, double sample_time_s) {
  rt::VirtualClock virtual_clock;
  rt::MonotonicClock monotonic_clock;
  rt::Clock& clock =
      options_.virtual_time ? static_cast<rt::Clock&>(virtual_clock) : monotonic_clock;
  rt::Grant grant;
  if (!options_.virtual_time) grant = rt::request_privileges(config_.loop);
  SafeStateValve guard(devices.valve.get());
  CommissionLoop loop({clock, devices, *guard.valve(), config_.rig.valve().null_V, sample_time_s,
                       config_.loop.max_bad_in_a_row},
                      procedure_, options_.virtual_time);
  loop_ = &loop;
  const int error = loop.start(grant.loop_thread);
  if (error != 0) throw RunError(std::string("cannot start a thread: ") + std::strerror(error));
  int exit_code = EXIT_SUCCESS;
  try {
    stages();
  } catch (const Ended& ended) {
    exit_code = ended.exit_code;
  }
  if (!loop.end()) {
    devices.valve->end_at_null();
    std::fputs("spoolwatchd: a device does not return: null commanded\n", stderr);
    std::_Exit(EXIT_FAILURE);
  }
  guard.close();
  if (exit_code == 0) write(monotonic_clock.utc_us());
  return exit_code;
}

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
