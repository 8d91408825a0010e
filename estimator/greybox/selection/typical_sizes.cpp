#include "estimator/greybox/selection/typical_sizes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace estimator::greybox::selection {
namespace {

/// Magnitudes of a rig; for the library's typical sizes, or as ratios to these.
struct RigScale {
  double length_m = 0.02;  ///< RMS of the position about its mean
  double speed_mps = 0.06;
  double command_V = 0.7;
  double force_N = 4400.0;  ///< greatest
  double pressure_Pa = 6.9e6;
  double area_m2 = 6.3e-4;
};

/// Smaller differences are within the decades of sizes that are tried.
constexpr double kDecades = 0.8;

struct UnitScale {
  std::string_view suffix;
  double (*of)(const RigScale&);
};
// The longer before its ending.
constexpr std::array kUnits = {
    UnitScale{"_N_s2_per_m2",
              [](const RigScale& s) { return s.force_N / (s.speed_mps * s.speed_mps); }},
    UnitScale{"_N_s_per_m", [](const RigScale& s) { return s.force_N / s.speed_mps; }},
    UnitScale{"_N_per_m", [](const RigScale& s) { return s.force_N / s.length_m; }},
    UnitScale{"_m3ps_per_Pa",
              [](const RigScale& s) { return s.area_m2 * s.speed_mps / s.pressure_Pa; }},
    UnitScale{"_Pa_per_m3ps",
              [](const RigScale& s) { return s.pressure_Pa / (s.area_m2 * s.speed_mps); }},
    UnitScale{"_m3ps", [](const RigScale& s) { return s.area_m2 * s.speed_mps; }},
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
    if (name.size() > unit.suffix.size() &&
        name.substr(name.size() - unit.suffix.size()) == unit.suffix) {
      return unit.of(scale);
    }
  }
  return 1.0;
}

RigScale scale_of(plant_sim::ModelFile model, const FitDataset& data) {
  RigScale scale;
  double squares_m2 = 0.0;
  double squares_m2ps2 = 0.0;
  double squares_V2 = 0.0;
  double most_V = 0.0;
  double samples = 0.0;
  for (const Dataset& record : data.records) {
    double mean_m = 0.0;
    for (const double y_m : record.y_m) mean_m += y_m / static_cast<double>(record.size());
    for (std::size_t k = 1; k < record.size(); ++k) {
      const double speed_mps = (record.y_m[k] - record.y_m[k - 1]) / record.sample_time_s;
      squares_m2 += (record.y_m[k] - mean_m) * (record.y_m[k] - mean_m);
      squares_m2ps2 += speed_mps * speed_mps;
      squares_V2 += record.u_V[k] * record.u_V[k];
      most_V = std::max(most_V, std::abs(record.u_V[k]));
      samples += 1.0;
    }
  }
  scale.length_m = std::sqrt(squares_m2 / samples);
  scale.speed_mps = std::sqrt(squares_m2ps2 / samples);
  scale.command_V = std::sqrt(squares_V2 / samples);
  const double* const area_m2 = model.value("area_m2");
  const double* const supply_Pa = model.value("supply_pressure_Pa");
  if (area_m2 != nullptr && supply_Pa != nullptr) {
    scale.area_m2 = *area_m2;
    scale.pressure_Pa = *supply_Pa;
    scale.force_N = *area_m2 * *supply_Pa;
  } else if (const double* const gain = model.value("gain_N_per_V")) {
    scale.force_N = *gain * most_V;
  }
  return scale;
}

}  // namespace

void scale_typical_sizes(const plant_sim::ModelFile& model, const FitDataset& data,
                         std::vector<plant_sim::EffectInfo>& effects) {
  const RigScale rig = scale_of(model, data);
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
