#include "estimator/greybox/selection/cross_validation.h"

#include <array>

#include "estimator/greybox/selection/structure_search.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

/// Two halves of the records, each with its own start: one for the fit, one for the score. Records
/// held out are one of the halves.
struct Halves {
  FitDataset forth;
  FitDataset back;
};

Halves halves_of(const FitDataset& data) {
  std::vector<Dataset> first;
  std::vector<Dataset> second;
  if (data.has_holdouts()) {
    const auto kept = data.records.begin() + static_cast<std::ptrdiff_t>(data.fitted_records);
    first.assign(data.records.begin(), kept);
    second.assign(kept, data.records.end());
    return {greybox::fit_dataset(first, second), greybox::fit_dataset(second, first)};
  }
  for (const Dataset& record : data.records) {
    first.push_back(part(record, 0, record.size() / 2));
    second.push_back(part(record, record.size() / 2, record.size()));
  }
  return {greybox::fit_dataset(first, second), greybox::fit_dataset(second, first)};
}

}  // namespace

bool cross_validates(const SearchContext& context, bool explained, const ParameterSubset& plain,
                     const ParameterSubset& more) {
  const Halves halves = halves_of(context.problem.data);
  FitOptions options;
  options.tolerance = 1e-4;
  options.max_iterations = 15;
  options.final_jacobian = false;
  options.cancel = context.options.cancel;
  if (!explained) {
    // free run: its minimum is narrow, and an unconverged fit decides wrongly
    options.observer_per_s = 0.0;
    options.tolerance = 1e-5;
    options.max_iterations = FitOptions{}.max_iterations;
  }
  std::array<double, 4> validation_rms_m{};
  in_parallel(validation_rms_m.size(), context.options.threads, [&](std::size_t i) {
    const ParameterSubset& selection = i % 2 == 0 ? plain : more;
    const FitDataset& data = i < 2 ? halves.forth : halves.back;
    validation_rms_m[i] = fit(context.problem.model, data, data.training_mask, selection.parameters,
                              selection.start, options)
                              .validation_rms_m;
  });
  const double enough = 1.0 - worthwhile_at(context, validation_rms_m[0]);
  return validation_rms_m[1] < enough * validation_rms_m[0] &&
         validation_rms_m[3] < enough * validation_rms_m[2];
}

bool is_explained(const SearchContext& context, const ModelStage& stage) {
  return stage.fitted.validation_rms_m <= kUnexplained * context.problem.data.noise_floor_m;
}

}  // namespace estimator::greybox::selection
