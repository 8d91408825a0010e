#include "estimator/greybox/selection/curve_place.h"

#include <algorithm>
#include <cmath>

#include "estimator/greybox/kinematics.h"
#include "plant_sim/hydraulics.h"

namespace estimator::greybox::selection {
namespace {

/// Share of the samples beyond either end of a curve.
constexpr double kSparse = 0.002;
/// A force of typical size as a share of the rig's greatest; a gain's share.
constexpr double kCurveForce = 0.03;
constexpr double kCurveRatio = 0.1;
/// Share by which the level of a friction changes.
constexpr double kCurveOfFriction = 0.3;

std::string signal_of(const std::string& variable) {
  if (variable == "y") return "y_m";
  if (variable == "v" || variable == "speed" || variable == "direction") return "v_mps";
  if (variable == "u") return "u_V";
  return variable == "acceleration" ? "a_mps2" : "";
}

/// Opening per command of plants that have an opening; 0 for others.
double opening_per_V(const plant_sim::ModelFile& given) {
  plant_sim::ModelFile model = given;
  if (const auto oil = plant_sim::hydraulics_of(model)) return oil->valve_gain_m_per_V;
  const double* const servo = model.value("gain_mps_per_V");
  return servo == nullptr ? 0.0 : *servo;
}

/// All counted samples of a signal, ascending.
std::vector<double> samples_of(const SearchContext& context, const std::string& signal) {
  const FitDataset& data = context.problem.data;
  const double per_V = opening_per_V(context.problem.model);
  std::vector<double> all;
  for (const Dataset& record : data.records) {
    const Kinematics motion = kinematics(record, data.noise_floor_m);
    for (std::size_t k = 0; k < record.size(); ++k) {
      if (record.valid[k] == 0) continue;
      const double value = signal == "y_m"     ? record.y_m[k]
                           : signal == "v_mps" ? motion.speed_mps[k]
                           : signal == "u_V"   ? record.u_V[k]
                           : signal == "x_m"   ? per_V * record.u_V[k]
                                               : motion.acceleration_mps2[k];
      if (std::isfinite(value)) all.push_back(value);
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// Points half way between equal steps and equal shares of the samples; one at zero where the
/// signal has both signs, since a law over it often bends there.
std::vector<double> points_of(const std::vector<double>& sorted, std::size_t count) {
  const auto quantile = [&](double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  };
  const double low = quantile(kSparse);
  const double high = quantile(1.0 - kSparse);
  if (!(high > low)) return {};
  std::vector<double> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    points.push_back(
        0.5 * (low + (high - low) * share + quantile(kSparse + (1.0 - 2.0 * kSparse) * share)));
  }
  if (low < 0.0 && high > 0.0) {
    const auto nearest =
        std::min_element(points.begin() + 1, points.end() - 1,
                         [](double a, double b) { return std::abs(a) < std::abs(b); });
    *nearest = 0.0;
  }
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (!(points[i + 1] - points[i] > 1e-3 * (high - low))) return {};
  }
  return points;
}

}  // namespace

std::optional<CurvePlace> curve_place(const SearchContext& context, const RigScale& rig,
                                      const CurveGain& curve) {
  CurvePlace place{"force", signal_of(curve.variable), "", curve.variable,
                   kCurveForce * rig.force_N};
  if (place.over.empty()) return {};
  if (curve.input == ResidualInput::force) {
    place.dissipates = place.over == "v_mps";
    return place;
  }
  if (curve.input == ResidualInput::drag) {
    place.times = "v_mps";
    place.typical /= rig.speed_mps;
    return place;
  }
  const double opening = opening_per_V(context.problem.model);
  const bool adds = curve.input != ResidualInput::gain;
  // what is added to an axis' command over its motion is a force
  if (!(opening > 0.0) && adds && place.over != "u_V") return place;
  place.site = opening > 0.0 ? "opening" : "command";
  const std::string own = opening > 0.0 ? "x_m" : "u_V";
  if (place.over == "u_V") place.over = own;
  if (curve.input == ResidualInput::gain) place.times = own;
  const double full = (opening > 0.0 ? opening : 1.0) * rig.most_command_V;
  place.typical = curve.input == ResidualInput::gain ? kCurveRatio : kCurveRatio * full;
  return place;
}

CurvePlace friction_level() { return {kFrictionLevel, "y_m", "", "y", kCurveOfFriction}; }

std::string name_of(const CurvePlace& place) {
  std::string name = place.site + "_over_" + place.over.substr(0, place.over.find('_'));
  if (!place.times.empty()) name += "_times_" + place.times.substr(0, place.times.find('_'));
  return name;
}

std::vector<double> curve_points(const SearchContext& context, const CurvePlace& place,
                                 std::size_t count) {
  const std::vector<double> samples = samples_of(context, place.over);
  return samples.empty() ? samples : points_of(samples, count);
}

}  // namespace estimator::greybox::selection
