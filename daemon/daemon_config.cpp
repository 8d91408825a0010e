#include "daemon/daemon_config.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/hash.h"
#include "daemon/control/calibration.h"

namespace monitor {
namespace {

using config::schema::Visitor;

/// Keys whose values are paths relative to the configuration's folder.
constexpr const char* kPathKeys[] = {
    "sim.model",      "replay.record",   "reference.file", "bands_file",      "recorder.folder",
    "control.socket", "rig.calibration", "alarms.folder",  "evidence.folder", "model.file"};

/// Keys that define the wiring and the signals of valve and rod sensors.
constexpr const char* kWiringKeys[] = {
    "backend", "channel",      "address",          "function",    "type",      "order", "scale",
    "offset",  "sign",         "polarity",         "scale_ratio", "offset_V",  "mode",  "line_a",
    "line_b",  "resolution_m", "counts_per_metre", "range",       "subdevice", "role",  "unit"};

/// Throws when the valve would keep its last command after the daemon's death and nothing else
/// commands null.
void refuse_without_watchdog(const DaemonConfig& config) {
  const bool covered = config.rig.harmless() || config.rig.has_permit() ||
                       std::isfinite(config.rig.null_times().process_dead_s) ||
                       config.rig.valve().accept_no_hardware_watchdog;
  if (config.drives_valve() && !covered) {
    throw config::schema::bad_config(
        config.file + ": [valve] backend",
        "is \"" + config.rig.valve().backend +
            "\", which keeps its last command when this process dies",
        "a device with a command time-out, a [permit] output for a watchdog relay, or "
        "[valve] accept_no_hardware_watchdog = true");
  }
}

/// Makes the value of a "key=value" assignment absolute where the key names a file.
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
  v.table({"rig", "identity of the rig"}, [this](Visitor& t) {
    t.text({"id", "name in messages"}, rig_id);
    t.text({"calibration", "file written by commissioning; required to arm a real rig"},
           calibration);
  });
  v.table({"loop", "the control loop"}, [this](Visitor& t) { loop.visit(t); });
  rig.visit(v);
  if (drives_valve()) {
    v.table({"reference", "reference signal"}, [this](Visitor& t) { reference.visit(t); });
    v.table({"controller", "position controller"}, [this](Visitor& t) { controller.visit(t); });
  }
  safety.visit(v);
  pipeline.visit(v);
}

void DaemonConfig::visit(Visitor& v) {
  visit_what_determines_the_data(v);
  v.table({"model", "physical model of the healthy rig"}, [this](Visitor& t) {
    t.text({"file", "model file that `spoolwatch promote` updates"}, model);
  });
  v.table({"control", "access over the control socket"}, [this](Visitor& t) { control.visit(t); });
  v.table({"alarms", "persistence, audit and rules of alarms"},
          [this](Visitor& t) { alarms.visit(t); });
  v.table({"evidence", "evidence folders, one per alarm"},
          [this](Visitor& t) { evidence.visit(t); });
  v.table({"lcm", "LCM output"}, [this](Visitor& t) { lcm.visit(t); });
  v.table({"recorder", "LCM event logs"}, [this](Visitor& t) { recorder.visit(t); });
}

void load(const std::filesystem::path& file, const std::vector<std::string>& assignments,
          DaemonConfig& config) {
  config::schema::Document document = config::schema::Document::load(file);
  for (const std::string& assignment : assignments) document.set(from_here(assignment));
  document.read([&](Visitor& v) { config.visit(v); });
  config.file = document.name();
  config.folder = document.folder();
  for (std::string* path : {&config.recorder.folder, &config.control.socket, &config.alarms.folder,
                            &config.evidence.folder}) {
    if (!path->empty()) *path = (config.folder / *path).string();
  }
  io::check_control(config.control, config.file);
  refuse_without_watchdog(config);
  if (config.loop.auto_arm && !config.rig.harmless()) {
    throw config::schema::bad_config(config.file + ": [loop] auto_arm",
                                     "is true on a rig with real devices", "false");
  }
}

std::string never_arms(DaemonConfig& config) {
  if (!config.drives_valve() || config.rig.harmless()) return "";
  if (config.calibration.empty()) {
    return "no [rig] calibration in " + config.file + ": commission the rig first";
  }
  const std::filesystem::path file = config.folder / config.calibration;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    return "no calibration " + file.string() + ": commission the rig first";
  }
  const std::string against =
      control::contradiction(control::load_calibration(file, config.rig_id),
                             config.rig.valve().null_V, config.rig.valve().limit_V, wiring(config));
  return against.empty() ? "" : "calibration " + file.string() + ": " + against;
}

std::string wiring(DaemonConfig& config) {
  std::istringstream lines(config::schema::print_toml([&](Visitor& v) { config.rig.visit(v); }));
  std::string text;   // all tables that count
  std::string table;  // relevant lines of the current table
  bool counts = false;
  const auto finish_table = [&] {
    if (counts) text += table;
    table.clear();
  };
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('[')) {
      finish_table();
      // Lists hold auxiliary inputs and outputs.
      counts = !line.starts_with("[[") && line != "[permit]";
      table = line + '\n';
      continue;
    }
    const std::string key = line.substr(0, line.find(' '));
    const std::string value = line.substr(std::min(line.size(), line.find('=') + 2));
    if (key == "role") counts = value.starts_with("\"rod\"") || value.starts_with("\"valve_comm");
    const bool address_of_a_device = key == "address" && value.starts_with('"');
    if (std::find(std::begin(kWiringKeys), std::end(kWiringKeys), key) != std::end(kWiringKeys) &&
        !address_of_a_device) {
      table += line + '\n';
    }
  }
  finish_table();
  return config::schema::hash_text(config::schema::hash_of(text));
}

std::uint64_t hash(DaemonConfig& config) {
  const std::string text =
      config::schema::print_toml([&](Visitor& v) { config.visit_what_determines_the_data(v); });
  return config::schema::hash_of(text);
}

}  // namespace monitor
