// Rounds of a structure search: the effects that each took in, and the round that decided.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "estimator/greybox/selection/structure_search.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;

/// The effects that a round's winner brought, empty when nothing was taken.
[[nodiscard]] std::vector<std::string> taken_in(const selection::StructureSearch& search,
                                                std::size_t round);
/// True when one of these effects is left in the end: a later step may drop the effects of a round.
[[nodiscard]] bool stayed(const selection::StructureSearch& search,
                          const std::vector<std::string>& effects);
/// The round that decided: the last in which something was taken that stayed, or else the last.
/// Rounds there must be.
[[nodiscard]] std::size_t deciding_round(const selection::StructureSearch& search);

}  // namespace workbench::diagnose
