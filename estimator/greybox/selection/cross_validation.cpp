#include "estimator/greybox/selection/cross_validation.h"

#include <algorithm>
#include <cmath>

#include "estimator/greybox/selection/candidate_gain.h"
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

CrossValidation::CrossValidation(const SearchContext& context) : context_(context) {
  Halves halves = halves_of(context.problem.data);
  forth_ = std::move(halves.forth);
  back_ = std::move(halves.back);
}

CrossValidation::Key CrossValidation::key_of(bool explained, const ParameterSubset& model) {
  Key key;
  for (const FreeParameter& p : model.parameters) key.first.push_back(p.name);
  key.second.assign(model.start.begin(), model.start.end());
  key.second.push_back(explained ? 1.0 : 0.0);
  return key;
}

void CrossValidation::fit_missing(bool explained,
                                  const std::vector<const ParameterSubset*>& models) {
  FitOptions options;
  options.tolerance = 1e-4;
  options.max_iterations = 15;
  options.final_jacobian = false;
  options.cancel = context_.options.cancel;
  if (!explained) {
    // free run: its minimum is narrow, and an unconverged fit decides wrongly
    options.observer_per_s = 0.0;
    options.tolerance = 1e-5;
    options.max_iterations = FitOptions{}.max_iterations;
  }
  std::vector<const ParameterSubset*> missing;
  for (const ParameterSubset* model : models) {
    if (!known_.contains(key_of(explained, *model))) missing.push_back(model);
  }
  std::vector<double> validation_rms_m(2 * missing.size());
  in_parallel(validation_rms_m.size(), context_.options.threads, [&](std::size_t i) {
    const ParameterSubset& model = *missing[i / 2];
    const FitDataset& data = i % 2 == 0 ? forth_ : back_;
    validation_rms_m[i] = fit(context_.problem.model, data, data.training_mask, model.parameters,
                              model.start, options)
                              .validation_rms_m;
  });
  for (std::size_t i = 0; i < missing.size(); ++i) {
    known_[key_of(explained, *missing[i])] = {validation_rms_m[2 * i], validation_rms_m[2 * i + 1]};
  }
}

bool CrossValidation::holds(bool explained, const ParameterSubset& plain,
                            const ParameterSubset& more) {
  fit_missing(explained, {&plain, &more});
  const Errors& without_m = known_.at(key_of(explained, plain));
  const Errors& with_m = known_.at(key_of(explained, more));
  const double enough = 1.0 - worthwhile_at(context_, without_m.first);
  return with_m.first < enough * without_m.first && with_m.second < enough * without_m.second;
}

double fitted_rms_m(const FitDataset& data, const FitSummary& fitted) {
  if (data.has_holdouts()) return fitted.validation_rms_m;
  if (fitted.residual_m.size() != data.size() || data.size() == 0) return fitted.training_rms_m;
  double sum_m2 = 0.0;
  double counted = 0.0;
  for (std::size_t r = 0; r < data.records.size(); ++r) {
    const Dataset& record = data.records[r];
    const auto settling = static_cast<std::size_t>(std::lround(kBlock_s / record.sample_time_s));
    for (std::size_t k = settling; k < record.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(data.starts[r] + k);
      sum_m2 += data.training_mask[row] * fitted.residual_m[row] * fitted.residual_m[row];
      counted += data.training_mask[row];
    }
  }
  return counted > 0.0 ? std::sqrt(sum_m2 / counted) : 0.0;
}

double whole_rms_m(const SearchContext& context, const FitSummary& fitted) {
  return std::max(fitted.validation_rms_m, fitted_rms_m(context.problem.data, fitted));
}

bool is_explained(const SearchContext& context, const ModelStage& stage) {
  const FitDataset& data = context.problem.data;
  return stage.fitted.validation_rms_m <= kUnexplained * data.noise_floor_m &&
         fitted_rms_m(data, stage.fitted) <= kFittedToo * data.noise_floor_m;
}

}  // namespace estimator::greybox::selection
