// Spectral lines that may explain what a stage's innovations still hold.
#pragma once

#include <vector>

#include "estimator/greybox/disturbance/spectral_lines.h"
#include "estimator/greybox/selection/innovation_stage.h"

namespace estimator::greybox::selection {

struct ScoredLine {
  disturbance::SpectralLine line;
  double gain_nats = 0.0;
};

/// The best line about each promising frequency of the longest record, best first. A frequency at
/// which the model itself moves is left out: a fault there is the model's, no disturbance.
[[nodiscard]] std::vector<ScoredLine> line_candidates(const SearchContext& plain,
                                                      const InnovationStage& stage);

/// Gain of the best spectral line; 0 where there is none.
[[nodiscard]] double line_nats(const SearchContext& plain, const InnovationStage& stage);

}  // namespace estimator::greybox::selection
