#include "estimator/greybox/selection/noise_credibility.h"

#include <cmath>

#include "estimator/greybox/representative_segments.h"
#include "estimator/greybox/selection/rig_scale.h"

namespace estimator::greybox::selection {
namespace {

/// A disturbance that would cause this many times the error that there is has not been understood,
/// where a curve gains this much beside it. Friction and play let less of it through than their
/// linearised models.
constexpr double kIncredible = 1.5;
constexpr double kSuspicious_nats = 15.0;
/// The same for a great disturbance where nothing would be missing: it hides an effect.
constexpr double kHidden_nats = 10.0;
/// Error of a simulation over what sensor and disturbance cause, above which they are not all.
constexpr double kBeyondDisturbance = 2.0;
/// A great force without memory, its corner at the highest that is searched for, is what a model
/// lacks from sample to sample.
constexpr double kWhite = 0.95;
constexpr double kGreatWhite = 10.0;
/// Ratio of a random force to the drive's, both RMS, from which on it is what the model does not
/// know: a servo's pendulum fitted as a spring leaves 1.3 to 9.
constexpr double kMostOfDrive_ratio = 0.8;
/// The same where a curve explains some of it.
constexpr double kMuchOfDrive_ratio = 0.33;
/// Share of the motion from which on the error is no disturbance's: the model does not follow. An
/// axis that nothing holds in place is carried as far by a slow force; its size tells there.
constexpr double kDoesNotFollow = 0.5;
/// Share of the drive, or of the motion for an error of the reading, up to which a disturbance is
/// next to nothing, and share of the motion from which on it carries a simulation away: where both
/// hold, the rig has amplified it.
constexpr double kNextToNothing = 0.01;
constexpr double kCarriedAway = 0.2;

}  // namespace

double rms_of_drive_N(const SearchContext& search, const FitSummary& fitted) {
  plant_sim::ModelFile model = search.problem.model;
  const double* const given = model.value("gain_N_per_V");
  if (given == nullptr) return 0.0;
  const double found = fitted.value("gain_N_per_V");
  return std::abs(std::isfinite(found) ? found : *given) *
         rig_scale(search.problem.model, search.problem.data).command_sd_V;
}

double sensor_noise_m(const SearchContext& search, const InnovationSearch& innovations,
                      bool floor_assumed) {
  return floor_assumed ? innovations.final.noise.noise.sensor_m : search.problem.data.noise_floor_m;
}

bool loses_motion(const SearchContext& search, const InnovationSearch& innovations,
                  const std::optional<Disturbance>& disturbance) {
  const FitDataset& data = search.problem.data;
  const double motion_m = rig_scale(search.problem.model, data).length_m;
  // lines are no small difference, and the random part is 0 where they are all that is seen
  if (!disturbance || !disturbance->lines.empty() || !(disturbance->value > 0.0) ||
      !(disturbance->rms_m > kCarriedAway * motion_m)) {
    return false;
  }
  if (disturbance->as == "reading") {
    return disturbance->value * std::sqrt(length_s(data)) < kNextToNothing * motion_m;
  }
  return disturbance->as == "force" &&
         disturbance->value <
             kNextToNothing * rms_of_drive_N(search, innovations.final.model.fitted);
}

bool noise_is_credible(const SearchContext& search, const InnovationSearch& innovations,
                       double sensor_m, const std::optional<Disturbance>& disturbance,
                       double rms_m) {
  const double floor_m = std::hypot(sensor_m, disturbance ? disturbance->rms_m : 0.0);
  const bool suspicious = innovations.curve_nats > kSuspicious_nats + innovations.inexact_nats;
  const bool incredible = floor_m > kIncredible * rms_m && suspicious;
  const bool beyond = rms_m > kBeyondDisturbance * floor_m;
  const bool amplified = loses_motion(search, innovations, disturbance);
  const bool white =
      disturbance && !amplified &&
      disturbance->corner_Hz > kWhite * disturbance::most_corner_Hz(search.problem.data) &&
      floor_m > kGreatWhite * sensor_m;
  const double drive_N = rms_of_drive_N(search, innovations.final.model.fitted);
  const bool pushed = disturbance && disturbance->as == "force" && drive_N > 0.0;
  const bool hides =
      suspicious || (innovations.final.model.added.empty() &&
                     innovations.curve_nats > kHidden_nats + innovations.inexact_nats);
  const double most_ratio = hides ? kMuchOfDrive_ratio : kMostOfDrive_ratio;
  const bool great = pushed && disturbance->value > most_ratio * drive_N;
  const bool lost =
      !pushed && !amplified &&
      rms_m > kDoesNotFollow * rig_scale(search.problem.model, search.problem.data).length_m;
  return !(incredible || beyond || white || lost || great);
}

}  // namespace estimator::greybox::selection
