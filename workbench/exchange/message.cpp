#include "workbench/exchange/message.h"

#include <algorithm>

#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/pressures_t.hpp"
#include "spoolwatch/rods_t.hpp"
#include "spoolwatch/sample_t.hpp"
#include "workbench/live/listen_lines.h"

namespace workbench::exchange {
namespace {

/// One level of a topic: a slash in a name would be another level.
std::string level(std::string name) {
  std::replace(name.begin(), name.end(), '/', '_');
  return name.empty() ? "_" : name;
}

std::int64_t ns(std::int64_t utc_us) {
  constexpr std::int64_t kLatest_us = INT64_MAX / 1000;
  return std::clamp<std::int64_t>(utc_us, 0, kLatest_us) * 1000;
}

}  // namespace

const std::vector<std::string>& all_kinds() {
  static const std::vector<std::string> kAll = [] {
    std::vector<std::string> all;
    for (const auto kind : config::messages::kMessageKinds) all.emplace_back(to_string(kind));
    return all;
  }();
  return kAll;
}

Message to_message(const spoolwatch::rods_t& r) {
  const auto in_charge = static_cast<std::size_t>(r.in_charge);
  Message message{"rods",
                  "rods",
                  ns(r.utc_us),
                  {{"y_m", in_charge < r.y_m.size() ? Tree(r.y_m[in_charge]) : Tree()},
                   {"in_charge", in_charge < r.rod.size() ? r.rod[in_charge] : ""},
                   {"changed", r.changed != 0},
                   {"since_tick", r.since_tick},
                   {"tick", r.tick}}};
  Tree& rods = message.values["rod"];
  for (std::size_t i = 0; i < r.rod.size(); ++i) {
    rods[r.rod[i]] = {{"y_m", r.y_m[i]}, {"quality", r.quality[i]}, {"fault", r.fault[i]}};
  }
  return message;
}

Message to_message(const spoolwatch::pressures_t& p) {
  return {"pressures",
          "pressures",
          ns(p.utc_us),
          {{"supply_pressure_Pa", p.supply_Pa},
           {"pressure_in_Pa", p.in_Pa},
           {"pressure_out_Pa", p.out_Pa},
           {"tick", p.tick}}};
}

Message to_message(const spoolwatch::sample_t& s) {
  return {"sample",
          "sample",
          ns(s.utc_us),
          {{"y_m", s.y_m},
           {"reference_m", s.reference_m},
           {"u_applied_V", s.u_applied_V},
           {"u_requested_V", s.u_requested_V},
           {"quality", s.quality},
           {"state", s.state},
           {"saturated", s.saturated != 0},
           {"gap", s.gap},
           {"tick", s.tick},
           {"sample_time_s", s.sample_time_s}}};
}

Message to_message(const spoolwatch::estimate_t& e) {
  Message message{"estimate",
                  "estimate/" + level(e.source),
                  ns(e.utc_us),
                  {{"valid", e.valid != 0},
                   {"reason", e.reason},
                   {"condition_number", e.condition},
                   {"tick", e.tick}}};
  for (std::size_t i = 0; i < e.name.size(); ++i) {
    message.values[e.name[i]] = {{"value", e.value[i]},
                                 {"std_error", e.std_error[i]},
                                 {"low", e.low[i]},
                                 {"high", e.high[i]}};
  }
  return message;
}

Message to_message(const spoolwatch::alarm_t& a) {
  return {"alarm",
          "alarm/" + level(a.source) + "/" + level(a.name),
          ns(a.utc_us),
          {{"active", a.active != 0},
           {"severity", a.severity},
           {"severity_text", live::severity_text(a.severity)},
           {"repeat", a.repeat != 0},
           {"latched", a.latched != 0},
           {"acknowledged", a.acknowledged != 0},
           {"shelved", a.shelved != 0},
           {"first_up", a.first_up != 0},
           {"quantity", a.quantity},
           {"value", a.value},
           {"std_error", a.std_error},
           {"low", a.low},
           {"high", a.high},
           {"direction", a.direction},
           {"parameter", a.parameter},
           {"parameter_direction", a.parameter_direction},
           {"confidence", a.confidence},
           {"tick", a.tick},
           {"reason", a.reason},
           {"guidance", a.guidance}}};
}

Message to_message(const spoolwatch::health_t& h) {
  Message message{"health",
                  "health",
                  ns(h.utc_us),
                  {{"state", h.state},
                   {"ticks", h.ticks},
                   {"overruns", h.overruns},
                   {"skipped_periods", h.skipped_periods},
                   {"dropped_samples", h.dropped_samples},
                   {"dropped_records", h.dropped_records},
                   {"lost_records", h.lost_records},
                   {"lateness_p50_us", h.lateness_p50_us},
                   {"lateness_p999_us", h.lateness_p999_us},
                   {"lateness_max_us", h.lateness_max_us},
                   {"read_p999_us", h.read_p999_us},
                   {"control_p999_us", h.control_p999_us},
                   {"write_p999_us", h.write_p999_us},
                   {"active_alarms", h.active_alarms},
                   {"rig_id", h.rig_id},
                   {"config_hash", h.config_hash}}};
  for (std::size_t i = 0; i < h.device.size(); ++i) {
    message.values["device"][h.device[i]] = {{"good", h.device_good[i]}, {"bad", h.device_bad[i]}};
  }
  return message;
}

Tree with_timestamp(const Message& message) {
  Tree tree;
  tree["timestamp"] = static_cast<double>(message.t_ns) / 1e9;
  Tree* place = &tree;
  std::string_view rest = message.topic;
  while (!rest.empty()) {
    const std::size_t slash = rest.find('/');
    place = &(*place)[std::string(rest.substr(0, slash))];
    rest.remove_prefix(slash == std::string_view::npos ? rest.size() : slash + 1);
  }
  *place = message.values;
  return tree;
}

std::string text_of(const Tree& tree) {
  return tree.dump(-1, ' ', false, Tree::error_handler_t::replace);
}

}  // namespace workbench::exchange
