// Effects of the library and laws of the dictionary that are missing beside a learned curve. A
// curve is sought where no effect explains the record alone; one that acts elsewhere is seen only
// beside it, and without it biases the values.
#pragma once

#include <optional>
#include <vector>

#include "estimator/greybox/selection/law_search.h"

namespace estimator::greybox::selection {

struct BesideCurve {
  SearchContext context;          ///< that of the diagnosis, with `laws` among its candidates
  InnovationSearch innovations;   ///< from the curve on
  InnovationStage without_curve;  ///< its final model without the curve
  std::vector<Law> laws;          ///< those of the final model, the curve not among them
};

/// Gain that the most promising effect or law promises beside the curve that `learned` ends at,
/// without the penalty for its parameters. `context`: that of the diagnosis.
[[nodiscard]] double promised_beside_nats(const SearchContext& context, const LawSearch& learned);

/// Goes on from the curve; none where nothing is found beside it, or what is found does without it.
[[nodiscard]] std::optional<BesideCurve> seek_beside_curve(const SearchContext& context,
                                                           const LawSearch& learned);

}  // namespace estimator::greybox::selection
