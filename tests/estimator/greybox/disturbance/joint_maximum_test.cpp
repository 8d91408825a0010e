// The joint maximum of parameters and noise model, against the likelihood of its neighbours as
// minus_two_log_likelihood() has it, which knows nothing of the search's residuals and slopes.
#include "estimator/greybox/disturbance/joint_maximum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "config/schema/document.h"
#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/innovation_stage.h"
#include "estimator/greybox/selection/structure_search.h"
#include "tests/workbench/diagnose/two_masses.h"

namespace estimator::greybox::disturbance {
namespace {

using selection::InnovationStage;
using selection::SearchContext;

constexpr two_masses::Rig kRig{.resonance_Hz = 17.0,
                               .at_load = true,
                               .sample_rate_Hz = 500.0,
                               .duration_s = 6.0,
                               .kp_V_per_m = 100.0,
                               .kd_V_s_per_m = 6.0,
                               .second_disturbance_N = 2.0};

constexpr const char* kAxis =
    "schema_version = 1\nname = \"axis\"\nplant = \"force_driven_axis\"\n[parameters]\n"
    "mass_kg = 33.0\ndamping_N_s_per_m = 150.0\ngain_N_per_V = 40.0\n";
constexpr const char* kSecondMass =
    "[effects.second_mass]\nmass_ratio = 0.4\nresonance_Hz = 16.6\ndamping_ratio = 0.02\n"
    "sensor_ratio = 1.0\n";

plant_sim::ModelFile axis(const std::string& effects) {
  return plant_sim::read_model(config::schema::Document::parse(kAxis + effects, "axis"));
}

config::record::Record record_of(const two_masses::Rig& rig) {
  config::record::Record record = two_masses::record(rig);
  record.name = "two masses";
  record.sample_time_s = 1.0 / rig.sample_rate_Hz;
  return record;
}

SearchContext context_of(std::vector<Dataset> records, const char* effects = kSecondMass) {
  return {selection::make_problem(axis(effects), fit_dataset(std::move(records), {})), {}};
}

SearchContext context() { return context_of({dataset_of(record_of(kRig))}); }

/// A record with a gap.
SearchContext interrupted_context() {
  config::record::Record gapped = record_of(kRig);
  for (std::vector<double>* column : {&gapped.t_s, &gapped.u_V, &gapped.y_m})
    column->erase(column->begin() + 1400, column->begin() + 1440);
  gapped.gaps = {1400};
  return context_of({dataset_of(gapped)});
}

SearchContext two_records_context() {
  two_masses::Rig second = kRig;
  second.seed = 2;
  second.duration_s = 3.0;
  return context_of({dataset_of(record_of(kRig)), dataset_of(record_of(second))});
}

/// -2 log posterior with the predictor that follows the parameters.
double cost(const SearchContext& plain, const InnovationStage& stage, const Eigen::VectorXd& theta,
            const NoiseModel& noise) {
  FitSummary at = stage.model.fitted;
  at.theta = theta;
  const Linearisations linear = linearise(plain.problem.model, stage.context.problem.data,
                                          at.parameters, theta, noise.force_place);
  return prior_cost(at) + minus_two_log_likelihood(plain.problem.model, plain.problem.data,
                                                   at.parameters, theta, linear, noise);
}

/// The search ends where it expects a fall of -2 log L by less than 1e-5 of it, some 0.1.
constexpr double kTolerance = 0.2;

void expect_no_likelier_neighbour(const SearchContext& plain) {
  const InnovationStage stage = settled(plain, selection::first_stage(plain), {},
                                        selection::Settling::fully, SimulationWidth{});
  const FitSummary& fitted = stage.model.fitted;
  const double least = cost(plain, stage, fitted.theta, stage.noise);
  EXPECT_NEAR(least, stage.minus_two_log, kTolerance);
  for (Eigen::Index i = 0; i < fitted.theta.size(); ++i) {
    const FreeParameter& p = fitted.parameters[static_cast<std::size_t>(i)];
    for (const double by : {-0.03, 0.03}) {
      Eigen::VectorXd theta = fitted.theta;
      theta[i] = std::clamp(theta[i] + by, p.lower, p.upper);
      EXPECT_GT(cost(plain, stage, theta, stage.noise), least - kTolerance) << p.name << ' ' << by;
    }
  }
  for (Eigen::Index i = 0; i < SearchPoint::RowsAtCompileTime; ++i) {
    for (const double by : {-0.1, 0.1}) {
      NoiseModel noise = stage.noise;
      SearchPoint point = point_of(noise.noise);
      point[i] += by;
      noise.noise = noise_of(point);
      EXPECT_GT(cost(plain, stage, fitted.theta, noise), least - kTolerance) << i << ' ' << by;
    }
  }
}

TEST(JointMaximum, NoNeighbourIsLikelier) { expect_no_likelier_neighbour(context()); }

TEST(JointMaximum, NoNeighbourIsLikelierBesideAGap) {
  expect_no_likelier_neighbour(interrupted_context());
}

TEST(JointMaximum, NoNeighbourIsLikelierOverTwoRecords) {
  expect_no_likelier_neighbour(two_records_context());
}

// So few unknowns that all slopes come with each trial.
TEST(JointMaximum, NoNeighbourIsLikelierOfARigidMass) {
  two_masses::Rig rig = kRig;
  rig.mass_ratio = 0.0;
  rig.second_disturbance_N = 0.0;
  rig.driven_disturbance_N = 2.0;
  expect_no_likelier_neighbour(context_of({dataset_of(record_of(rig))}, ""));
}

// At a resonance of zero the second mass is none, beside it there is one.
TEST(JointMaximum, ASecondMassMayComeIn) {
  const SearchContext plain = context();
  InnovationStage stage = settled(plain, selection::first_stage(plain), {},
                                  selection::Settling::once, SimulationWidth{});
  FitSummary& fitted = stage.model.fitted;
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    if (fitted.parameters[i].name == "second_mass.resonance_Hz")
      fitted.theta[static_cast<Eigen::Index>(i)] = fitted.parameters[i].lower;
  }
  take_own_predictor(plain, stage);
  const double before = stage.minus_two_log;
  const JointMaximum found = joint_maximum(plain.problem.model, stage.context.problem.data,
                                           fitted.parameters, fitted.theta, stage.noise, 1, {});
  fitted.theta = found.theta;
  stage.noise = found.noise;
  take_own_predictor(plain, stage);
  EXPECT_LT(stage.minus_two_log, before);
}

// Frozen gains end short of it: the mass and its share are pulled to what the gains had followed.
TEST(JointMaximum, IsLikelierThanAFitWithFrozenGains) {
  const SearchContext plain = context();
  InnovationStage stage = settled(plain, selection::first_stage(plain), {},
                                  selection::Settling::once, SimulationWidth{});
  const double frozen = stage.minus_two_log;
  const JointMaximum found =
      joint_maximum(plain.problem.model, stage.context.problem.data, stage.model.fitted.parameters,
                    stage.model.fitted.theta, stage.noise, 1, {});
  stage.model.fitted.theta = found.theta;
  stage.noise = found.noise;
  take_own_predictor(plain, stage);
  EXPECT_LT(stage.minus_two_log, frozen - 1.0);
}

TEST(InnovationFit, OfNoneMovesNothing) {
  const SearchContext plain = context();
  const InnovationStage stage = settled(plain, selection::first_stage(plain), {},
                                        selection::Settling::once, SimulationWidth{});
  const selection::ParameterSubset all =
      selection::subset(stage.model.fitted, [](const auto&) { return true; });
  const FitSummary there = selection::fit_innovations(stage.context, all, SimulationWidth{},
                                                      selection::InnovationFit::none);
  EXPECT_EQ(there.theta, stage.model.fitted.theta);
  EXPECT_EQ(there.jacobian.cols(), there.theta.size());
  EXPECT_GT(there.jacobian.col(0).norm(), 0.0);
}

TEST(JointMaximum, IsTheSameForAnyNumberOfThreads) {
  const SearchContext plain = context();
  const InnovationStage stage = settled(plain, selection::first_stage(plain), {},
                                        selection::Settling::once, SimulationWidth{});
  const auto found = [&](unsigned threads) {
    return joint_maximum(plain.problem.model, stage.context.problem.data,
                         stage.model.fitted.parameters, stage.model.fitted.theta, stage.noise,
                         threads, {});
  };
  const JointMaximum one = found(1);
  const JointMaximum several = found(3);
  EXPECT_EQ(one.theta, several.theta);
  EXPECT_EQ(one.noise.noise.sensor_m, several.noise.noise.sensor_m);
}

TEST(JointMaximum, ACancelledSearchStaysWhereItBegan) {
  const SearchContext plain = context();
  const InnovationStage stage = settled(plain, selection::first_stage(plain), {},
                                        selection::Settling::once, SimulationWidth{});
  const Eigen::VectorXd& start = stage.model.fitted.theta;
  const JointMaximum found =
      joint_maximum(plain.problem.model, stage.context.problem.data, stage.model.fitted.parameters,
                    start, stage.noise, 1, [] { return true; });
  EXPECT_EQ(found.theta, start);
}

}  // namespace
}  // namespace estimator::greybox::disturbance
