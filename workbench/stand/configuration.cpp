#include "workbench/stand/configuration.h"

#include <filesystem>

#include "workbench/stand/tables.h"

namespace workbench::stand {
namespace {

namespace fs = std::filesystem;

const char* position_backend(const Answers& a) {
  return a.comedi() ? "encoder" : a.modbus() ? "modbus" : "sim";
}
const char* board_backend(const Answers& a) {
  return a.comedi() ? "comedi" : a.modbus() ? "modbus" : "sim";
}

/// The path as the file's own folder sees it.
std::string from_folder_of(const std::string& file, const std::string& path) {
  const fs::path folder = fs::absolute(file).parent_path();
  std::error_code error;
  const fs::path found = fs::relative(fs::absolute(path), folder, error);
  return error || found.empty() ? fs::absolute(path).string() : found.string();
}

void rig_tables(TomlWriter& w, const Answers& a, const StandFile& file) {
  w.table("rig");
  w.text("id", file.name, "in health messages");
  if (a.driven() && !a.sim()) {
    w.text("calibration", "calibration.toml",
           "written by `spoolwatch commission`; not armed without");
  }
  if (!a.text("model").empty() && !a.sim()) {
    w.table("model");
    w.text("file", from_folder_of(file.file, a.text("model")), "the healthy rig's, for `promote`");
  }
  w.table("loop");
  w.asked("rate_hz", a.number("rate-Hz"), "rate-Hz");
  w.table("rod", "what reads the position");
  w.text("backend", position_backend(a));
  if (a.modbus()) w.text("channel", "position");
}

void valve_table(TomlWriter& w, const Answers& a) {
  if (!a.driven()) {
    w.table("valve", "the controller that is there stays in charge: nothing is written");
    w.text("backend", "none");
    return;
  }
  w.table("valve");
  w.text("backend", board_backend(a));
  w.asked("null_V", a.number("null-V"), "null-V");
  w.asked("limit_V", a.number("limit-V"), "limit-V");
  w.asked("slew_V_per_s", a.number("slew-V-per-s"), "slew-V-per-s");
  if (a.is("accept-no-watchdog", "yes")) {
    w.boolean("accept_no_hardware_watchdog", true, "nothing takes the last command away");
  }
}

void inputs(TomlWriter& w, const Answers& a) {
  const auto input = [&](const char* role, const char* channel, const char* backend,
                         const char* comment) {
    w.item("input", comment);
    w.text("id", role);
    w.text("role", role);
    w.text("backend", backend);
    w.text("channel", channel);
  };
  if (a.sim() || a.has_switch("e-stop")) {
    input("e_stop", "e_stop", position_backend(a), "1 while released, anything else trips");
  }
  if (a.has_switch("enable")) {
    input("enable", "enable", position_backend(a), "1 while motion is allowed");
  }
  if (!a.driven()) input("valve_command", "command", board_backend(a), "the other controller's");
  if (a.measures_supply()) {
    input("supply_pressure", "supply_pressure", board_backend(a), "Pa");
  }
  if (a.measures_chambers()) {
    input("pressure_in", "pressure_in", board_backend(a), "Pa, chamber that extends");
    input("pressure_out", "pressure_out", board_backend(a), "Pa, chamber that retracts");
  }
  if (a.sim() || a.has_switch("permit")) {
    w.table("permit", "toggled by every good period, for a watchdog relay");
    w.text("backend", position_backend(a));
    w.text("channel", "permit");
  }
}

void motion(TomlWriter& w, const Answers& a) {
  if (!a.driven()) return;
  w.table("reference");
  w.text("kind", "sine", "steps, chirp, multisine, triangle, prbs, file");
  w.asked("centre_m", a.number("centre-mm") / 1e3, "centre-mm");
  w.asked("amplitude_m", a.number("amplitude-mm") / 1e3, "amplitude-mm");
  w.asked("frequency_Hz", a.number("frequency-Hz"), "frequency-Hz");
  w.table("controller");
  w.asked("kp_V_per_m", a.number("gain-V-per-m"), "gain-V-per-m");
}

void outputs(TomlWriter& w, const Answers& a) {
  const bool service = a.is("runs-as", "service");
  const std::string folder = service ? "/var/lib/spoolwatch" : ".";
  const auto in = [&](const char* name) { return service ? folder + "/" + name : name; };
  w.table("control");
  w.text("socket", service ? "/run/spoolwatch/control.sock" : "control.sock",
         service ? "" : "SPOOLWATCH_SOCKET names it to the commands");
  w.table("alarms");
  w.text("folder", in("alarms"), "survive a restart; audit.log says who did what");
  w.table("evidence");
  w.text("folder", in("evidence"), "of each alarm, for `spoolwatch replay`");
  w.table("recorder");
  w.text("folder", in("logs"), "the newest 1 GiB; empty: nothing is recorded");
}

}  // namespace

std::string configuration_text(const Answers& answers, const StandFile& file) {
  TomlWriter w(answers.sources);
  w.comment("Configuration of spoolwatchd. Made by:");
  w.comment("  " + file.command);
  w.comment("Beside each number: where it stands. docs/configuration.md explains every key.");
  w.comment("To be commissioned:");
  for (const std::string& step : to_commission(answers, file.file)) w.comment("- " + step);
  Answers placed = answers;
  if (answers.sim()) placed.set("model", from_folder_of(file.file, answers.text("model")));
  std::string head = w.str() + "schema_version = 1\n";
  TomlWriter body(answers.sources);
  rig_tables(body, placed, file);
  valve_table(body, placed);
  inputs(body, placed);
  if (placed.sim()) write_simulated(body, placed);
  if (placed.modbus()) write_modbus(body, placed);
  if (placed.comedi()) write_board(body, placed);
  motion(body, placed);
  write_guards(body, placed);
  outputs(body, placed);
  return head + body.str();
}

}  // namespace workbench::stand
