#include "estimator/greybox/selection/prediction_error.h"

#include <algorithm>
#include <cmath>

namespace estimator::greybox::selection {

double prediction_rms_m(const InnovationStage& stage) {
  const FitDataset& data = stage.context.problem.data;
  double sum_m2 = 0.0;
  double counted = 0.0;
  for (std::size_t r = 0; r < data.records.size(); ++r) {
    const Dataset& record = data.records[r];
    const Eigen::VectorXd& scale = record.innovations->scale;
    const auto from = static_cast<Eigen::Index>(data.starts[r]);
    for (Eigen::Index k = 0; k < scale.size(); ++k) {
      if (record.valid[static_cast<std::size_t>(k)] == 0) continue;
      sum_m2 += std::pow(stage.model.fitted.residual_m[from + k] / scale[k], 2);
      counted += 1.0;
    }
  }
  return std::sqrt(sum_m2 / std::max(counted, 1.0));
}

std::optional<PredictionErrors> prediction_errors(const SearchContext& context,
                                                  const InnovationSearch& search) {
  if (search.final.model.added.empty()) return {};
  InnovationStage before = search.before;
  if (!search.final.noise.lines.empty()) {
    before = settled(without_holdouts(context), before.model, search.final.noise, Settling::once,
                     wide(context.options.threads));
  }
  if (!std::isfinite(before.minus_two_log)) return {};
  return PredictionErrors{prediction_rms_m(before), prediction_rms_m(search.final)};
}

}  // namespace estimator::greybox::selection
