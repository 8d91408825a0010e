#include "daemon/commission_session.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <ostream>

#include "config/schema/error.h"
#include "daemon/rt/privileges.h"
#include "daemon/safe_state_valve.h"

namespace monitor {
namespace {

using config::schema::RunError;
using control::Failure;
using control::Stage;

/// Replaces the file atomically.
void write_whole(const std::filesystem::path& file, const std::string& content) {
  const std::string part = file.string() + ".part";
  const int fd = open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  const bool written =
      fd >= 0 &&
      write(fd, content.data(), content.size()) == static_cast<ssize_t>(content.size()) &&
      fsync(fd) == 0;
  const int error = errno;
  if (fd >= 0) close(fd);
  if (!written || std::rename(part.c_str(), file.c_str()) != 0) {
    const int why = written ? errno : error;
    unlink(part.c_str());
    throw RunError(file.string() + ": cannot be written: " + std::strerror(why));
  }
}

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
  write_whole(options_.out, control::print_calibration(found_));
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
  if (error != 0) {
    throw RunError(std::string("cannot start a thread: ") + std::strerror(error));
  }
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

}  // namespace monitor
