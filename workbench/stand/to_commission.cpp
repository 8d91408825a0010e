#include <fmt/format.h>

#include <filesystem>

#include "config/schema/joined.h"
#include "workbench/stand/configuration.h"

namespace workbench::stand {
namespace {

/// Usual values that stand for a choice of the file's maker, not for a number of the rig.
bool is_of_the_rig(const std::string& flag) {
  for (const char* other : {"valve", "runs-as", "model", "pressures", "bus", "rate-Hz",
                            "accept-no-watchdog", "frequency-Hz", "centre-mm", "amplitude-mm"}) {
    if (flag == other) return false;
  }
  return true;
}

/// Numbers that nobody gave.
void unconfirmed(const Answers& a, std::vector<std::string>& steps) {
  std::vector<std::string> flags;
  for (const std::string& flag : a.left_usual) {
    if (is_of_the_rig(flag)) flags.push_back("--" + flag);
  }
  if (flags.empty() || a.sim()) return;
  steps.push_back("confirm what was left at its usual value: " + config::schema::joined(flags));
}

void switches(const Answers& a, std::vector<std::string>& steps) {
  if (a.has_switch("e-stop")) {
    steps.emplace_back("press the e-stop, and pull its wire: status must say LATCHED each time");
  } else {
    steps.emplace_back("no e-stop input: the rig's e-stop must take the energy away by itself");
  }
  if (a.has_switch("enable")) {
    steps.emplace_back("open the enable switch: arming must be refused");
  }
}

void watchdog(const Answers& a, std::vector<std::string>& steps) {
  if (a.number("watchdog-ms") > 0.0) {
    steps.push_back(fmt::format(
        "kill the daemon in RUN (kill -9) at low pressure: the valve must be at null within {:g} ms"
        "{}",
        a.number("watchdog-ms"),
        a.has("watchdog-register") ? "" : "; the time-out is set in the device, not from here"));
  }
  if (a.has_switch("permit")) {
    steps.emplace_back(
        "kill the daemon in RUN (kill -9) at low pressure: the watchdog relay must "
        "drop, and the valve with it");
  }
  if (a.is("accept-no-watchdog", "yes")) {
    steps.emplace_back(
        "no hardware watchdog: the valve keeps its last command when the daemon dies");
  }
}

void sensors(const Answers& a, std::vector<std::string>& steps) {
  if (a.sim()) return;
  if (a.comedi()) {
    steps.emplace_back("measure the edge rate that this machine follows, and set max_edges_per_s");
  }
  if (a.measures_supply()) {
    steps.emplace_back("compare each pressure with a gauge, at rest and at supply pressure");
  }
}

}  // namespace

std::vector<std::string> to_commission(const Answers& a, const std::string& file) {
  const std::string calibration =
      (std::filesystem::path(file).parent_path() / "calibration.toml").string();
  std::vector<std::string> steps;
  unconfirmed(a, steps);
  sensors(a, steps);
  if (!a.sim() && a.driven()) {
    steps.push_back("move the rod by hand or jog it: the position must grow as the rod extends");
    steps.push_back("spoolwatch commission --config " + file + " -o " + calibration +
                    ": signs, null, dead zone, gain, latency");
    switches(a, steps);
    watchdog(a, steps);
    steps.emplace_back("trip each guard once with limits far inside the travel, then set them");
  }
  if (!a.driven()) {
    steps.emplace_back("compare position and command with the other controller's own display");
  }
  if (a.text("model").empty()) {
    steps.emplace_back(
        "a model: spoolwatch new KIND, then compare and fit with a record of this rig");
  }
  steps.emplace_back(
      "fault detection: record healthy motion, then spoolwatch promote or calibrate");
  return steps;
}

}  // namespace workbench::stand
