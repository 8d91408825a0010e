// Records of the independent truth generator as the fit reads them.
#pragma once

#include <string>

#include "config/record/record.h"
#include "estimator/greybox/estimation.h"
#include "estimator/greybox/fit_dataset.h"
#include "tests/truth/case.h"
#include "tests/truth/rig.h"
#include "workbench/fit/choice.h"

namespace workbench_test {

namespace greybox = estimator::greybox;

inline greybox::Measured measured(const truth::Record& made) {
  config::record::Record record;
  record.name = "truth";
  record.sample_time_s = truth::kSample_s;
  record.t_s = made.t_s;
  record.u_V = made.u_V;
  record.y_m = made.y_m;
  return greybox::measured(record);
}

/// A fit of `model` to all of a case's record.
inline greybox::Task task(const plant_sim::ModelFile& model, const truth::Case& of,
                          const workbench::fit::Wishes& wishes) {
  greybox::Task task;
  task.model = model;
  const auto choice = workbench::fit::choose(model, wishes);
  task.searched = choice.searched;
  task.start = choice.start;
  task.evidence = greybox::evidence({measured(truth::simulate(of))}, {});
  task.weights = task.evidence.counts;
  task.evidence.scores.setZero();
  task.profiling = greybox::Profiling::none;
  return task;
}

inline const greybox::Parameter& parameter(const greybox::Estimation& of, const std::string& name) {
  for (const auto& p : of.parameters) {
    if (p.search.name == name) return p;
  }
  throw std::out_of_range(name);
}

}  // namespace workbench_test
