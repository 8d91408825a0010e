// Records of the independent truth generator as the fit reads them.
#pragma once

#include <string>

#include "config/record/record.h"
#include "tests/truth/case.h"
#include "tests/truth/rig.h"
#include "workbench/fit/choice.h"
#include "workbench/fit/estimation.h"
#include "workbench/matching/evidence.h"

namespace workbench_test {

inline workbench::matching::Measured measured(const truth::Record& made) {
  config::record::Record record;
  record.name = "truth";
  record.sample_time_s = truth::kSample_s;
  record.t_s = made.t_s;
  record.u_V = made.u_V;
  record.y_m = made.y_m;
  return workbench::matching::measured(record);
}

/// A fit of `model` to all of a case's record.
inline workbench::fit::Task task(const plant_sim::ModelFile& model, const truth::Case& of,
                                 const workbench::fit::Wishes& wishes) {
  workbench::fit::Task task;
  task.model = model;
  const auto choice = workbench::fit::choose(model, wishes);
  task.searched = choice.searched;
  task.start = choice.start;
  task.evidence = workbench::matching::evidence({measured(truth::simulate(of))}, {});
  task.weights = task.evidence.counts;
  task.evidence.scores.setZero();
  task.profiling = workbench::fit::Profiling::none;
  return task;
}

inline const workbench::fit::Parameter& parameter(const workbench::fit::Estimation& of,
                                                  const std::string& name) {
  for (const auto& p : of.parameters) {
    if (p.search.name == name) return p;
  }
  throw std::out_of_range(name);
}

}  // namespace workbench_test
