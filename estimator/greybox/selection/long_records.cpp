#include "estimator/greybox/selection/long_records.h"

#include "estimator/greybox/representative_segments.h"
#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {

SearchContext for_search(const SearchContext& context) {
  SearchContext search = context;
  if (length_s(context.problem.data) > kLong_s) {
    search.problem.data = representative_segments(context.problem.data);
  }
  return search;
}

bool uses_segments(const SearchContext& search, const SearchContext& context) {
  return search.problem.data.size() < context.problem.data.size();
}

void refit_to_whole(const SearchContext& context, StructureSearch& search) {
  search.nominal_rms_m = nominal_rms_m(context);
  in_parallel(search.path.size(), context.options.threads, [&](std::size_t i) {
    ModelStage& stage = search.path[i];
    stage.fitted = refit(context, subset(stage.fitted, [](const auto&) { return true; }),
                         context.problem.data.training_mask);
    stage.fitted.jacobian.resize(0, 0);  // large and no longer needed
  });
  search.final = search.path.back();
  search.interrupted = search.interrupted || context.cancelled();
}

}  // namespace estimator::greybox::selection
