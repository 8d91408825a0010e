// The verdict of a search, and what a report needs beside it.
#pragma once

#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/innovation_search.h"

namespace estimator::greybox::selection {

/// The fields of a diagnosis that precede any conclusion: a result to conclude again.
[[nodiscard]] Diagnosis begun(const Diagnosis& result);

/// localise() without the places that explain next to nothing: an error that enters nowhere has
/// none.
[[nodiscard]] std::vector<Localisation> places_of(const SearchContext& context,
                                                  const ModelStage& stage);

/// A verdict by the held-out errors of simulations on `result.search`. `search`: the context that
/// was searched, which for long records holds segments of `context`.
void conclude(const SearchContext& context, const SearchContext& search, Diagnosis& result);

/// Held-out error of a simulation, the parameters of `fitted` fitted to such from where they are,
/// m.
[[nodiscard]] double least_rms_m(const SearchContext& context, const FitSummary& fitted,
                                 double observer_per_s);

/// Noise of the sensor: the data set's floor, or the noise model's where that is no more than a
/// bound.
[[nodiscard]] double sensor_noise_m(const SearchContext& search,
                                    const InnovationSearch& innovations, bool floor_assumed);

/// True where the rig amplifies a disturbance that is next to nothing until a simulation loses the
/// motion: its error is then no measure of a model.
[[nodiscard]] bool loses_motion(const SearchContext& search, const InnovationSearch& innovations,
                                const std::optional<Disturbance>& disturbance);

/// True where what sensor and disturbance would cause in a simulation, by the noise model, agrees
/// with its error `rms_m`: what explains the samples has to explain the simulation too.
[[nodiscard]] bool noise_is_credible(const SearchContext& search,
                                     const InnovationSearch& innovations, double sensor_m,
                                     const std::optional<Disturbance>& disturbance, double rms_m);

/// A verdict by the likelihood of innovations. `first`: the model as given, its parameters fitted.
void conclude(const SearchContext& context, const SearchContext& search, const ModelStage& first,
              const InnovationSearch& innovations, Diagnosis& result);

}  // namespace estimator::greybox::selection
