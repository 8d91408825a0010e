// A search starts without some refinements, such as a ripple's second harmonic or friction that
// differs by direction. They are tried beside an effect that was taken, before another one stands
// in for them.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/selection/innovation_stage.h"
#include "estimator/greybox/selection/parameter_subset.h"

namespace estimator::greybox::selection {

/// The parameters of each such refinement of an effect that a fit lacks.
[[nodiscard]] std::vector<std::vector<FreeParameter>> further_refinements(
    const plant_sim::EffectInfo& effect, const FitSummary& fitted);
/// The same of a candidate effect by its name.
[[nodiscard]] std::vector<std::vector<FreeParameter>> further_refinements(
    const SearchContext& context, const FitSummary& fitted, const std::string& effect);

/// A fit's parameters at their values and a refinement's at zero, or at its typical size where it
/// has no influence at zero.
[[nodiscard]] ParameterSubset refined(const FitSummary& fitted,
                                      const std::vector<FreeParameter>& refinement);

/// The refinements of a stage's effects that gain at least `evidence_nats` become part of it.
void take_further_refinements(const SearchContext& plain, double evidence_nats,
                              InnovationStage& stage);

}  // namespace estimator::greybox::selection
