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

/// A verdict by the likelihood of innovations. `first`: the model as given, its parameters fitted.
void conclude(const SearchContext& context, const SearchContext& search, const ModelStage& first,
              const InnovationSearch& innovations, Diagnosis& result);

}  // namespace estimator::greybox::selection
