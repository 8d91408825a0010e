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
#include "daemon/detection/detector.h"
#include "daemon/detection_config.h"
#include "daemon/main_event_loop.h"
#include "daemon/null_table.h"
#include "daemon/reloader.h"
#include "daemon/rt/loop_runner.h"
#include "daemon/safe_state_note.h"
#include "daemon/safe_state_valve.h"
#include "daemon/service_report.h"

namespace monitor {
namespace {

/// The first period begins this long after everything stands.
constexpr std::int64_t kLead_ns = 20'000'000;
constexpr std::int64_t kCommandLife_ns = 1'000'000'000;

/// What a session consists of before it runs: nothing has been written to a device yet.
struct Prepared {
  double sample_time_s;
  hal::OpenContext opening;
  hal::Devices devices;
  std::unique_ptr<control::Reference> reference;
  std::uint64_t hash;
  DetectionConfig detection;
  std::vector<control::GuardConfig> guards;
  std::string never_arms;  ///< why it may not be armed; empty: it may
};

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

void check_numbers(const std::string& file, const hal::Rig& rig) {
  const auto check = [&](const char* table, std::size_t size, std::size_t most) {
    if (size <= most) return;
    throw config::schema::bad_config(file + ": [[" + table + "]]",
                                     std::to_string(size) + " of them",
                                     "at most " + std::to_string(most));
  };
  check("spare_rod", rig.spare_rods().size(), rt::kMaxSpareRods);
  check("input", rig.inputs().size(), rt::kMaxInputs);
}

void check_failover(const DaemonConfig& config) {
  if (!config.safety.failover.present || config.rig.rods() > 1) return;
  throw config::schema::bad_config(config.file + ": [failover]",
                                   "has no other rod sensor to go over to", "a [[spare_rod]]");
}

/// To run, where no other process may drive the devices; or, with `absent`, to look at, where a
/// device that cannot be reached is named in it and all else goes on.
Prepared prepare(DaemonConfig& config, std::string* absent) {
  Prepared p;
  p.sample_time_s = 1.0 / config.loop.rate_Hz;
  p.opening = {config.file,
               config.folder,
               p.sample_time_s,
               config.rig.valve().null_V,
               config.rig.valve().limit_V,
               absent == nullptr};
  check_numbers(config.file, config.rig);
  check_failover(config);
  try {
    p.devices = config.rig.open(p.opening);
  } catch (const config::schema::DeviceUnavailable& e) {
    if (absent == nullptr) throw;
    *absent = e.what();
  }
  p.guards = with_place(config.file,
                        [&] { return control::all_guards(config.safety, config.loop.overrun()); });
  p.never_arms = never_arms(config);
  if (!std::isnan(p.devices.sample_time_s)) p.sample_time_s = p.devices.sample_time_s;
  const bool from_file = config.reference.kind == "file";
  p.reference = with_place(config.file + ": [reference]" + (from_file ? " file" : ""), [&] {
    return control::make_reference(
        config.drives_valve() ? config.reference : control::ReferenceConfig{}, config.folder);
  });
  p.detection = make_detection_config(config, p.sample_time_s);
  p.hash = hash(config);
  return p;
}

/// In virtual time, where nobody serves a socket.
bool stop_pending(Reloader& reloader) {
  const sigset_t set = stop_signals();
  const timespec now{0, 0};
  const int signal = sigtimedwait(&set, nullptr, &now);
  reloader.poll();
  if (signal == SIGHUP) reloader.begin(getuid(), "SIGHUP");
  return signal > 0 && signal != SIGHUP;
}

void report(const rt::LoopStats& stats, std::ostream& log) {
  const struct {
    const char* what;
    const rt::Histogram& times;
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

/// Closes the log; says so when messages are missing in it.
bool recorded_all(io::Recorder& recorder, std::ostream& log) {
  const std::int64_t missing = recorder.finish();
  if (missing == 0) return true;
  const int error = recorder.status().error;
  log << "spoolwatchd: recorder: " << missing << " messages are not in the log"
      << (error != 0 ? std::string(" (") + std::strerror(error) + ")" : "") << std::endl;
  return false;
}

void arm_and_start(rt::CommandQueue& commands, std::int64_t expires_ns) {
  rt::Command command;
  command.expires_ns = expires_ns;
  for (const control::Event event : {control::Event::arm, control::Event::start}) {
    command.event = event;
    command.at_once = true;
    commands.push(command);
  }
}

}  // namespace

int run_session(DaemonConfig& config, const SessionOptions& options, std::ostream& log) {
  Prepared p = prepare(config, nullptr);
  const bool virtual_time = options.virtual_time || p.devices.fast;
  const sigset_t signals = stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);

  rt::VirtualClock virtual_clock;
  rt::MonotonicClock monotonic_clock;
  rt::Clock& clock = virtual_time ? static_cast<rt::Clock&>(virtual_clock) : monotonic_clock;
  std::unique_ptr<io::ControlSocket> socket;
  if (!config.control.socket.empty() && !virtual_time) {
    socket = std::make_unique<io::ControlSocket>(config.control, config.file);
  }
  const std::int64_t run_id =
      virtual_time ? static_cast<std::int64_t>(p.hash >> 1U) : clock.utc_us();
  std::unique_ptr<io::Recorder> recorder;
  if (!config.recorder.folder.empty()) {
    recorder = std::make_unique<io::Recorder>(config.recorder, run_id, !virtual_time);
  }
  AlarmServices alarms(config, p.detection,
                       {config::schema::hash_text(p.hash), run_id, p.sample_time_s, virtual_time});
  io::Publisher publisher(config.lcm, run_id, p.sample_time_s, recorder.get());
  if (alarms.evidence != nullptr) publisher.attach(*alarms.evidence);
  if (config.rig.measures_pressures()) publisher.enable_pressures();

  auto samples = std::make_unique<rt::SampleQueue>();
  rt::CommandQueue commands;
  rt::LoopStats stats;
  const hal::ValveConfig& valve_config = config.rig.valve();
  const control::Controller controller(
      config.controller, {valve_config.null_V, valve_config.limit_V, valve_config.slew_V_per_s},
      p.sample_time_s);
  rt::Grant grant;
  grant.text = "virtual time";
  if (!virtual_time) grant = rt::request_privileges(config.loop);
  log << "spoolwatchd: real-time privileges: " << grant.text << std::endl;
  const SafeStateNote note(
      virtual_time || !config.drives_valve() ? std::filesystem::path() : options.driving, config);
  SafeStateValve safe_valve(p.devices.valve.get());
  hal::ValveDrive* valve = safe_valve.valve();
  rt::Loop loop(config.loop,
                {clock, *p.devices.rod, valve, *p.reference, *samples, commands, stats,
                 &p.devices.spare_rods, &p.devices.inputs, p.devices.permit.get()},
                controller, p.sample_time_s, {config.safety, p.never_arms.empty()});
  Reloader reloader({clock, log, alarms.audit.get(), alarms.evidence != nullptr, options.read,
                     alarms.pipeline_hash},
                    config, p.sample_time_s);
  detection::DetectabilityMonitor detectability;
  detection::Detector detector(
      {clock, *samples, stats, *p.detection.pipeline, publisher, recorder.get(), &alarms.commands,
       &alarms.answers, alarms.store.get(), alarms.audit.get(), alarms.evidence.get(),
       alarms.pipeline_hash, &reloader.to_detector, &reloader.from_detector, &detectability},
      {config.rig_id, config::schema::hash_text(p.hash), grant.text, config.rig.rod_backend(),
       valve != nullptr ? valve_config.backend : "", ids_of(p.devices.spare_rods),
       ids_of(p.devices.inputs), p.guards, p.sample_time_s});
  alarms.restore(*p.detection.pipeline, clock.utc_us(), log);
  ControlRequestHandler handler(
      {clock, commands, stats, &alarms.commands, &alarms.answers, alarms.audit.get(), &reloader,
       &detectability},
      {config.rig_id, config::schema::hash_text(p.hash), p.guards, ids_of(p.devices.spare_rods),
       ids_of(p.devices.inputs), inputs_of(p.devices, hal::InputRole::enable),
       inputs_of(p.devices, hal::InputRole::e_stop), p.never_arms});
  MainEventLoop event_loop(handler, socket.get(), reloader);
  const io::ServiceManager manager;
  ServiceReport service(manager, clock, stats, valve != nullptr);

  const std::int64_t start_ns = clock.now_ns() + (virtual_time ? 0 : kLead_ns);
  if (config.loop.auto_arm && valve != nullptr) {
    arm_and_start(commands, start_ns + kCommandLife_ns);
  }
  const std::int64_t ticks =
      options.duration_s > 0.0 ? std::llround(options.duration_s / p.sample_time_s) : rt::kForever;
  std::atomic<bool> stop{false};
  rt::LoopRunner runner(loop, rt::Grid(start_ns, std::llround(p.sample_time_s * 1e9)), clock, valve,
                        ticks, stop);
  const rt::RunError run_error =
      virtual_time ? rt::run_virtual(runner, detector, stop, [&] { return stop_pending(reloader); })
                   : rt::run_realtime(runner, detector, grant.loop_thread, stop, valve, [&] {
                       service.remark(reloader.complaint());
                       service.poll();
                       const bool stops = event_loop.run_once();
                       if (stops) service.stopping();
                       return stops;
                     });
  if (valve != nullptr && valve->end_at_null().good) note.withdraw();
  if (!virtual_time) {
    report(stats, log);
    for (const auto& summary : p.devices.summaries) log << "spoolwatchd: " << summary() << '\n';
  }
  if (!run_error.empty()) log << "spoolwatchd: " << run_error << std::endl;
  if (alarms.evidence != nullptr) alarms.evidence->finish();
  const bool complete = recorder == nullptr || recorded_all(*recorder, log);
  return run_error.empty() && complete ? EXIT_SUCCESS : EXIT_FAILURE;
}

void check_session(DaemonConfig& config, std::ostream& out) {
  std::string absent;
  const Prepared p = prepare(config, &absent);
  const bool would_write_a_file = config.lcm.url.starts_with("file:");
  if (!would_write_a_file) io::Publisher(config.lcm, 0, p.sample_time_s, nullptr);
  if (!config.recorder.folder.empty()) io::check_folder(config.recorder);
  out << config::schema::print_toml([&](config::schema::Visitor& v) { config.visit(v); });
  out << "\n# " << config.file << ": period " << p.sample_time_s * 1e3 << " ms, configuration "
      << config::schema::hash_text(p.hash) << "\n";
  for (const std::string& note : config.rig.notes(p.opening)) out << "# " << note << "\n";
  if (!config.drives_valve()) {
    out << "# No valve is driven: state MONITOR, nothing is ever written.\n";
  } else {
    if (!p.never_arms.empty()) out << "# It cannot be armed: " << p.never_arms << "\n";
    print_null_table(
        {config.rig.valve().backend, config.rig.null_times(), p.sample_time_s,
         config.rig.worst_speed_mps(p.opening), config.safety.ramp_s, config.loop.max_bad_in_a_row,
         p.guards, config.rig.has_input(hal::InputRole::e_stop),
         config.rig.has_input(hal::InputRole::enable), config.rig.has_permit()},
        out);
  }
  if (absent.empty()) return;
  out.flush();
  throw config::schema::ConfigError(absent + "; all that can be checked without it is in order");
}

}  // namespace monitor
