// Which parts a scorecard has.
#include <algorithm>
#include <cmath>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "workbench/scorecard/trials.h"

namespace workbench::scorecard {
namespace {

config::schema::UsageError not_in_plan(const std::string& what, const std::string& allowed) {
  return config::schema::UsageError(what + ": is not in the plan; allowed: " + allowed);
}

constexpr double kHour_s = 3600.0;

template <class T>
void check(const char* option, const std::vector<std::string>& asked, const std::vector<T>& items) {
  std::vector<std::string> names;
  std::string known;
  for (const T& item : items) {
    names.push_back(item.id);
    known += (known.empty() ? "" : ", ") + item.id;
  }
  for (const std::string& name : asked) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw not_in_plan(std::string(option) + " " + name, known);
  }
}

bool wanted(const std::vector<std::string>& asked, const std::string& id) {
  return asked.empty() || std::find(asked.begin(), asked.end(), id) != asked.end();
}

}  // namespace

std::vector<Part> parts_of(const Bench& bench, const Scope& scope) {
  const Plan& plan = bench.plan;
  check("--motion", scope.motions, plan.motions);
  check("--fault", scope.faults, plan.faults);
  std::vector<std::size_t> motions;
  for (std::size_t m = 0; m < plan.motions.size(); ++m) {
    if (wanted(scope.motions, plan.motions[m].id)) motions.push_back(m);
  }
  std::vector<Part> parts;
  const double record_s = plan.lead_s + 0.5 * plan.phase_s + plan.watch_s;
  for (std::size_t f = 0; f < plan.faults.size(); ++f) {
    const Fault& fault = plan.faults[f];
    if (!wanted(scope.faults, fault.id)) continue;
    for (const int direction : fault.directions()) {
      for (const std::size_t m : motions) {
        const std::string rest =
            fault.id + (direction > 0 ? "/up/" : "/down/") + plan.motions[m].id;
        const double one_s = record_s * static_cast<double>(scope.seeds);
        parts.push_back({Part::Kind::stated, "stated/" + rest, m, f, direction, one_s});
        const std::size_t rungs = fault.sizes(direction).size();
        if (rungs == 0) continue;
        const double tried = 0.7 * std::log2(static_cast<double>(rungs) + 1.0);
        parts.push_back({Part::Kind::ladder, "ladder/" + rest, m, f, direction, tried * one_s});
      }
    }
  }
  const double part_s = plan.part_h * kHour_s;
  const auto add = [&](Part::Kind kind, const std::string& id, std::size_t subject, double hours) {
    const double all = hours / plan.part_h / static_cast<double>(motions.size());
    const auto records = static_cast<std::size_t>(std::ceil(all - 1e-6));
    for (std::size_t i = 0; i < records; ++i) {
      for (const std::size_t m : motions) {
        parts.push_back({kind, id + plan.motions[m].id + "/" + std::to_string(i), m, subject, 1,
                         part_s, static_cast<double>(i) / static_cast<double>(records)});
      }
    }
  };
  for (std::size_t b = 0; b < plan.benign.size(); ++b) {
    add(Part::Kind::benign, "benign/" + plan.benign[b].id + "/", b, plan.benign_h);
  }
  const double planned_h = scope.full ? plan.full_h : plan.healthy_h;
  add(Part::Kind::healthy, "healthy/", 0, scope.hours >= 0.0 ? scope.hours : planned_h);
  return parts;
}

}  // namespace workbench::scorecard
