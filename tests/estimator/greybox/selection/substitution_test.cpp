// An effect that keeps nothing but a refinement gives way to the effect that is that refinement.
#include "estimator/greybox/selection/substitution.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "estimator/greybox/fit.h"
#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::context_of;
using testing::UnorderedElementsAre;

/// Slaves and a delay, all their parameters fitted from the truth: a needle valve and no mass.
SearchBranch slaves_and_delay(const SearchContext& context) {
  SearchBranch branch{first_stage(context), {}};
  ParameterSubset selection = subset(branch.stage.fitted, [](const auto&) { return true; });
  for (const std::string effect : {"coupled_slaves", "transport_delay"}) {
    const auto info = std::find_if(context.problem.candidate_effects.begin(),
                                   context.problem.candidate_effects.end(),
                                   [&](const auto& absent) { return absent.name == effect; });
    ParameterSubset own{effect_parameters(*info, kEveryRefinement), {}};
    own.start = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(own.parameters.size()));
    for (std::size_t i = 0; i < own.parameters.size(); ++i) {
      const std::string& name = own.parameters[i].name;
      const double value = name == "transport_delay.delay_s"             ? 0.003
                           : name == "coupled_slaves.needle_N_s2_per_m2" ? 16000.0
                                                                         : 0.0;
      own.start[static_cast<Eigen::Index>(i)] = own.parameters[i].to_theta(value);
    }
    append(selection, own);
    branch.stage.added.push_back(effect);
  }
  branch.stage.fitted = refit(context, selection, context.problem.data.training_mask);
  return branch;
}

TEST(Substitution, OrificeDampingTakesThePlaceOfSlavesWithoutMass) {
  const SearchContext context = context_of(
      "motion=multisine,transport_delay.delay_s=0.003,"
      "quadratic_damping.coefficient_N_s2_per_m2=16000");
  SearchBranch branch = slaves_and_delay(context);
  const double before_m = branch.stage.fitted.validation_rms_m;
  substitute_idle_effects(context, branch);
  EXPECT_THAT(branch.stage.added, UnorderedElementsAre("transport_delay", "quadratic_damping"));
  EXPECT_LT(branch.stage.fitted.validation_rms_m, 1.01 * before_m);
}

TEST(Substitution, AMassWithinItsErrorKeepsNoSlaves) {
  const SearchContext context = context_of(
      "motion=multisine,transport_delay.delay_s=0.003,"
      "quadratic_damping.coefficient_N_s2_per_m2=16000");
  SearchBranch branch = slaves_and_delay(context);
  FitSummary& fitted = branch.stage.fitted;
  const auto mass = std::find_if(fitted.parameters.begin(), fitted.parameters.end(),
                                 [](const auto& p) { return p.name == "coupled_slaves.mass_kg"; });
  ASSERT_NE(mass, fitted.parameters.end());
  const auto i = mass - fitted.parameters.begin();
  fitted.at_bound[static_cast<std::size_t>(i)] = false;
  fitted.theta[i] =
      0.5 * std_errors(context.problem.data, context.problem.data.training_mask, fitted)[i];
  ASSERT_GT(fitted.theta[i], 0.0);
  substitute_idle_effects(context, branch);
  EXPECT_THAT(branch.stage.added, UnorderedElementsAre("transport_delay", "quadratic_damping"));
}

TEST(Substitution, SlavesWithAMassStay) {
  const SearchContext context = context_of(
      "motion=multisine,transport_delay.delay_s=0.003,coupled_slaves.mass_kg=20,"
      "coupled_slaves.damping_N_s_per_m=300");
  SearchBranch branch = slaves_and_delay(context);
  substitute_idle_effects(context, branch);
  EXPECT_THAT(branch.stage.added, UnorderedElementsAre("coupled_slaves", "transport_delay"));
  EXPECT_TRUE(branch.rounds.empty());
}

TEST(Substitution, OneParameterOfAirTakesThePlaceOfAResonanceWithFour) {
  // taken while the dead band still had a refinement that it did not need
  const SearchContext context = context_of(
      "motion=fast_steps,mismatched=1,deadband.half_width_V=0.3055743711,"
      "entrained_air.fraction_ratio=0.1156361578,plant.mass_kg=51.46571907,"
      "plant.damping_N_s_per_m=1041.60673,plant.bulk_modulus_Pa=708892221.3,"
      "plant.dead_volume_m3=8.140621915e-06,plant.supply_pressure_Pa=7038077.686,"
      "plant.valve_gain_m_per_V=2.792100195e-05,"
      "plant.valve_natural_frequency_rad_per_s=684.6017257,"
      "plant.valve_damping_ratio=0.6420169518",
      67706050002);
  SearchStart start = start_search(context);
  extend_search(context, start);
  EXPECT_THAT(start.branch.stage.added, UnorderedElementsAre("deadband", "entrained_air"));
}

}  // namespace
}  // namespace estimator::greybox::selection
