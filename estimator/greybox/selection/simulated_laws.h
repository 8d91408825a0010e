// Laws of the dictionary that simulations show to explain a record, before the likelihood has tried
// what effects may explain.
#pragma once

#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// Takes one or two laws, or a law and an effect, where they bring the simulation of a single
/// record to the noise, nothing is left of the motion, and they are clearly likelier than what the
/// search `start` holds and than any one effect. They are sought where that leaves physics, or
/// bends the plant to explain the record. False: `result` is as before.
[[nodiscard]] bool explain_by_laws(const SearchContext& context, const SearchStart& start,
                                   Diagnosis& result);

}  // namespace estimator::greybox::selection
