// A model parameter as a free parameter of a fit: a number near 0 or 1 with bounds, whatever its
// unit.
//
//   linear       value = origin + unit theta effects: theta = 0 is their absence
//   logarithmic  value = unit exp(theta)     plants: theta = 0 is the model file's value
//   reciprocal   value = unit / theta        limits: theta = 0 is no limit
//   square       value = unit sqrt(theta)    influence that begins with the square of the value
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "plant_sim/library.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox {

enum class ParameterScale { linear, logarithmic, reciprocal, square };

inline constexpr int kEveryRefinement = 1000;
inline constexpr char kInRecord = '@';
/// Range of a plant parameter about the file's value, in standard deviations of its prior.
inline constexpr double kPriorRange_sds = 3.0;

struct FreeParameter {
  /// "damping_N_s_per_m", "friction.coulomb_N"; with "@NAME" behind it in the record of that name
  /// alone, where it has priority.
  std::string name;
  ParameterScale scale = ParameterScale::linear;
  double unit = 1.0;
  double lower = 0.0;  ///< bounds of theta
  double upper = 0.0;
  double prior_mean = 0.0;  ///< mean of theta
  double prior_sd = 0.0;    ///< infinite: no prior
  int refinement = 0;       ///< plant_sim::ParameterInfo::refinement
  int instead_of = 0;       ///< plant_sim::ParameterInfo::instead_of
  double origin = 0.0;      ///< value at theta = 0 of a linear scale
  bool in_model = false;    ///< an effect's, to which the model file gives a value

  [[nodiscard]] double to_physical(double theta) const;
  [[nodiscard]] double to_theta(double value) const;
  /// |d value / d theta|, for standard errors.
  [[nodiscard]] double slope(double theta) const;
};

/// Plant parameters that may differ from the model file, with priors about the file's values
/// (plant_sim::ParameterInfo::uncertainty_ratio).
[[nodiscard]] std::vector<FreeParameter> plant_parameters(const plant_sim::ModelFile& model);

/// True where the model gives that parameter of an effect a value.
[[nodiscard]] bool is_given(const plant_sim::ModelFile& model, const std::string& effect,
                            const plant_sim::ParameterInfo& info);

/// Parameters of effects that the model has and that are not neutral.
[[nodiscard]] std::vector<FreeParameter> present_parameters(const plant_sim::ModelFile& model);

/// theta at which every parameter has the model file's value.
[[nodiscard]] Eigen::VectorXd start_of(const plant_sim::ModelFile& model,
                                       const std::vector<FreeParameter>& parameters);

/// An effect's parameters up to the given refinement, from absence to their largest.
[[nodiscard]] std::vector<FreeParameter> effect_parameters(const plant_sim::EffectInfo& effect,
                                                           int refinement);

}  // namespace estimator::greybox
