// How a search begins: with one effect, with a second one, and again with the record or the file
// taken otherwise where that leaves far less.
#pragma once

#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/screening.h"
#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// Share of the error from which on another beginning of the search leaves far less.
inline constexpr double kFarLess = 0.5;

/// True where the stage leaves more than a disturbance or a line, of which simulations know
/// nothing.
[[nodiscard]] bool leaves_physics_to_simulations(const SearchContext& context,
                                                 const ModelStage& stage);

/// Adds a second effect where the first leaves more.
void continue_search(const SearchContext& context, SearchStart& start);

/// Takes a pair of effects, as prefer_pair(), where the branch leaves physics.
void prefer_pair_to_physics(const SearchContext& context, SearchStart& start);

/// Searches again with the command earlier where that leaves much less. Returns the lead in
/// samples, 0 for none.
[[nodiscard]] double take_command_lead(SearchContext& context, SearchContext& search,
                                       SearchStart& start);

/// Searches again with wider ranges where the file's values strain and that leaves far less, or
/// noise; true where the problem has changed.
[[nodiscard]] bool widen_file_values(const SearchContext& search, SearchStart& start,
                                     DiagnosisProblem& problem);

}  // namespace estimator::greybox::selection
