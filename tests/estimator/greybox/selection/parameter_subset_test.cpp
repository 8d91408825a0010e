// Effects whose values are at the bound of what they can be.
#include "estimator/greybox/selection/parameter_subset.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "estimator/greybox/selection/alternative_refinements.h"

namespace estimator::greybox::selection {
namespace {

/// A resonance of the given size and damping, either of which may be at its bound.
FitSummary resonance(double mass_ratio, int mass_bound, double damping_ratio, int damping_bound) {
  FitSummary fitted;
  fitted.parameters.resize(2);
  fitted.parameters[0].name = "second_mass.mass_ratio";
  fitted.parameters[1].name = "second_mass.damping_ratio";
  fitted.theta = Eigen::Vector2d(mass_ratio, damping_ratio);
  fitted.at_bound = {mass_bound, damping_bound};
  return fitted;
}

TEST(LeavesItsRange, AResonanceWithoutDampingStandsForSomethingElse) {
  EXPECT_FALSE(leaves_its_range(resonance(0.2, 0, 0.03, 0), 0));
  EXPECT_TRUE(leaves_its_range(resonance(0.2, 0, 0.0, -1), 0));
  EXPECT_TRUE(leaves_its_range(resonance(0.2, 0, 1e-5, 0), 0));
  EXPECT_TRUE(leaves_its_range(resonance(0.95, 1, 0.03, 0), 0));
  EXPECT_FALSE(leaves_its_range(resonance(0.0, -1, 0.03, 0), 0));  // absent
}

TEST(IdleRefinements, AreDroppedFromAddedEffectsAlone) {
  FitSummary fitted;
  fitted.parameters.resize(2);
  fitted.parameters[0].name = "friction.coulomb_N";
  fitted.parameters[1].name = "friction.static_N";
  fitted.parameters[1].refinement = 1;
  fitted.theta = Eigen::Vector2d(0.5, 0.0);
  fitted.at_bound = {0, -1};
  fitted.jacobian = Eigen::MatrixXd::Ones(3, 2);
  // a model file's own effect keeps them: its value in the file would come back
  drop_idle_refinements({}, fitted);
  EXPECT_EQ(fitted.parameters.size(), 2U);
  drop_idle_refinements({"friction"}, fitted);
  ASSERT_EQ(fitted.parameters.size(), 1U);
  EXPECT_EQ(fitted.parameters[0].name, "friction.coulomb_N");
  EXPECT_EQ(fitted.jacobian.cols(), 1);
}

TEST(IdleRefinements, OfTheFileStayWhereTheEffectIsSoughtToo) {
  FitSummary fitted;
  fitted.parameters.resize(2);
  fitted.parameters[0].name = "friction.static_N";
  fitted.parameters[0].refinement = 1;
  fitted.parameters[0].in_model = true;
  fitted.parameters[1].name = "friction.presliding_stiffness_N_per_m";
  fitted.parameters[1].refinement = 2;
  fitted.theta = Eigen::Vector2d(0.0, 1.0);
  fitted.at_bound = {-1, 0};
  fitted.jacobian = Eigen::MatrixXd::Ones(3, 2);
  drop_idle_refinements({"friction"}, fitted);
  EXPECT_EQ(fitted.parameters.size(), 2U) << "the file's value would come back";
  std::vector<std::string> added{"friction", "backlash"};
  drop_empty_effects(added, fitted);
  EXPECT_EQ(added, std::vector<std::string>{"friction"});
  fitted.parameters.pop_back();
  drop_empty_effects(added, fitted);
  EXPECT_TRUE(added.empty()) << "what is left of it is the file's";
}

/// A friction that turns gradually, over a width of which 0.05 is the least.
FitSummary gradual_friction(double width) {
  FitSummary fitted;
  fitted.parameters.resize(3);
  fitted.parameters[0].name = "friction.coulomb_N";
  fitted.parameters[1].name = "friction.transition_mps";
  fitted.parameters[1].instead_of = 1;
  fitted.parameters[1].lower = 0.05;
  fitted.parameters[2].name = "friction.stribeck_mps";
  fitted.theta = Eigen::Vector3d(0.0, width, 0.0);
  return fitted;
}

TEST(WithoutLeast, DropsAnAlternativeAtItsLeastAlone) {
  EXPECT_FALSE(ends_at_least(gradual_friction(0.06)));
  EXPECT_EQ(without_least(gradual_friction(0.06), {"friction"}).parameters.size(), 3u);
  EXPECT_TRUE(ends_at_least(gradual_friction(0.05)));
  const ParameterSubset rest = without_least(gradual_friction(0.05), {"friction"});
  ASSERT_EQ(rest.parameters.size(), 2u);
  EXPECT_EQ(rest.parameters[0].name, "friction.coulomb_N");
  EXPECT_EQ(rest.parameters[1].name, "friction.stribeck_mps");
  EXPECT_EQ(rest.start, Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(without_least(gradual_friction(0.05), {}).parameters.size(), 3u);  // the file's own
}

TEST(WrapPhases, ALibraryPhaseEndsWithinHalfATurnWhereItMay) {
  const auto wrapped = [](const char* name, double phase_rad, double lower, double prior_sd) {
    FitSummary fitted;
    fitted.parameters.resize(1);
    fitted.parameters[0].name = name;
    fitted.parameters[0].unit = 1.0;
    fitted.parameters[0].lower = lower;
    fitted.parameters[0].upper = 6.3;
    fitted.parameters[0].prior_sd = prior_sd;
    fitted.theta = Eigen::VectorXd::Constant(1, phase_rad);
    fitted.at_bound = {0};
    wrap_phases(fitted);
    return fitted.theta[0];
  };
  constexpr double kNoPrior = std::numeric_limits<double>::infinity();
  constexpr double kTurn = 2.0 * std::numbers::pi;
  EXPECT_NEAR(wrapped("force_ripple.phase_rad", 5.0, -6.3, kNoPrior), 5.0 - kTurn, 1e-12);
  EXPECT_NEAR(wrapped("encoder_eccentricity.phase_rad", -4.0, -6.3, kNoPrior), kTurn - 4.0, 1e-12);
  EXPECT_EQ(wrapped("force_ripple.phase_rad", 5.0, 3.0, kNoPrior), 5.0);  // out of its range
  EXPECT_EQ(wrapped("force_ripple.phase_rad", 5.0, -6.3, 0.1), 5.0);      // has a prior
  EXPECT_EQ(wrapped("my_formula.phase_rad", 5.0, -6.3, kNoPrior), 5.0);   // may have another period
}

}  // namespace
}  // namespace estimator::greybox::selection
