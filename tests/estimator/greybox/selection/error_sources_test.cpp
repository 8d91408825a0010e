// Standard errors contain more than the noise, on records of the independent simulator.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/split_scatter.h"
#include "estimator/greybox/selection/step_error.h"
#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::dataset_of;
using diagnose_test::thesis;

constexpr double kGain_mpV = 2.79e-5;

Dataset record(double gain_mpV, unsigned seed) {
  const std::string spec = "motion=multisine,length_s=10,plant.valve_gain_m_per_V=";
  return dataset_of(
      truth::simulate(truth::parse_case(spec + std::to_string(1e5 * gain_mpV) + "e-5", seed)));
}

Eigen::Index index_of(const FitSummary& fitted, const std::string& name) {
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    if (fitted.parameters[i].name == name) return static_cast<Eigen::Index>(i);
  }
  return -1;
}

Eigen::VectorXd scatter_of(double second_gain_mpV, Eigen::Index& gain) {
  FitDataset data = fit_dataset({record(kGain_mpV, 61), record(second_gain_mpV, 62)}, {});
  const SearchContext context{make_problem(thesis(), std::move(data)), {}};
  const FitSummary fitted = first_stage(context).fitted;
  gain = index_of(fitted, "valve_gain_m_per_V");
  return split_scatter(context, fitted, context.problem.data.all_mask, kObserver_per_s);
}

// Theta of a gain is its logarithm.
TEST(ErrorSources, HalvesThatDifferScatterByHalfTheirDistance) {
  Eigen::Index gain = -1;
  const Eigen::VectorXd none = scatter_of(kGain_mpV, gain);
  ASSERT_GE(gain, 0);
  EXPECT_LT(none[gain], 0.003);
  const Eigen::VectorXd some = scatter_of(1.06 * kGain_mpV, gain);
  EXPECT_NEAR(some[gain], 0.5 * std::log(1.06), 0.3 * std::log(1.06));
}

StepError step_error_of(const plant_sim::ModelFile& model, const std::string& rig) {
  const truth::Record truth =
      truth::simulate(truth::parse_case("motion=multisine,length_s=10" + rig, 63));
  const SearchContext context{make_problem(model, fit_dataset({dataset_of(truth)}, {})), {}};
  const FitSummary fitted = first_stage(context).fitted;
  StepError error = step_error(context, fitted, context.problem.data.all_mask, kObserver_per_s);
  EXPECT_EQ(error.shift.size(), fitted.theta.size());
  return error;
}

// Oil and valve are integrated by a method of fourth order; bristles of a stiff friction slip
// within a part of a step.
TEST(ErrorSources, StiffFrictionNeedsAShorterStepThanTheOil) {
  plant_sim::ModelFile sliding = thesis();
  for (auto& effect : sliding.effects) effect.present = effect.present || effect.name == "friction";
  for (const auto& [name, value] :
       {std::pair{"friction.coulomb_N", 150.0}, std::pair{"friction.static_N", 260.0},
        std::pair{"friction.stribeck_mps", 0.01},
        std::pair{"friction.presliding_stiffness_N_per_m", 1e7}}) {
    ASSERT_NE(sliding.value(name), nullptr) << name;
    *sliding.value(name) = value;
  }
  const double of_oil_m = step_error_of(thesis(), "").rms_m;
  EXPECT_LT(of_oil_m, 1e-8);
  const std::string rig = ",friction.coulomb_N=150,friction.static_N=260";
  EXPECT_GT(step_error_of(sliding, rig).rms_m, 50.0 * of_oil_m);
}

}  // namespace
}  // namespace estimator::greybox::selection
