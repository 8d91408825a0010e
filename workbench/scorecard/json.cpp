// A scorecard as JSON.

#include "workbench/present/json.h"
#include "workbench/scorecard/card.h"
#include "workbench/scorecard/statistics.h"

namespace workbench::scorecard {
namespace {

using nlohmann::json;
using present::number_or_null;

json quiet_json(const QuietFigures& q) {
  const double time_s = 3600.0 * q.hours;
  return {{"hours", q.hours},
          {"alarms", q.counted.alarms},
          {"per_hour", number_or_null(q.per_hour())},
          {"per_hour_upper_95", number_or_null(q.per_hour_upper())},
          {"alarm_ratio", number_or_null(q.counted.alarm_s / time_s)},
          {"invalid_ratio", number_or_null(q.counted.invalid_s / time_s)}};
}

json fault_json(const FaultFigures& of) {
  json smallest = json::object();
  json verdicts = json::object();
  for (const FaultDetection& found : of.found) {
    if (found.searched) {
      smallest[found.motion][found.direction > 0 ? "up" : "down"] =
          found.smallest ? json(*found.smallest) : json(nullptr);
    }
    for (const auto& [verdict, count] : found.verdicts) {
      verdicts[verdict] = verdicts.value(verdict, 0) + count;
    }
  }
  const std::vector<double> delays_s = of.delays_s();
  return {{"fault", of.fault->id},
          {"unit", of.fault->unit},
          {"stated", of.fault->stated},
          {"smallest", smallest},
          {"delay_s",
           {{"median", number_or_null(quantile(delays_s, 0.5))},
            {"p95", number_or_null(quantile(delays_s, kDetected))}}},
          {"trials", of.trials()},
          {"verdicts", verdicts}};
}

json split(const std::string& names) {
  json out = json::array();
  std::size_t from = 0;
  while (from <= names.size() && !names.empty()) {
    const std::size_t bar = std::min(names.find('|', from), names.size());
    out.push_back(names.substr(from, bar - from));
    from = bar + 1;
  }
  return out;
}

json method_json(const MethodFigures& method) {
  json out = {{"name", method.name},
              {"what", method.what},
              {"load_ratio", number_or_null(method.load_ratio)},
              {"healthy", quiet_json(method.healthy)},
              {"healthy_motions", json::object()},
              {"benign", json::object()},
              {"unusable", method.unusable},
              {"faults", json::array()},
              {"matrix", json::object()},
              {"ambiguity_sets", json::array()}};
  for (const auto& [motion, q] : method.healthy_of) out["healthy_motions"][motion] = quiet_json(q);
  for (const auto& [change, q] : method.benign) out["benign"][change] = quiet_json(q);
  std::map<std::string, json> sets;
  for (const FaultFigures& of : method.faults) {
    out["faults"].push_back(fault_json(of));
    json& row = out["matrix"][of.fault->id] = of.first;
    row["missed"] = of.verdict(TrialVerdict::missed);
    row["standing"] = of.verdict(TrialVerdict::standing);
    for (const auto& [names, count] : of.first) {
      if (names.find('|') != std::string::npos) sets[names][of.fault->id] = count;
    }
  }
  for (const auto& [names, faults] : sets) {
    out["ambiguity_sets"].push_back({{"names", split(names)}, {"faults", faults}});
  }
  return out;
}

}  // namespace

std::string to_json(const Card& card) {
  json out = {{"schema_version", 1},         {"complete", card.done == card.parts},
              {"parts", card.parts},         {"done", card.done},
              {"seeds", card.seeds},         {"watch_s", card.watch_s},
              {"runtime_s", card.runtime_s}, {"motions", card.motions},
              {"methods", json::array()}};
  for (const MethodFigures& method : card.methods) out["methods"].push_back(method_json(method));
  return out.dump(1) + "\n";
}

}  // namespace workbench::scorecard
