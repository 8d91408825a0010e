#include "daemon/daemon_config.h"

#include <algorithm>
#include <cmath>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "daemon/control/calibration.h"

namespace monitor {
namespace {

using config::schema::Visitor;

/// Keys whose values are paths that start from the configuration's folder.
constexpr const char* kPathKeys[] = {"sim.model",      "replay.record",   "reference.file",
                                     "bands_file",     "recorder.folder", "control.socket",
                                     "rig.calibration"};

/// A command that stays at the valve for ever needs someone else who takes it away.
void refuse_without_watchdog(const DaemonConfig& config) {
  const bool covered = config.rig.harmless() || config.rig.has_permit() ||
                       std::isfinite(config.rig.null_times().process_dead_s) ||
                       config.rig.valve().accept_no_hardware_watchdog;
  if (config.drives_valve() && !covered) {
    throw config::schema::bad_config(
        config.file + ": [valve] backend",
        "is \"" + config.rig.valve().backend +
            "\", which keeps its last command when this process dies",
        "with a command time-out of the device, with a [permit] output for a watchdog relay, or "
        "with [valve] accept_no_hardware_watchdog = true");
  }
}

/// "key=value" with the value made absolute where the key names a file.
std::string from_here(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string key = assignment.substr(0, equals);
  if (equals == std::string::npos ||
      std::find(std::begin(kPathKeys), std::end(kPathKeys), key) == std::end(kPathKeys)) {
    return assignment;
  }
  std::string path = assignment.substr(equals + 1);
  if (path.size() >= 2 && path.front() == '"' && path.back() == '"') {
    path = path.substr(1, path.size() - 2);
  }
  return key + "=\"" + (path.empty() ? "" : std::filesystem::absolute(path).string()) + '"';
}

}  // namespace

void DaemonConfig::visit_what_determines_the_data(Visitor& v) {
  v.table({"rig", "which rig this is"}, [this](Visitor& t) {
    t.text({"id", "its name in messages"}, rig_id);
    t.text({"calibration", "file that commissioning wrote; needed to arm what moves"}, calibration);
  });
  v.table({"loop", "the control loop"}, [this](Visitor& t) { loop.visit(t); });
  rig.visit(v);
  if (drives_valve()) {
    v.table({"reference", "the motion"}, [this](Visitor& t) { reference.visit(t); });
    v.table({"controller", "the control law"}, [this](Visitor& t) { controller.visit(t); });
  }
  safety.visit(v);
  pipeline.visit(v);
}

void DaemonConfig::visit(Visitor& v) {
  visit_what_determines_the_data(v);
  v.table({"control", "who may look and act"}, [this](Visitor& t) { control.visit(t); });
  v.table({"lcm", "where messages go"}, [this](Visitor& t) { lcm.visit(t); });
  v.table({"recorder", "where logs go"}, [this](Visitor& t) { recorder.visit(t); });
}

void load(const std::filesystem::path& file, const std::vector<std::string>& assignments,
          DaemonConfig& config) {
  config::schema::Document document = config::schema::Document::load(file);
  for (const std::string& assignment : assignments) document.set(from_here(assignment));
  document.read([&](Visitor& v) { config.visit(v); });
  config.file = document.name();
  config.folder = document.folder();
  if (!config.recorder.folder.empty()) {
    config.recorder.folder = (config.folder / config.recorder.folder).string();
  }
  if (!config.control.socket.empty()) {
    config.control.socket = (config.folder / config.control.socket).string();
  }
  io::check_control(config.control, config.file);
  refuse_without_watchdog(config);
  if (config.loop.auto_arm && !config.rig.harmless()) {
    throw config::schema::bad_config(config.file + ": [loop] auto_arm",
                                     "is true on a rig that moves something real", "false");
  }
}

std::string never_arms(const DaemonConfig& config) {
  if (!config.drives_valve() || config.rig.harmless()) return "";
  if (config.calibration.empty()) {
    return "no [rig] calibration in " + config.file + ": commission the rig first";
  }
  const std::filesystem::path file = config.folder / config.calibration;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    return "no calibration " + file.string() + ": commission the rig first";
  }
  (void)control::load_calibration(file, config.rig_id);
  return "";
}

std::uint64_t hash(DaemonConfig& config) {
  const std::string text =
      config::schema::print_toml([&](Visitor& v) { config.visit_what_determines_the_data(v); });
  std::uint64_t h = 0xcbf29ce484222325U;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return h;
}

}  // namespace monitor
