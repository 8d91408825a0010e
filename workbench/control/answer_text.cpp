#include "workbench/control/answer_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <string_view>

#include "config/units/quantity.h"
#include "daemon/control/protocol.h"

namespace workbench::control {
namespace {

using nlohmann::ordered_json;

std::string text_of(const ordered_json& alarm, const char* key) {
  const auto found = alarm.find(key);
  return found != alarm.end() && found->is_string() ? found->get<std::string>() : "";
}

double number_of(const ordered_json& alarm, const char* key) {
  const auto found = alarm.find(key);
  return found != alarm.end() && found->is_number() ? found->get<double>() : std::nan("");
}

bool is_set(const ordered_json& alarm, const char* key) {
  const auto found = alarm.find(key);
  return found != alarm.end() && found->is_boolean() && found->get<bool>();
}

std::string time_left(double time_s) {
  return time_s < 120.0 ? fmt::format("{:.0f} s", std::ceil(time_s))
                        : fmt::format("{:.0f} min", std::ceil(time_s / 60.0));
}

std::string notes_on(const ordered_json& alarm) {
  std::string notes;
  const auto add = [&notes](const std::string& note) {
    notes += (notes.empty() ? "" : ", ") + note;
  };
  if (is_set(alarm, "first_up")) add("first up");
  if (is_set(alarm, "chattering")) add("chattering");
  const double shelved_for_s = number_of(alarm, "shelved_for_s");
  if (std::isfinite(shelved_for_s)) {
    add("shelved for " + time_left(shelved_for_s) + " by " + text_of(alarm, "shelved_by"));
  }
  const std::string acknowledged_by = text_of(alarm, "acknowledged_by");
  if (!acknowledged_by.empty() && is_set(alarm, "active")) add("seen by " + acknowledged_by);
  const double times = number_of(alarm, "times");
  if (times > 1.0) add(std::to_string(static_cast<long long>(times)) + " times");
  return notes;
}

void print_row(const std::string& life, const std::string& severity, const std::string& name,
               const std::string& came, const std::string& notes, std::ostream& out) {
  std::string whole = fmt::format("{:15} {:8} {:32} {:24} {}", life, severity, name, came, notes);
  whole.erase(whole.find_last_not_of(' ') + 1);
  out << whole << '\n';
}

}  // namespace

void print_alarms(const ordered_json& answer, bool all, std::ostream& out) {
  const auto alarms = answer.find(monitor::control::key::kAlarms);
  std::size_t shown = 0;
  for (const ordered_json& alarm : alarms == answer.end() ? ordered_json::array() : *alarms) {
    const std::string life = text_of(alarm, "life");
    const bool normal = life == "NORMAL";
    if (normal && !all) continue;
    if (shown++ == 0) print_row("STATE", "SEVERITY", "ALARM", "CAME", "", out);
    print_row(life, text_of(alarm, "severity"),
              text_of(alarm, "source") + "." + text_of(alarm, "name"), text_of(alarm, "came"),
              notes_on(alarm), out);
    if (normal) continue;
    const std::string reason = text_of(alarm, "reason");
    if (!reason.empty()) out << "    " << reason << '\n';
    const std::string guidance = text_of(alarm, "guidance");
    if (!guidance.empty()) out << "    do: " << guidance << '\n';
  }
  if (shown == 0) out << "no alarms\n";
}

namespace {

std::string number_of(const ordered_json& object, const char* key, double scale, const char* unit) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return "-";
  return fmt::format("{:.4g}{}", found->get<double>() * scale, unit);
}

/// ": 93.1 bar", what a guard compares with its limit; empty where it reads nothing.
std::string guard_value(const ordered_json& guard) {
  struct Unit {
    std::string_view kind;
    double factor;
    const char* name;
  };
  constexpr std::array kUnits{Unit{"travel", 1e3, " mm"},      Unit{"following", 1e3, " mm"},
                              Unit{"frozen", 1e3, " mm"},      Unit{"jump", 1e3, " mm"},
                              Unit{"disagree", 1e3, " mm"},    Unit{"speed", 1e3, " mm/s"},
                              Unit{"stale", 1e3, " ms"},       Unit{"saturated", 1.0, " V"},
                              Unit{"pressure", 1e-5, " bar"},  Unit{"chambers", 1e-5, " bar"},
                              Unit{"transducer", 1e-5, " bar"}};
  const auto value = guard.find("value");
  if (value == guard.end() || !value->is_number()) return "";
  const std::string kind = text_of(guard, "kind");
  const auto* const unit = std::find_if(kUnits.begin(), kUnits.end(),
                                        [&](const Unit& each) { return each.kind == kind; });
  return unit == kUnits.end() ? ": " + number_of(guard, "value", 1.0, "")
                              : ": " + number_of(guard, "value", unit->factor, unit->name);
}

void print_inputs(const ordered_json& status, const char* key, const char* what, std::ostream& out,
                  double factor = 1.0, const char* unit = "") {
  const auto list = status.find(key);
  if (list == status.end() || !list->is_array()) return;
  for (const ordered_json& entry : *list) {
    // Pressures are those of the roles that have a unit.
    const bool pressure = text_of(entry, "role").find("pressure") != std::string::npos;
    out << "  " << what << ' ' << text_of(entry, "id") << ": "
        << (pressure ? number_of(entry, "value", 1e-5, " bar")
                     : number_of(entry, "value", factor, unit))
        << '\n';
  }
}

/// Prints which of several rod sensors is in charge, and which are out.
void print_rods(const ordered_json& status, std::ostream& out) {
  const auto rods = status.find("rods");
  if (rods == status.end() || !rods->is_array()) {
    return print_inputs(status, "spare_rods", "spare rod", out, 1e3, " mm");
  }
  const std::string in_charge = text_of(status, "rod_in_charge");
  for (const ordered_json& rod : *rods) {
    const std::string id = text_of(rod, "id");
    const std::string fault = text_of(rod, "out");
    out << "  rod sensor " << id << ": " << number_of(rod, "y_m", 1e3, " mm");
    if (id == in_charge) {
      out << ", in charge for " << number_of(status, "rod_in_charge_for_s", 1.0, " s");
    }
    if (!fault.empty()) {
      out << ", out for " << number_of(rod, "out_for_s", 1.0, " s") << ": " << fault;
    }
    out << '\n';
  }
}

/// "disturbed by: force 29.8 N, pressure line 23 Hz, pressure line 99.1 kPa"
std::string disturbance_line(const ordered_json& source) {
  const auto disturbance = source.find("disturbance");
  if (disturbance == source.end() || !disturbance->is_object()) return {};
  std::string line;
  for (const auto& [name, value] : disturbance->items()) {
    if (!value.is_number()) continue;
    line += (line.empty() ? "disturbed by: " : ", ") + config::units::parameter_words(name) + ' ' +
            config::units::words(config::units::quantity(name, value.get<double>(), NAN));
  }
  return line;
}

}  // namespace

std::vector<DetectableLines> detectable_lines(const ordered_json& status) {
  std::vector<DetectableLines> lines;
  const auto sources = status.find("detectable");
  if (sources == status.end() || !sources->is_array()) return lines;
  for (const ordered_json& source : *sources) {
    DetectableLines one{text_of(source, "source") + " would detect now:", {}};
    const char* before = " ";
    for (const auto& [name, smallest] : source.at("smallest").items()) {
      one.smallest +=
          before + config::units::parameter_words(name) + ' ' +
          (smallest.is_number()
               ? config::units::words(config::units::quantity(name, smallest.get<double>(), NAN))
               : "not known");
      before = ", ";
    }
    for (const std::string& more : {text_of(source, "why"), disturbance_line(source)}) {
      if (!more.empty()) one.more.push_back(more);
    }
    lines.push_back(std::move(one));
  }
  return lines;
}

void print_status(const ordered_json& status, std::ostream& out) {
  out << text_of(status, "rig_id") << ": " << text_of(status, "state");
  if (is_set(status, "holding")) out << ", holding: start resumes";
  if (is_set(status, "ramping")) out << ", on the way to null";
  const std::string latched_by = text_of(status, "latched_by");
  if (!latched_by.empty()) out << " by " << latched_by;
  const std::string because = text_of(status, "latched_because");
  if (!because.empty()) out << ": " << because << "; spoolwatch reset leads out of it";
  out << '\n';
  const std::string obstacle = text_of(status, "obstacle");
  if (!obstacle.empty()) out << "  cannot be armed: " << obstacle << '\n';
  const std::string refused = text_of(status, "reload_refused");
  if (!refused.empty()) out << "  the old configuration remains active: " << refused << '\n';
  out << "  rod " << number_of(status, "y_m", 1e3, " mm") << ", reference "
      << number_of(status, "reference_m", 1e3, " mm") << ", valve "
      << number_of(status, "u_V", 1.0, " V") << '\n';
  print_rods(status, out);
  print_inputs(status, "inputs", "input", out);
  for (const DetectableLines& source : detectable_lines(status)) {
    out << "  " << source.smallest << '\n';
    for (const std::string& more : source.more) out << "    " << more << '\n';
  }
  const auto alarms = status.find("active_alarms");
  if (alarms != status.end() && alarms->is_number_integer() && alarms->get<long long>() > 0) {
    const auto count = alarms->get<long long>();
    out << "  " << count << (count == 1 ? " alarm is" : " alarms are")
        << " active: spoolwatch alarms\n";
  }
  const auto guards = status.find("guards");
  if (guards == status.end() || !guards->is_array()) return;
  for (const ordered_json& guard : *guards) {
    if (!is_set(guard, "active")) continue;
    out << "  guard " << text_of(guard, "id") << " (" << text_of(guard, "kind") << ", "
        << text_of(guard, "action") << ") is active" << guard_value(guard) << '\n';
  }
}

}  // namespace workbench::control
