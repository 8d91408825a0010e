// The law that no formula of the dictionary fits, as a curve: where no effect and no law explains a
// record, the curve over a variable of the motion that makes its innovations likeliest.
//
//   site      added to what the site has            variable
//   force     f(x), or v f(x), against extension    x: position, speed, command, acceleration
//   opening   f(x), or the opening times f(x)       (without an opening: times the
//             command, or over it)
//   friction  its level times 1 + f(x)              x: position
//
// The score test of innovation_curves.h ranks sites and variables; the best are fitted in the model
// as curves (plant_sim/formula/curve_effect.h) of several numbers of points, of which the penalised
// likelihood decides. The points cover what the records visit, so that the curve is constant where
// they say nothing. A friction over the speed alone dissipates: its sign is that of the speed.
#pragma once

#include <optional>

#include "estimator/greybox/selection/law_search.h"

namespace estimator::greybox::selection {

/// None where no curve explains the record. `base`: the model as given, or with effects found.
[[nodiscard]] std::optional<LawSearch> search_curve(const SearchContext& context,
                                                    const ModelStage& base);

}  // namespace estimator::greybox::selection
