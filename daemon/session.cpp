#include "daemon/session.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <ostream>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/hash.h"
#include "daemon/alarm_services.h"
#include "daemon/control/protocol.h"
#include "daemon/detection/detector.h"
#include "daemon/detection_config.h"
#include "daemon/io/folder_lock.h"
#include "daemon/main_event_loop.h"
#include "daemon/null_table.h"
#include "daemon/prepared_session.h"
#include "daemon/readings_now.h"
#include "daemon/reloader.h"
#include "daemon/rt/loop_runner.h"
#include "daemon/safe_state_note.h"
#include "daemon/safe_state_valve.h"
#include "daemon/service_report.h"

namespace monitor {
namespace {

/// Delay from the end of opening to the first period.
constexpr std::int64_t kLead_ns = 20'000'000;
constexpr std::int64_t kAutoStartLife_ns = 1'000'000'000;

template <class Named>
std::vector<std::string> ids_of(const std::vector<Named>& devices) {
  std::vector<std::string> ids;
  ids.reserve(devices.size());
  for (const auto& device : devices) ids.push_back(device.id);
  return ids;
}

std::vector<std::size_t> inputs_of(const hal::Devices& devices, hal::InputRole role) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < devices.inputs.size(); ++i) {
    if (devices.inputs[i].role == role) found.push_back(i);
  }
  return found;
}

/// Handles signals in virtual time, which has no control socket. Returns true on a request to stop.
bool stop_pending(Reloader& reloader) {
  const sigset_t set = stop_signals();
  const timespec now{0, 0};
  const int signal = sigtimedwait(&set, nullptr, &now);
  reloader.poll();
  if (signal == SIGHUP) reloader.begin(getuid(), "SIGHUP");
  return signal > 0 && signal != SIGHUP;
}

void log_statistics(const rt::LoopStats& stats, std::ostream& log) {
  const struct {
    const char* what;
    const hal::Histogram& times;
  } rows[] = {{"lateness", stats.lateness},
              {"tick", stats.tick},
              {"read", stats.read},
              {"control", stats.control},
              {"write", stats.write}};
  log << "spoolwatchd: " << stats.ticks.value() << " ticks, " << stats.overruns.value()
      << " overruns, " << stats.skipped_periods.value() << " periods skipped, "
      << stats.dropped_samples.value() << " samples dropped; of each period:\n";
  for (const auto& row : rows) {
    const auto us = [&](double q) { return static_cast<double>(row.times.quantile_ns(q)) * 1e-3; };
    log << fmt::format("  {:8} p50 {:.1f} us  p99 {:.1f} us  p99.9 {:.1f} us  max {:.1f} us\n",
                       row.what, us(0.5), us(0.99), us(0.999),
                       static_cast<double>(row.times.max_ns()) * 1e-3);
  }
}

/// Closes the log and reports missing messages.
bool recorded_all(io::Recorder& recorder, std::ostream& log) {
  const std::int64_t missing = recorder.finish();
  if (missing == 0) return true;
  const int error = recorder.status().error;
  log << "spoolwatchd: recorder: " << missing << " messages are not in the log"
      << (error != 0 ? std::string(" (") + std::strerror(error) + ")" : "") << std::endl;
  return false;
}

void arm_and_start(rt::CommandQueue& commands, std::int64_t expires_ns) {
  rt::LoopCommand command;
  command.expires_ns = expires_ns;
  for (const control::Event event : {control::Event::arm, control::Event::start}) {
    command.event = event;
    command.at_once = true;
    commands.push(command);
  }
}

/// One run of the daemon, in three steps: open (the constructor), run, report. Members are in the
/// order in which they are opened; each may refer to those before.
class Session {
 public:
  /// Opens everything; nothing but null has been written to a device afterwards.
  Session(DaemonConfig& config, const SessionOptions& options, std::ostream& log);
  /// Runs the loop to its end and leaves the valve at null.
  void run();
  /// Logs the statistics and closes the files. Returns the exit code.
  int report();

 private:
  rt::Clock& choose_clock();
  std::unique_ptr<io::ControlSocket> open_socket() const;
  std::unique_ptr<io::Recorder> open_recorder();
  rt::Grant request_privileges() const;
  /// Tells the operator the state, where the daemon listens, and what to type next.
  void announce() const;
  std::vector<std::string> spare_rods() const { return ids_of(prepared_.devices.spare_rods); }
  std::vector<std::string> inputs() const { return ids_of(prepared_.devices.inputs); }
  std::vector<std::string> roles() const {
    std::vector<std::string> roles;
    for (const hal::InputConfig& input : config_.rig.inputs()) roles.push_back(input.role);
    return roles;
  }
  [[nodiscard]] bool handle_events();

  DaemonConfig& config_;
  const SessionOptions& options_;
  std::ostream& log_;
  PreparedSession prepared_;
  std::string config_hash_;
  bool virtual_time_;
  rt::VirtualClock virtual_clock_;
  rt::MonotonicClock monotonic_clock_;
  rt::Clock& clock_;
  std::unique_ptr<io::ControlSocket> socket_;  ///< null: none
  std::int64_t run_id_;
  io::FolderLock folders_;
  std::unique_ptr<io::Recorder> recorder_;  ///< null: none
  AlarmServices alarms_;
  io::Publisher publisher_;
  std::unique_ptr<rt::SampleQueue> samples_ = std::make_unique<rt::SampleQueue>();
  rt::CommandQueue commands_;
  rt::LoopStats stats_;
  rt::Grant grant_;
  SafeStateNote note_;
  SafeStateValve safe_valve_;
  hal::ValveDrive* valve_;  ///< null: none
  rt::Loop loop_;
  Reloader reloader_;
  detection::DetectabilityMonitor detectability_;
  detection::Detector detector_;
  ControlRequestHandler handler_;
  MainEventLoop event_loop_;
  io::ServiceManager manager_;
  ServiceReport service_;
  std::string failure_;  ///< error of the run; empty: success
};

Session::Session(DaemonConfig& config, const SessionOptions& options, std::ostream& log)
    : config_(config),
      options_(options),
      log_(log),
      prepared_(prepare(config, nullptr)),
      config_hash_(config::schema::hash_text(prepared_.hash)),
      virtual_time_(options.virtual_time || prepared_.devices.fast),
      clock_(choose_clock()),
      socket_(open_socket()),
      run_id_(virtual_time_ ? static_cast<std::int64_t>(prepared_.hash >> 1U) : clock_.utc_us()),
      recorder_(open_recorder()),
      alarms_(config, prepared_.detection,
              {config_hash_, run_id_, prepared_.sample_time_s, virtual_time_}),
      publisher_(config.lcm, run_id_, prepared_.sample_time_s, recorder_.get()),
      grant_(request_privileges()),
      note_(virtual_time_ || !config.drives_valve() ? std::filesystem::path() : options.driving,
            config),
      safe_valve_(prepared_.devices.valve.get()),
      valve_(safe_valve_.valve()),
      loop_(config.loop,
            {clock_, *prepared_.devices.rod, valve_, *prepared_.reference, *samples_, commands_,
             stats_, &prepared_.devices.spare_rods, &prepared_.devices.inputs,
             prepared_.devices.permit.get()},
            control::Controller(config.controller,
                                {config.rig.valve().null_V, config.rig.valve().limit_V,
                                 config.rig.valve().slew_V_per_s},
                                prepared_.sample_time_s),
            prepared_.sample_time_s, {config.safety, prepared_.never_arms.empty()}),
      reloader_({clock_, log, alarms_.audit.get(), alarms_.evidence != nullptr, options.read,
                 alarms_.pipeline_hash, &commands_},
                config, prepared_.sample_time_s),
      detector_({clock_,
                 *samples_,
                 stats_,
                 *prepared_.detection.pipeline,
                 publisher_,
                 recorder_.get(),
                 {&alarms_.commands, &alarms_.answers, alarms_.store.get(), alarms_.audit.get(),
                  alarms_.evidence.get(), alarms_.pipeline_hash},
                 {&reloader_.to_detector, &reloader_.from_detector},
                 &detectability_},
                {config.rig_id, config_hash_, grant_.text, config.rig.rod_backend(),
                 valve_ != nullptr ? config.rig.valve().backend : "", spare_rods(), inputs(),
                 prepared_.guards, prepared_.sample_time_s}),
      handler_({clock_, commands_, stats_, &alarms_.commands, &alarms_.answers, alarms_.audit.get(),
                &reloader_, &detectability_},
               {config.rig_id, config_hash_, prepared_.guards, spare_rods(), inputs(), roles(),
                inputs_of(prepared_.devices, hal::InputRole::enable),
                inputs_of(prepared_.devices, hal::InputRole::e_stop), prepared_.never_arms}),
      event_loop_(handler_, socket_.get(), reloader_),
      service_(manager_, clock_, stats_, valve_ != nullptr) {
  if (alarms_.evidence != nullptr) publisher_.attach(*alarms_.evidence);
  if (config.rig.measures_pressures()) publisher_.enable_pressures();
  alarms_.restore(*prepared_.detection.pipeline, clock_.utc_us(), log);
}

/// Also blocks the stop signals, before the first thread starts.
rt::Clock& Session::choose_clock() {
  const sigset_t signals = stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  if (virtual_time_ && options_.clock != nullptr) return *options_.clock;
  if (virtual_time_) return virtual_clock_;
  return monotonic_clock_;
}

std::unique_ptr<io::ControlSocket> Session::open_socket() const {
  if (config_.control.socket.empty() || virtual_time_) return nullptr;
  return std::make_unique<io::ControlSocket>(config_.control, config_.file);
}

/// Claims the folders of the daemon first. In virtual time no alarm is stored: a run beside the
/// service of the stand is not refused.
std::unique_ptr<io::Recorder> Session::open_recorder() {
  folders_.claim(config_.recorder.folder, config_.file + ": [recorder] folder");
  if (!virtual_time_) folders_.claim(config_.alarms.folder, config_.file + ": [alarms] folder");
  folders_.claim(config_.evidence.folder, config_.file + ": [evidence] folder");
  if (config_.recorder.folder.empty()) return nullptr;
  return std::make_unique<io::Recorder>(config_.recorder, run_id_, !virtual_time_);
}

rt::Grant Session::request_privileges() const {
  rt::Grant grant;
  grant.text = "virtual time";
  if (!virtual_time_) grant = rt::request_privileges(config_.loop);
  log_ << "spoolwatchd: real-time privileges: " << grant.text << std::endl;
  return grant;
}

/// Waits up to 100 ms; returns true on a request to stop.
bool Session::handle_events() {
  service_.remark(reloader_.complaint());
  service_.poll();
  const bool stop = event_loop_.run_once();
  if (stop) service_.stopping();
  return stop;
}

void Session::announce() const {
  if (virtual_time_) return;
  log_ << "spoolwatchd: " << config_.rig_id << ": ";
  const bool arms_itself = config_.loop.auto_arm && valve_ != nullptr;
  if (valve_ == nullptr) {
    log_ << "MONITOR, nothing is ever written";
  } else if (arms_itself) {
    log_ << "RUN by [loop] auto_arm";
  } else {
    log_ << "DISARMED, the valve is at null";
  }
  if (!prepared_.never_arms.empty()) log_ << "; cannot be armed: " << prepared_.never_arms;
  log_ << '\n';
  if (const std::string bands = unlearned_bands(config_); !bands.empty()) {
    log_ << "spoolwatchd: no limits yet for the bands " << bands << ": "
         << config_.pipeline.bands_file
         << " does not exist; spoolwatch promote or calibrate learns them from healthy motion\n";
  }
  if (socket_ == nullptr) {
    log_ << "spoolwatchd: no [control] socket: it cannot be operated" << std::endl;
    return;
  }
  const std::string& socket = config_.control.socket;
  log_ << "spoolwatchd: control socket " << socket;
  if (socket != control::kDefaultSocket) {
    log_ << "; for the commands: export SPOOLWATCH_SOCKET="
         << std::filesystem::absolute(socket).string();
  }
  const bool can_arm = valve_ != nullptr && !arms_itself && prepared_.never_arms.empty();
  log_ << "\nspoolwatchd: next: "
       << (can_arm ? "spoolwatch arm, then spoolwatch start" : "spoolwatch status")
       << "; to watch: spoolwatch listen --live" << std::endl;
}

void Session::run() {
  announce();
  const double sample_time_s = prepared_.sample_time_s;
  const std::int64_t start_ns = clock_.now_ns() + (virtual_time_ ? 0 : kLead_ns);
  if (config_.loop.auto_arm && valve_ != nullptr) {
    arm_and_start(commands_, start_ns + kAutoStartLife_ns);
  }
  const std::int64_t ticks =
      options_.duration_s > 0.0 ? std::llround(options_.duration_s / sample_time_s) : rt::kForever;
  std::atomic<bool> stop{false};
  rt::LoopRunner runner(loop_, rt::Grid(start_ns, std::llround(sample_time_s * 1e9)), clock_,
                        valve_, ticks, stop);
  failure_ = virtual_time_ ? rt::run_virtual(runner, detector_, stop,
                                             [this] { return stop_pending(reloader_); })
                           : rt::run_realtime(runner, detector_, grant_.loop_thread, stop, valve_,
                                              [this] { return handle_events(); });
  if (valve_ != nullptr && valve_->end_at_null().good) note_.withdraw();
}

int Session::report() {
  if (!virtual_time_) {
    log_statistics(stats_, log_);
    for (const auto& summary : prepared_.devices.summaries) {
      log_ << "spoolwatchd: " << summary() << '\n';
    }
  }
  if (!failure_.empty()) log_ << "spoolwatchd: " << failure_ << std::endl;
  if (alarms_.evidence != nullptr) alarms_.evidence->finish();
  alarms_.finish(log_);
  const bool complete = recorder_ == nullptr || recorded_all(*recorder_, log_);
  return failure_.empty() && complete ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int run_session(DaemonConfig& config, const SessionOptions& options, std::ostream& log) {
  Session session(config, options, log);
  session.run();
  return session.report();
}

void check_session(DaemonConfig& config, std::ostream& out) {
  std::string absent;
  const PreparedSession p = prepare(config, &absent);
  const bool would_write_a_file = config.lcm.url.starts_with("file:");
  if (!would_write_a_file) io::Publisher(config.lcm, 0, p.sample_time_s, nullptr);
  for (const auto& [folder, key] : {std::pair(&config.recorder.folder, "recorder"),
                                    {&config.alarms.folder, "alarms"},
                                    {&config.evidence.folder, "evidence"}}) {
    if (!folder->empty()) io::check_writable(*folder, config.file + ": [" + key + "] folder");
  }
  out << config::schema::print_toml([&](config::schema::Visitor& v) { config.visit(v); });
  out << "\n# " << config.file << ": period " << p.sample_time_s * 1e3 << " ms, configuration "
      << config::schema::hash_text(p.hash) << "\n";
  for (const std::string& note : config.rig.notes(p.opening)) out << "# " << note << "\n";
  const bool is_record = !std::isnan(p.devices.sample_time_s);
  if (absent.empty() && !is_record) out << "# Read now: " << readings_now(p.devices) << "\n";
  if (!config.drives_valve()) {
    out << "# No valve is driven: state MONITOR, nothing is ever written.\n";
  } else {
    if (!p.never_arms.empty()) out << "# It cannot be armed: " << p.never_arms << "\n";
    print_null_table(
        {config.rig.valve().backend, config.rig.null_times(), p.sample_time_s,
         config.rig.worst_speed_mps(p.opening), config.safety.ramp_s, config.loop.max_bad_in_a_row,
         p.guards, config.rig.has_input(hal::InputRole::e_stop),
         config.rig.has_input(hal::InputRole::enable), config.rig.has_permit(),
         config.rig.reading_hold_s(p.opening)},
        out);
  }
  if (const std::string bands = unlearned_bands(config); !bands.empty()) {
    out << "# No limits yet for the bands " << bands << ": " << config.pipeline.bands_file
        << " does not exist.\n";
  }
  if (absent.empty()) return;
  out.flush();
  throw config::schema::ConfigError(absent +
                                    "; everything that can be checked without the device is valid");
}

}  // namespace monitor
