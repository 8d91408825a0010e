#include "workbench/laws/steady_motion.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "plant_sim/ensemble.h"

namespace workbench::laws {
namespace {

using plant_sim::Ensemble;
using plant_sim::ModelFile;

constexpr double kWindow_s = 0.1;
constexpr int kMostWindows = 100;
/// Change of the mean speed from one window to the next at which it counts as steady: relative, and
/// for a rod that creeps.
constexpr double kSteady = 1e-3;
constexpr double kCreep_mps = 1e-6;

double value_of(ModelFile model, const char* name) {
  const double* const found = model.value(name);
  return found == nullptr ? std::nan("") : *found;
}

/// Where a rod has the most room to either side; the model's start without a stroke.
double middle_m(const ModelFile& model) {
  const double stroke_m = value_of(model, "stroke_m");
  return std::isnan(stroke_m) ? value_of(model, "initial.y_m") : 0.5 * stroke_m;
}

struct Lanes {
  Ensemble::Values speed_mps{}, in_Pa{}, out_Pa{};
};

/// Mean motion of the last window; NaN in lanes that have not settled.
Lanes settled(Ensemble& ensemble, const Ensemble::Values& u_V, double start_m, double step_s) {
  const double window_s = std::max(1.0, std::round(kWindow_s / step_s)) * step_s;
  ensemble.start(start_m);
  Lanes lanes;
  lanes.speed_mps.fill(std::nan(""));
  for (int window = 0; window < kMostWindows; ++window) {
    const Ensemble::Values before_m = ensemble.reading_m();
    ensemble.advance(u_V, window_s);
    const Ensemble::Values after_m = ensemble.reading_m();
    Ensemble::Values back_m{};
    bool steady = true;
    for (std::size_t i = 0; i < Ensemble::kLanes; ++i) {
      const double speed_mps = (after_m[i] - before_m[i]) / window_s;
      const double change_mps = std::abs(speed_mps - lanes.speed_mps[i]);
      const bool calm = change_mps <= std::max(kSteady * std::abs(speed_mps), kCreep_mps);
      steady = steady && calm;
      lanes.speed_mps[i] = window + 1 == kMostWindows && !calm ? std::nan("") : speed_mps;
      back_m[i] = start_m - after_m[i];
    }
    if (steady) break;
    // The rod stays where it was, however fast it moves.
    ensemble.shift(back_m);
  }
  const auto pressures = ensemble.pressures();
  lanes.in_Pa = pressures.in_Pa;
  lanes.out_Pa = pressures.out_Pa;
  return lanes;
}

}  // namespace

SteadyMotion steady_motion(const ModelFile& file, const std::vector<double>& commands_V) {
  const ModelFile model = plant_sim::without_changes(file);
  const double gain_N_per_V = value_of(model, "gain_N_per_V");
  const double area_m2 = value_of(model, "area_m2");
  const double in_m2 = std::isnan(area_m2) ? value_of(model, "cap_area_m2") : area_m2;
  const double out_m2 = std::isnan(area_m2) ? value_of(model, "rod_side_area_m2") : area_m2;
  const std::unique_ptr<Ensemble> ensemble = plant_sim::make_ensemble(model, model.step_s);
  SteadyMotion motion;
  for (std::size_t first = 0; first < commands_V.size(); first += Ensemble::kLanes) {
    Ensemble::Values u_V{};
    const std::size_t count = std::min(Ensemble::kLanes, commands_V.size() - first);
    for (std::size_t i = 0; i < Ensemble::kLanes; ++i) {
      u_V[i] = commands_V[first + std::min(i, count - 1)];
    }
    const Lanes lanes = settled(*ensemble, u_V, middle_m(model), model.step_s);
    for (std::size_t i = 0; i < count; ++i) {
      motion.command_V.push_back(u_V[i]);
      motion.speed_mps.push_back(lanes.speed_mps[i]);
      motion.force_N.push_back(std::isnan(gain_N_per_V)
                                   ? in_m2 * lanes.in_Pa[i] - out_m2 * lanes.out_Pa[i]
                                   : gain_N_per_V * u_V[i]);
    }
  }
  return motion;
}

}  // namespace workbench::laws
