#include "estimator/greybox/selection/typical_sizes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "estimator/greybox/selection/rig_scale.h"

namespace estimator::greybox::selection {
namespace {

/// Smaller differences are within the decades of sizes that are tried.
constexpr double kDecades = 0.8;

struct UnitScale {
  std::string_view suffix;
  double (*of)(const RigScale&);
};
// The longer before its ending. A bristle yields over micrometres, however long the motion is:
// k ~ F / z, s1 ~ sqrt(k m).
constexpr std::array kUnits = {
    UnitScale{"presliding_stiffness_N_per_m", [](const RigScale& s) { return s.force_N; }},
    UnitScale{"presliding_damping_N_s_per_m",
              [](const RigScale& s) { return s.force_N * std::sqrt(s.length_m) / s.speed_mps; }},
    UnitScale{"_N_s2_per_m2",
              [](const RigScale& s) { return s.force_N / (s.speed_mps * s.speed_mps); }},
    UnitScale{"_N_s_per_m", [](const RigScale& s) { return s.force_N / s.speed_mps; }},
    UnitScale{"_N_per_m", [](const RigScale& s) { return s.force_N / s.length_m; }},
    UnitScale{"_m3ps_per_Pa",
              [](const RigScale& s) { return s.area_m2 * s.speed_mps / s.pressure_Pa; }},
    UnitScale{"_Pa_per_m3ps",
              [](const RigScale& s) { return s.pressure_Pa / (s.area_m2 * s.speed_mps); }},
    UnitScale{"_m3ps", [](const RigScale& s) { return s.area_m2 * s.speed_mps; }},
    UnitScale{"_mps2", [](const RigScale& s) { return s.speed_mps * s.speed_mps / s.length_m; }},
    UnitScale{"_mps", [](const RigScale& s) { return s.speed_mps; }},
    UnitScale{
        "_kg",
        [](const RigScale& s) { return s.force_N * s.length_m / (s.speed_mps * s.speed_mps); }},
    UnitScale{"_N", [](const RigScale& s) { return s.force_N; }},
    UnitScale{"_V", [](const RigScale& s) { return s.command_V; }},
    UnitScale{"_m", [](const RigScale& s) { return s.length_m; }},
};

double scale_of(std::string_view name, const RigScale& scale) {
  for (const UnitScale& unit : kUnits) {
    if (name.size() >= unit.suffix.size() &&
        name.substr(name.size() - unit.suffix.size()) == unit.suffix) {
      return unit.of(scale);
    }
  }
  return 1.0;
}

}  // namespace

void scale_typical_sizes(const plant_sim::ModelFile& model, const FitDataset& data,
                         std::vector<plant_sim::EffectInfo>& effects) {
  const RigScale rig = rig_scale(model, data);
  for (plant_sim::EffectInfo& effect : effects) {
    if (effect.name == "spool_rate_limit" || plant_sim::find_effect(effect.name) == nullptr) {
      continue;
    }
    for (plant_sim::ParameterInfo& parameter : effect.parameters) {
      const double decades =
          std::log10(scale_of(parameter.name, rig) / scale_of(parameter.name, RigScale{}));
      if (!(std::abs(decades) > kDecades) || std::isinf(decades)) continue;
      parameter.typical = std::clamp(parameter.typical * std::pow(10.0, std::round(decades)),
                                     std::max(parameter.min, 1e-300), parameter.max);
    }
  }
}

}  // namespace estimator::greybox::selection
