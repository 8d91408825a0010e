// Refinements that take the place of another: a friction that turns its sign gradually instead of
// over a pre-sliding spring. Neither leads a fit to the other, so both are fitted.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// The stage without each refinement that another can take the place of, and with the other in
/// several sizes, beside the effect's further refinements or none; the shortest first. None where
/// its effects have no such refinement.
[[nodiscard]] std::vector<ParameterSubset> alternative_refinements(const SearchContext& context,
                                                                   const ModelStage& stage);

/// True where such a refinement ends at the least that is another law than none.
[[nodiscard]] bool ends_at_least(const FitSummary& fitted);
/// The fit's parameters without those refinements of the effects that were added; what the model
/// file has stays, where it may keep the file's value alone.
[[nodiscard]] ParameterSubset without_least(const FitSummary& fitted,
                                            const std::vector<std::string>& added);

/// Takes such a refinement where the stage leaves less with it, unless it leaves far more than
/// noise.
void try_alternative_refinements(const SearchContext& context, ModelStage& stage);
/// The same where noise does not explain the stage.
void take_alternative_refinements(const SearchContext& context, ModelStage& stage);

}  // namespace estimator::greybox::selection
