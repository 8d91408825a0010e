// Records of the independent truth generator, tracked as the command does it.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "estimator/fdi/tracker/baseline_file.h"
#include "estimator/fdi/tracker/tracking_text.h"
#include "estimator/greybox/tracking/parameter_tracker.h"
#include "tests/truth/case.h"
#include "tests/truth/rig.h"

namespace tracking_test {

namespace iso = estimator::greybox::tracking;
namespace tracker = estimator::fdi::tracker;

/// Encoder of 5 um and noise of 2 um.
inline constexpr double kFloor_m = 2.47e-6;
inline constexpr double kHealthy_s = 10.0;

/// The source's stand: sine of 25.4 mm at 0.5 Hz.
inline truth::Case stand(double length_s, std::size_t seed = 1) {
  truth::Case of = truth::parse_case("motion=sine,plant=printed", seed);
  of.length_s = length_s;
  return of;
}

inline void fault(truth::Case& of, double at_s, double truth::Plant::*member, double factor) {
  of.changes.push_back({at_s, member, nullptr, factor * of.plant.*member});
}

struct Tracked {
  iso::ParameterSet set;
  iso::Baseline baseline;
  std::vector<iso::WindowResult> windows;
  std::vector<iso::DetectedChange> alarms;

  [[nodiscard]] const std::string& name(const iso::DetectedChange& alarm) const {
    return set.parameters[alarm.named.parameter].name;
  }
};

inline const std::vector<std::string>& usual() {
  static const std::vector<std::string> names{"supply_pressure_Pa", "damping_N_s_per_m"};
  return names;
}

inline plant_sim::ModelFile printed_model() {
  plant_sim::ModelFile model;  // the defaults are the printed values
  model.name = "printed";
  return model;
}

/// Chamber pressures are used where the record has them, its supply pressure only as `supply_Pa`.
inline Tracked tracked(const truth::Record& record, const std::vector<std::string>& names = usual(),
                       const iso::TrackerSettings& settings = {},
                       const plant_sim::ModelFile& model = printed_model(),
                       double floor_m = kFloor_m, const std::vector<double>& supply_Pa = {}) {
  Tracked out;
  out.set = iso::choose(model, names, "parameters");
  const auto run = [&](iso::ParameterTracker& tracker, double until_s) {
    std::vector<iso::WindowResult> windows;
    for (std::size_t k = 0; k < record.t_s.size() && record.t_s[k] < until_s; ++k) {
      config::signals::Pressures pressures;
      if (!supply_Pa.empty()) pressures.supply_Pa = supply_Pa[k];
      if (!record.in_Pa.empty()) pressures.in_Pa = record.in_Pa[k];
      if (!record.out_Pa.empty()) pressures.out_Pa = record.out_Pa[k];
      auto window = tracker.push(record.t_s[k], record.u_V[k], record.y_m[k], k == 0, pressures);
      if (window) windows.push_back(*window);
    }
    return windows;
  };
  iso::ParameterTracker learning(model, out.set, settings, truth::kSample_s, floor_m);
  out.baseline = iso::learn_baseline(run(learning, kHealthy_s), out.set, floor_m);
  iso::ParameterTracker judging(model, out.set, settings, truth::kSample_s, floor_m);
  judging.take(out.baseline);
  out.windows = run(judging, INFINITY);
  out.alarms = judging.detector().changes();
  return out;
}

}  // namespace tracking_test
