#include "workbench/control/alarms_text.h"

#include <fmt/format.h>

#include <cmath>
#include <ostream>
#include <string>

#include "daemon/control/protocol.h"

namespace workbench::control {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& alarm, const char* key) {
  const auto found = alarm.find(key);
  return found != alarm.end() && found->is_string() ? found->get<std::string>() : "";
}

double number_of(const Json& alarm, const char* key) {
  const auto found = alarm.find(key);
  return found != alarm.end() && found->is_number() ? found->get<double>() : std::nan("");
}

bool is_set(const Json& alarm, const char* key) {
  const auto found = alarm.find(key);
  return found != alarm.end() && found->is_boolean() && found->get<bool>();
}

std::string time_left(double time_s) {
  return time_s < 120.0 ? fmt::format("{:.0f} s", std::ceil(time_s))
                        : fmt::format("{:.0f} min", std::ceil(time_s / 60.0));
}

std::string notes_on(const Json& alarm) {
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

void print_alarms(const Json& answer, bool all, std::ostream& out) {
  const auto alarms = answer.find(monitor::control::key::kAlarms);
  std::size_t shown = 0;
  for (const Json& alarm : alarms == answer.end() ? Json::array() : *alarms) {
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

}  // namespace workbench::control
