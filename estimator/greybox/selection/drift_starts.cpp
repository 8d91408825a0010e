#include "estimator/greybox/selection/drift_starts.h"

#include <algorithm>
#include <cstddef>

#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

void fit_simulation(ChangeProposal& drift) {
  const FitDataset& data = drift.context.problem.data;
  FitOptions options;
  options.cancel = drift.context.options.cancel;
  drift.start.fitted = fit(drift.context.problem.model, data, data.training_mask,
                           drift.start.fitted.parameters, drift.start.fitted.theta, options);
}

}  // namespace

std::vector<ChangeProposal> drift_starts(const SearchContext& context, const ModelStage& first,
                                         double most_m) {
  if (context.problem.data.records.size() != 1) return {};
  InnovationStage nominal;
  nominal.context = context;
  nominal.model = first;
  nominal.model.fitted.theta = with_file_values(context, first);
  std::vector<ChangeProposal> drifts;
  for (const ChangeScore& score : drifts_of(nominal)) {
    drifts.push_back(proposal(context, nominal, score));
  }
  in_parallel(drifts.size(), context.options.threads,
              [&](std::size_t i) { fit_simulation(drifts[i]); });
  std::erase_if(drifts, [&](const ChangeProposal& drift) {
    return !(drift.start.fitted.validation_rms_m < most_m);
  });
  std::stable_sort(drifts.begin(), drifts.end(), [](const auto& a, const auto& b) {
    return a.start.fitted.validation_rms_m < b.start.fitted.validation_rms_m;
  });
  return drifts;
}

}  // namespace estimator::greybox::selection
