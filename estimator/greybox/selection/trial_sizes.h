// The sizes of an effect that are tried before anything is fitted.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "estimator/greybox/fit_dataset.h"
#include "estimator/greybox/free_parameter.h"
#include "plant_sim/library.h"

namespace estimator::greybox::selection {

/// One column of search values each (searched.size() rows). The first parameter takes sizes over
/// decades, with both signs where it may have them; those in the same unit go along with it; rest
/// positions lie where the motion is.
[[nodiscard]] Eigen::MatrixXd trial_sizes(const std::vector<FreeParameter>& parameters,
                                          const FitDataset& data);

/// Whether the effect has a wavelength and a phase.
[[nodiscard]] bool is_periodic(const std::vector<FreeParameter>& parameters);
/// Of a periodic effect: wave numbers that the motion can resolve, in turns over it.
[[nodiscard]] std::vector<double> turns_over(const FitDataset& data);
/// A small periodic effect with so many turns over the motion, at phase 0 and a quarter later: two
/// columns, whose sum in any proportion is the effect with any size and phase.
[[nodiscard]] Eigen::MatrixXd waves(const std::vector<FreeParameter>& parameters,
                                    const FitDataset& data, double turns);
/// The effect of size and phase such that it is `first` times the first of waves() and `second`
/// times the second.
[[nodiscard]] Eigen::VectorXd wave_of(const std::vector<FreeParameter>& parameters,
                                      const Eigen::VectorXd& wave, double first, double second);
/// Keeps a search within the neighbourhood of the wavelength at `own`, and the reading of a sensor
/// from going back while the rod goes on.
void hold_wavelength(const plant_sim::EffectInfo& effect, const Eigen::VectorXd& own,
                     std::span<FreeParameter> parameters);

/// Scales the effect's size by `share`, within its bounds; a negative share of a size that cannot
/// be negative turns a periodic effect by half a period. False where that is not possible: the size
/// is then scaled by the amount alone.
bool scale_size(const std::vector<FreeParameter>& parameters, double share,
                Eigen::Ref<Eigen::VectorXd> own);

}  // namespace estimator::greybox::selection
