// Trial sizes of an effect for the screening.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "estimator/greybox/fit_dataset.h"
#include "estimator/greybox/free_parameter.h"
#include "estimator/greybox/selection/problem.h"
#include "plant_sim/library.h"

namespace estimator::greybox::selection {

/// Columns of search values (searched.size() rows). The first parameter takes sizes over decades,
/// with both signs where allowed; parameters in the same unit scale with it; rest positions lie
/// within the motion. `count`: kTrialSizes, or half as many in wider steps. A law with a rest
/// position and a width has further columns at places all over the motion.
[[nodiscard]] Eigen::MatrixXd trial_sizes(const std::vector<FreeParameter>& parameters,
                                          const FitDataset& data, Eigen::Index count = kTrialSizes);

/// True when the effect has a wavelength and a phase.
[[nodiscard]] bool is_periodic(const std::vector<FreeParameter>& parameters);
/// Wave numbers of a periodic effect that the motion can resolve, in turns over the motion.
[[nodiscard]] std::vector<double> turns_over(const FitDataset& data);
/// Turns of a periodic effect of that wavelength over the motion.
[[nodiscard]] double turns_of(const FitDataset& data, double wavelength_m);
/// A small periodic effect with `turns` over the motion, at phase 0 and a quarter later: two
/// columns whose linear combinations are the effect with any size and phase.
[[nodiscard]] Eigen::MatrixXd waves(const std::vector<FreeParameter>& parameters,
                                    const FitDataset& data, double turns);
/// Size and phase with which the effect is `first` times the first column of waves() plus `second`
/// times the second.
[[nodiscard]] Eigen::VectorXd wave_of(const std::vector<FreeParameter>& parameters,
                                      const Eigen::VectorXd& wave, double first, double second);
/// Limits a search to the neighbourhood of the wavelength at `own`, and keeps the sensor's reading
/// monotonic in the rod's position.
void hold_wavelength(const plant_sim::EffectInfo& effect, const Eigen::VectorXd& own,
                     std::span<FreeParameter> parameters);

/// True when the effect is a resonance of the rig.
[[nodiscard]] bool is_resonant(const std::vector<FreeParameter>& parameters);
/// Frequencies of a resonance that the records can resolve, Hz.
[[nodiscard]] std::vector<double> resonances_in(const FitDataset& data);
/// A small resonance of the driven part at each frequency: a column each. The response of a sensor
/// behind the spring is proportional to it, and of the other sign.
[[nodiscard]] Eigen::MatrixXd resonances(const std::vector<FreeParameter>& parameters,
                                         std::span<const double> frequencies_Hz);
/// The parameters of one that is `share` times such a column, and their values: mass, frequency and
/// damping; for a negative share frequency, damping and mass, with the sensor behind the spring.
struct Resonance {
  std::vector<FreeParameter> parameters;
  Eigen::VectorXd theta;
};
[[nodiscard]] Resonance resonance_of(const std::vector<FreeParameter>& parameters,
                                     double frequency_Hz, double share, const FitDataset& data);

/// Scales the effect's size by `share` within its bounds; a negative share of a non-negative size
/// shifts a periodic effect by half a period. Returns false where that is not possible: the size is
/// then scaled by the magnitude alone.
bool scale_size(const std::vector<FreeParameter>& parameters, double share,
                Eigen::Ref<Eigen::VectorXd> own);

}  // namespace estimator::greybox::selection
