#include "estimator/greybox/selection/excitation.h"

#include <algorithm>
#include <cmath>

namespace estimator::greybox::selection {
namespace {

/// Ratio of travel to the noise's standard deviation below which a motion is lost in the noise.
constexpr double kLeastTravel = 50.0;
/// Share of samples at the largest or smallest command above which the command is constant.
constexpr double kStuck = 0.98;

}  // namespace

Excitation excitation_of(const FitDataset& data) {
  double travel_m = 0.0;
  double free_samples = 0.0;
  double samples = 0.0;
  for (const Dataset& record : data.records) {
    const auto [low_m, high_m] = std::minmax_element(record.y_m.begin(), record.y_m.end());
    travel_m = std::max(travel_m, *high_m - *low_m);
    const auto [low_V, high_V] = std::minmax_element(record.u_V.begin(), record.u_V.end());
    const double most_V = std::max(std::abs(*low_V), std::abs(*high_V));
    for (const double u_V : record.u_V) {
      samples += 1.0;
      free_samples += std::abs(u_V) < most_V * (1.0 - 1e-6) ? 1.0 : 0.0;
    }
  }
  if (!(travel_m >= kLeastTravel * data.noise_floor_m)) {
    return {Excitation::Cause::no_motion, travel_m, data.noise_floor_m};
  }
  if (free_samples < (1.0 - kStuck) * samples) {
    return {Excitation::Cause::command_at_limit, travel_m, data.noise_floor_m};
  }
  return {Excitation::Cause::sufficient, travel_m, data.noise_floor_m};
}

}  // namespace estimator::greybox::selection
