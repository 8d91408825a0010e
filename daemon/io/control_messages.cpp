#include "daemon/io/control_messages.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "daemon/control/protocol.h"
#include "daemon/io/audit.h"

namespace monitor::io {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using Kind = ControlRequest::Kind;

constexpr double kFarthest_m = 100.0;
constexpr double kFastest_Hz = 1000.0;
constexpr double kLongestShelf_s = 7.0 * 86400.0;
constexpr std::size_t kLongestName = 256;
constexpr std::size_t kLongestShown = 40;

ControlRequest bad(const std::string& why) {
  ControlRequest request;
  request.wrong = why;
  return request;
}

/// "" or what is wrong with the number.
std::string read_number(const json& object, const char* key, double low, double high,
                        double& value) {
  const auto found = object.find(key);
  if (found == object.end()) return std::string(key) + ": is missing";
  value = found->is_number() ? found->get<double>() : std::nan("");
  if (value >= low && value <= high) return "";
  return std::string(key) + ": is " + found->dump().substr(0, 40) + "; allowed: a number from " +
         json(low).dump() + " to " + json(high).dump();
}

ControlRequest parse_sine(const json& object) {
  ControlRequest request;
  for (const std::string& wrong :
       {read_number(object, control::key::kCentre, -kFarthest_m, kFarthest_m, request.centre_m),
        read_number(object, control::key::kAmplitude, 0.0, kFarthest_m, request.amplitude_m),
        read_number(object, control::key::kFrequency, 0.0, kFastest_Hz, request.frequency_Hz)}) {
    if (!wrong.empty()) return bad(wrong);
  }
  request.kind = Kind::sine;
  return request;
}

/// `needs`: a name must be given.
ControlRequest parse_alarm(const json& object, Kind kind, bool needs) {
  ControlRequest request;
  request.kind = kind;
  const auto found = object.find(control::key::kAlarm);
  if (found == object.end() && needs) return bad("alarm: is missing");
  if (found != object.end()) {
    if (!found->is_string() || found->get_ref<const std::string&>().size() > kLongestName ||
        found->get_ref<const std::string&>().empty()) {
      return bad("alarm: is " + found->dump().substr(0, 40) + "; allowed: \"SOURCE.NAME\"");
    }
    request.alarm = *found;
  }
  if (kind != Kind::shelve) return request;
  const std::string wrong =
      read_number(object, control::key::kTime, 0.0, kLongestShelf_s, request.time_s);
  return wrong.empty() ? request : bad(wrong);
}

/// NaN as null.
json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

ordered_json inputs_of(const std::vector<ControlStatus::Input>& inputs) {
  ordered_json list = ordered_json::array();
  for (const auto& input : inputs) {
    list.push_back({{"id", input.id}, {"value", number(input.value)}});
    if (!input.role.empty()) list.back()["role"] = input.role;
  }
  return list;
}

ordered_json detectable_of(const ControlStatus& status) {
  ordered_json list = ordered_json::array();
  for (const Detectable& source : status.detectable) {
    ordered_json smallest = ordered_json::object();
    for (const auto& change : source.changes) smallest[change.name] = number(change.smallest);
    const double age_s = static_cast<double>(status.ticks - source.tick) * status.sample_time_s;
    list.push_back({{"source", source.source},
                    {"age_s", number(age_s)},
                    {"smallest", std::move(smallest)},
                    {"why", source.why.empty() ? json(nullptr) : json(source.why)}});
    for (const auto& [name, value] : source.disturbance) {
      list.back()["disturbance"][name] = number(value);
    }
  }
  return list;
}

}  // namespace

ControlRequest parse_request(const std::string& line) {
  std::set<std::string> keys;
  std::string twice;
  const auto watch_keys = [&](int depth, json::parse_event_t event, json& key) {
    if (event == json::parse_event_t::key && depth == 1 &&
        !keys.insert(key.get_ref<const std::string&>()).second) {
      twice = key;
    }
    return true;
  };
  const json object = json::parse(line, watch_keys, false);
  if (!object.is_object()) return bad("not a JSON object");
  if (!twice.empty()) return bad("\"" + twice.substr(0, kLongestShown) + "\" comes twice");
  const auto name = object.find(control::key::kCommand);
  if (name == object.end() || !name->is_string()) return bad("no \"command\"");
  const auto& command = name->get_ref<const std::string&>();
  ControlRequest request;
  if (command == control::kReference) return parse_sine(object);
  if (command == control::kAcknowledge) return parse_alarm(object, Kind::acknowledge, false);
  if (command == control::kShelve) return parse_alarm(object, Kind::shelve, true);
  if (command == control::kUnshelve) return parse_alarm(object, Kind::unshelve, true);
  if (command == control::kStatus) {
    request.kind = Kind::status;
  } else if (command == control::kHold) {
    request.kind = Kind::hold;
  } else if (command == control::kAlarms) {
    request.kind = Kind::alarms;
  } else if (command == control::kReload) {
    request.kind = Kind::reload;
  } else if (command == control::kNote) {
    const auto text = object.find(control::key::kText);
    if (text == object.end() || !text->is_string()) return bad("text: is missing");
    request.kind = Kind::note;
  }
  std::string known = std::string(control::kStatus) + ", " + control::kHold + ", " +
                      control::kReference + ", " + control::kAlarms + ", " + control::kAcknowledge +
                      ", " + control::kShelve + ", " + control::kUnshelve + ", " +
                      control::kReload + ", " + control::kNote;
  for (const control::EventName& entry : control::kEventCommands) {
    known += std::string(", ") + entry.name;
    if (command != entry.name) continue;
    request.kind = Kind::event;
    request.event = entry.event;
  }
  if (request.kind == Kind::bad) request.wrong = "unknown command; allowed: " + known;
  return request;
}

std::string print_status(const ControlStatus& status) {
  ordered_json line;
  line[control::key::kOk] = true;
  line[control::key::kState] = control::to_string(status.state);
  line["rig_id"] = status.rig_id;
  line["config_hash"] = status.config_hash;
  line["holding"] = status.holding;
  line["ramping"] = status.ramping;
  line["latched_by"] = status.latched_by.empty() ? json(nullptr) : json(status.latched_by);
  line["latched_because"] =
      status.latched_because.empty() ? json(nullptr) : json(status.latched_because);
  line["obstacle"] = status.obstacle.empty() ? json(nullptr) : json(status.obstacle);
  line["config_file"] = status.config_file;
  line["recorder_folder"] = status.recorder_folder;
  line["alarm_folder"] = status.alarm_folder;
  line["rules_hash"] = status.rules_hash;
  line["sample_time_s"] = number(status.sample_time_s);
  line["reload_refused"] =
      status.reload_refused.empty() ? json(nullptr) : json(status.reload_refused);
  line["y_m"] = number(status.y_m);
  line["reference_m"] = number(status.reference_m);
  line["u_V"] = number(status.u_V);
  line["ticks"] = status.ticks;
  line["overruns"] = status.overruns;
  line["active_alarms"] = status.active_alarms;
  ordered_json guards = ordered_json::array();
  for (const auto& guard : status.guards) {
    guards.push_back({{"id", guard.id},
                      {"kind", guard.kind},
                      {"action", guard.action},
                      {"active", guard.active},
                      {"value", number(guard.value)}});
  }
  line["guards"] = std::move(guards);
  if (!status.rods.empty()) {
    ordered_json rods = ordered_json::array();
    for (const auto& rod : status.rods) {
      rods.push_back({{"id", rod.id},
                      {"y_m", number(rod.y_m)},
                      {"out", rod.fault.empty() ? json(nullptr) : json(rod.fault)},
                      {"out_for_s", rod.fault.empty() ? json(nullptr) : number(rod.for_s)}});
    }
    line["rods"] = std::move(rods);
    line["rod_in_charge"] = status.rod_in_charge;
    line["rod_in_charge_for_s"] = number(status.rod_in_charge_for_s);
  }
  line["spare_rods"] = inputs_of(status.spare_rods);
  line["inputs"] = inputs_of(status.inputs);
  line["detectable"] = detectable_of(status);
  return line.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string print_alarms(control::ArmingState state, const std::vector<ControlAlarm>& alarms) {
  ordered_json line;
  line[control::key::kOk] = true;
  line[control::key::kState] = control::to_string(state);
  ordered_json list = ordered_json::array();
  for (const auto& [alarm, shelved_for_s] : alarms) {
    list.push_back({{"source", alarm.source},
                    {"name", alarm.name},
                    {"life", estimator::fdi::to_string(alarm.state())},
                    {"severity", estimator::fdi::to_string(alarm.severity)},
                    {"active", alarm.active},
                    {"acknowledged", alarm.acknowledged},
                    {"latched", alarm.latched},
                    {"first_up", alarm.first_up},
                    {"chattering", alarm.chattering},
                    {"shelved_for_s", alarm.shelved ? json(shelved_for_s) : json(nullptr)},
                    {"shelved_by", alarm.shelved_by},
                    {"acknowledged_by", alarm.acknowledged_by},
                    {"came", alarm.times > 0 ? json(utc_text(alarm.came_utc_us)) : json(nullptr)},
                    {"times", alarm.times},
                    {"tick", alarm.tick},
                    {"quantity", alarm.quantity},
                    {"value", number(alarm.value)},
                    {"low", number(alarm.low)},
                    {"high", number(alarm.high)},
                    {"parameter", alarm.parameter},
                    {"reason", alarm.reason},
                    {"guidance", alarm.guidance}});
  }
  line[control::key::kAlarms] = std::move(list);
  return line.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string print_acted(control::ArmingState state, const std::vector<std::string>& done) {
  ordered_json line;
  line[control::key::kOk] = true;
  line[control::key::kState] = control::to_string(state);
  line[control::key::kDone] = done;
  return line.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string print_reloaded(control::ArmingState state, const ControlReload& reload) {
  ordered_json line;
  line[control::key::kOk] = true;
  line[control::key::kState] = control::to_string(state);
  line["config_hash"] = reload.config_hash;
  line["changed"] = reload.changed;
  line["warm"] = reload.warm;
  line["cold"] = reload.cold;
  line["ended"] = reload.ended;
  return line.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string print_done(control::ArmingState state) {
  ordered_json line;
  line[control::key::kOk] = true;
  line[control::key::kState] = control::to_string(state);
  return line.dump();
}

std::string print_rejected(control::ArmingState state, const std::string& reason) {
  ordered_json line;
  line[control::key::kOk] = false;
  line[control::key::kState] = control::to_string(state);
  line[control::key::kReason] = reason;
  return line.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace monitor::io
