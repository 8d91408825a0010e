#include "daemon/daemon_config.h"

#include <cmath>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/flat_visitor.h"
#include "config/schema/hash.h"
#include "config/schema/reference.h"
#include "daemon/control/calibration.h"

namespace monitor {
namespace {

using config::schema::FlatField;
using config::schema::FlatTable;
using config::schema::Visitor;

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

}  // namespace

void DaemonConfig::visit_what_determines_the_data(Visitor& v) {
  v.table({"rig", "identity of the rig"}, [this](Visitor& t) {
    t.text({"id", "name in messages"}, rig_id);
    t.path({"calibration", "file written by commissioning; required to arm a real rig"},
           calibration, "calibration.toml");
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
    t.path({"file", "model file that `spoolwatch promote` updates"}, model, "healthy_model.toml");
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
  for (const std::string& assignment : assignments) document.set(assignment);
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
  std::string text;
  for (const FlatTable& table : config::schema::flatten([&](Visitor& v) { config.rig.visit(v); })) {
    // Lists hold auxiliary inputs and outputs, except for the entries of rod and valve.
    bool counts = !table.element && table.name != "permit";
    std::string lines = table.header() + '\n';
    for (const FlatField& field : table.fields) {
      if (field.key == "role") {
        counts = field.value.starts_with("\"rod\"") || field.value.starts_with("\"valve_comm");
      }
      if (field.wiring) lines += field.key + " = " + field.value + '\n';
    }
    if (counts && !table.name.empty()) text += lines;
  }
  return config::schema::hash_text(config::schema::hash_of(text));
}

std::uint64_t hash(DaemonConfig& config) {
  const std::string text =
      config::schema::print_toml([&](Visitor& v) { config.visit_what_determines_the_data(v); });
  return config::schema::hash_of(text);
}

namespace {

std::vector<std::string> backends() {
  std::vector<std::string> found;
  const std::string names = hal::backend_names() + ", ";
  std::size_t at = 0;
  for (std::size_t end = 0; (end = names.find(", ", at)) != std::string::npos; at = end + 2) {
    found.push_back(names.substr(at, end - at));
  }
  return found;
}

}  // namespace

std::string configuration_reference() {
  using config::schema::Visitor;
  std::vector<std::string> or_none = backends();
  or_none.emplace_back("none");
  return "\n## Daemon\n\nRead by `spoolwatchd --config FILE`.\n" +
         config::schema::print_reference([](Visitor& v) { DaemonConfig().visit(v); }, 3,
                                         {{"valve.backend", or_none}, {"backend", backends()}}) +
         "\n## Calibration file\n\nWritten by `spoolwatch commission`, named by `[rig] "
         "calibration`.\n" +
         config::schema::print_reference([](Visitor& v) { control::Calibration().visit(v); });
}

}  // namespace monitor
