#include "workbench/scorecard/plan.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "workbench/scorecard/shipped.h"
#include "workbench/scorecard/trials.h"

namespace workbench::scorecard {
namespace {

using config::schema::bad_config;
using config::schema::Document;
using config::schema::Visitor;

constexpr double kDay_s = 86400.0;
constexpr double kLeastLeft = 0.05;  ///< least rest of a parameter that falls

template <class T>
void check_ids(const std::vector<T>& items, const std::string& where) {
  std::set<std::string> seen;
  for (const T& item : items) {
    if (item.id.empty() || item.id.find('/') != std::string::npos || !seen.insert(item.id).second) {
      throw bad_config(where + " id", "'" + item.id + "' is empty, has a / or is there twice",
                       "a unique name");
    }
  }
}

void check(const Plan& plan, const std::string& file) {
  check_ids(plan.motions, file + ": [[motion]]");
  check_ids(plan.faults, file + ": [[fault]]");
  check_ids(plan.benign, file + ": [[benign]]");
  if (plan.motions.empty()) throw bad_config(file, "has no [[motion]]", "one or more");
  for (const Fault& fault : plan.faults) {
    const std::string where = file + ": [[fault]] " + fault.id;
    if (fault.parameter.empty() == fault.sensor.empty()) {
      throw bad_config(where, "needs one of parameter and sensor");
    }
    if (fault.least > fault.greatest) throw bad_config(where + ": least", "is above greatest");
  }
}

}  // namespace

void Motion::visit(Visitor& v) {
  v.text({"id", "name in the results", true}, id);
  reference.visit(v);
}

void Fault::visit(Visitor& v) {
  v.text({"id", "name in the results", true}, id);
  v.text({"parameter", "parameter of the model"}, parameter);
  v.text({"sensor", "offset, drift, scale or freeze"}, sensor);
  v.choice({"how", "ratio: old (1 +- size); value: +-size"}, how, {"ratio", "value"});
  v.choice({"direction", "direction of the change"}, direction, {"up", "down", "both"});
  v.text({"unit", "unit of the sizes in the results"}, unit);
  v.number({"per_unit", "SI, or a ratio, of one unit"}, per_unit, {1e-18, 1e6});
  v.number({"stated", "size at which delay and names are judged; 0: it has no size"}, stated,
           {0.0, 1e9});
  v.number({"least", "smallest size tried"}, least, {0.0, 1e9});
  v.number({"greatest", "greatest size tried"}, greatest, {0.0, 1e9});
  v.texts({"names", "names that alarms may use for it; empty: the parameter"}, names);
  if (names.empty() && !parameter.empty()) names = {parameter};
}

std::vector<int> Fault::directions() const {
  if (direction == "up") return {1};
  if (direction == "down") return {-1};
  return {1, -1};
}

std::vector<double> Fault::sizes(int sign) const {
  std::vector<double> out;
  if (!(least > 0.0)) return out;
  const bool falls = sign < 0 && sensor.empty() && how == "ratio";
  constexpr double kSlack = 1e-9;
  for (int decade = static_cast<int>(std::floor(std::log10(least)));; ++decade) {
    for (const double step : {1.0, 1.5, 2.0, 3.0, 5.0, 7.0}) {
      const double size = step * std::pow(10.0, decade);
      if (size > greatest * (1.0 + kSlack)) return out;
      if (falls && size * per_unit > 1.0 - kLeastLeft) return out;
      if (size >= least * (1.0 - kSlack)) out.push_back(size);
    }
  }
}

void Benign::visit(Visitor& v) {
  v.text({"id", "name in the results", true}, id);
  v.text({"what", "description"}, what);
  v.text({"parameter", "parameter of the model; empty: none changes"}, parameter);
  v.number({"factor", "factor on its value"}, factor, {1e-3, 1e3});
  v.number({"ramp_s", "duration of the change; 0: present from the start"}, ramp_s, {0.0, kDay_s});
  v.number({"amplitude_ratio", "ratio to the motion's amplitude"}, amplitude_ratio, {0.0, 10.0});
  v.number({"frequency_ratio", "ratio to the motion's speed"}, frequency_ratio, {1e-2, 10.0});
}

void Plan::visit(Visitor& v) {
  v.text({"model", "model of the rig, relative to this file's folder", true}, model);
  v.number({"lead_s", "healthy, before the earliest fault"}, lead_s, {1.0, kDay_s});
  v.number({"phase_s", "the fault starts at a random time within"}, phase_s, {0.0, kDay_s});
  v.number({"watch_s", "time to detect it"}, watch_s, {0.1, kDay_s});
  v.number({"training_s", "healthy record that methods learn from"}, training_s, {10.0, kDay_s});
  v.number({"healthy_h", "hours without a fault, over all motions"}, healthy_h, {0.0, 1e4});
  v.number({"full_h", "the same, of a full run"}, full_h, {0.0, 1e4});
  v.number({"benign_h", "hours of each benign change, over all motions"}, benign_h, {0.0, 1e4});
  v.number({"part_h", "length of one healthy record"}, part_h, {1e-3, 24.0});
  v.table({"instruments", "encoder, noise and D/A converter"},
          [&](Visitor& t) { instruments.visit(t); });
  visit_list(v, {"motion", "motions"}, motions);
  visit_list(v, {"fault", "faults"}, faults);
  visit_list(v, {"benign", "changes that are no faults"}, benign);
}

Bench load_bench(const std::string& file) {
  namespace fs = std::filesystem;
  Bench bench;
  const std::string name = file.empty() ? "plan.toml" : file;
  const Document document =
      file.empty() ? Document::parse(*shipped_text(name), name) : Document::load(file);
  document.read([&](Visitor& v) { bench.plan.visit(v); });
  check(bench.plan, name);
  const fs::path model = bench.plan.model;
  const auto shipped = file.empty() ? shipped_text(model.filename().string()) : std::nullopt;
  const Document rig = shipped ? Document::parse(*shipped, model.filename().string())
                               : Document::load(document.folder() / model);
  bench.healthy = simulate::read_scenario(rig);
  bench.healthy.instruments = bench.plan.instruments;
  for (Motion& motion : bench.plan.motions) {
    static_cast<void>(make_reference(motion.reference, document.folder()));
  }
  bench.healthy.folder = document.folder();
  bench.text = config::schema::print_toml([&](Visitor& v) { bench.plan.visit(v); }) +
               plant_sim::print_model(bench.healthy.model);
  return bench;
}

namespace {

config::schema::UsageError not_in_plan(const std::string& what, const std::string& allowed) {
  return config::schema::UsageError(what + ": is not in the plan; allowed: " + allowed);
}

template <class T>
void check(const char* option, const std::vector<std::string>& asked, const std::vector<T>& items) {
  std::vector<std::string> names;
  for (const T& item : items) names.push_back(item.id);
  for (const std::string& name : asked) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw not_in_plan(std::string(option) + " " + name, config::schema::joined(names));
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
