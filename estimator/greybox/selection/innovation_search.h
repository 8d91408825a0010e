// The search for missing effects on a rig whose process is disturbed: by forces, a pulsating
// supply, a shaking sensor mount.
//
// A simulation's error is then the disturbance's, slow and large, and hides what is missing. Here a
// model is judged by its innovations (disturbance/): with the noise model that fits it best, they
// are white, and a likelihood counts what each candidate explains.
//
//   gain of a candidate = log L(with it) - log L(stage), each with its own noise model, in nats
//
// Effects of the library and spectral lines compete in one ladder; a candidate must gain kEvidence
// more than kPerParameter for each of its parameters. Fits use every sample: white innovations make
// that valid. Source for the penalty: G. Schwarz, Annals of Statistics 6 (1978) 461.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "estimator/greybox/disturbance/noise_model.h"
#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

inline constexpr double kEvidence_nats = 15.0;
inline constexpr double kPerParameter_nats = 4.3;  ///< log(6000) / 2: a record of 30 s
/// Rivals within this of the best explain the record about as well.
inline constexpr double kRivals_nats = 8.0;
/// Gain of a curve over a variable of the motion above which physics is missing. The largest of 32
/// curves stays below 25 on healthy and rightly named records.
inline constexpr double kCurve_nats = 30.0;

/// A model with its noise model, its parameters fitted to the innovations.
struct InnovationStage {
  ModelStage model;  ///< residuals: scaled innovations of all valid samples
  disturbance::NoiseModel noise;
  disturbance::Linearisations linear;  ///< about the model's trajectory
  SearchContext context;               ///< its data have the innovations
  /// Of likelihood times prior, up to a constant; infinite for a stage that was not finished.
  double minus_two_log = std::numeric_limits<double>::infinity();
};

/// A candidate of a round: an effect, or a spectral line where `effect` is empty.
struct InnovationCandidate {
  std::string effect;
  disturbance::SpectralLine line;
  double gain_nats = 0.0;  ///< less its penalty
  double penalty_nats = 0.0;
  bool settled = false;  ///< with a noise model of its own
  FitSummary fitted;     ///< settled: parameters and their values, without Jacobian
};

struct InnovationRound {
  ModelStage before;                            ///< without Jacobian
  std::vector<InnovationCandidate> candidates;  ///< the one taken, if any, then the best first
};

/// An effect found, and others that explain the record about as well in its place.
struct InnovationRivals {
  std::vector<std::string> names;
  std::vector<FitSummary> explanations;  ///< one for each name
};

struct InnovationSearch {
  InnovationStage before;  ///< the model as given and its noise model, lines not included
  InnovationStage final;
  std::vector<InnovationRound> rounds;
  std::vector<InnovationRivals> rivals;
  double curve_nats = 0.0;  ///< largest gain of a curve over a variable of the motion
};

/// A fit's parameters in a simulation with the weak observer, without Jacobian.
[[nodiscard]] FitSummary simulated(const SearchContext& context, const FitSummary& fitted);

/// `first` is the model as given, fitted with the weak observer. Records that only score take no
/// part.
[[nodiscard]] InnovationSearch search_innovations(const SearchContext& context,
                                                  const ModelStage& first);

}  // namespace estimator::greybox::selection
