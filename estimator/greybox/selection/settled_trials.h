// Candidates of a round of the innovation search with noise models of their own.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "estimator/greybox/selection/innovation_stage.h"
#include "estimator/greybox/selection/innovation_trials.h"

namespace estimator::greybox::selection {

/// The best of each trial's starts beside `stage`; unfinished for a trial of which no start
/// promises anything. Starts elsewhere are followed where they come near the best trial and near a
/// stage that another search has found, of this -2 log L. `on_done` is called as the starts of a
/// trial end, before those elsewhere, by one thread at a time.
[[nodiscard]] std::vector<InnovationStage> settle_trials(
    const SearchContext& plain, const InnovationStage& stage,
    std::span<const InnovationTrial> trials,
    const std::function<void(std::size_t trial)>& on_done = {},
    double found_minus_two_log = std::numeric_limits<double>::infinity());

}  // namespace estimator::greybox::selection
