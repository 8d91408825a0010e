// Records of the independent truth generator as the fit reads them.
#pragma once

#include <string>

#include "config/record/record.h"
#include "estimator/greybox/estimation.h"
#include "estimator/greybox/fit_dataset.h"
#include "tests/truth/case.h"
#include "tests/truth/rig.h"
#include "workbench/fit/parameter_selection.h"

namespace workbench_test {

namespace greybox = estimator::greybox;

inline greybox::Dataset dataset_of(const truth::Record& made) {
  config::record::Record record;
  record.name = "truth";
  record.sample_time_s = truth::kSample_s;
  record.t_s = made.t_s;
  record.u_V = made.u_V;
  record.y_m = made.y_m;
  return greybox::dataset_of(record);
}

/// A fit of `model` to all of a case's record.
inline greybox::EstimationProblem problem(const plant_sim::ModelFile& model, const truth::Case& of,
                                          const workbench::fit::ParameterSelection& selection) {
  greybox::EstimationProblem problem;
  problem.model = model;
  const auto choice = workbench::fit::select_parameters(model, selection);
  problem.parameters = choice.parameters;
  problem.start = choice.start;
  problem.data = greybox::fit_dataset({dataset_of(truth::simulate(of))}, {});
  problem.weights = problem.data.all_mask;
  problem.data.validation_mask.setZero();
  return problem;
}

inline greybox::EstimationOptions without_profiles() {
  greybox::EstimationOptions options;
  options.profiling = greybox::Profiling::none;
  return options;
}

inline const greybox::EstimatedParameter& parameter(const greybox::EstimationSummary& of,
                                                    const std::string& name) {
  for (const auto& p : of.parameters) {
    if (p.free.name == name) return p;
  }
  throw std::out_of_range(name);
}

}  // namespace workbench_test
