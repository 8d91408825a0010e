// An effect that the model has without some of its refinements: Coulomb friction alone, on a rig
// that sticks.
#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "config/record/record.h"
#include "estimator/greybox/dataset_simulation.h"
#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/revived_refinements.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::dataset_of;
using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::Gt;
using testing::IsEmpty;
using testing::Lt;

plant_sim::ModelFile axis_with(const std::vector<std::pair<std::string, double>>& values) {
  plant_sim::ModelFile model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                                     "/config/models/force_driven_axis.toml");
  for (const auto& [name, value] : values) *model.value(name) = value;
  return model;
}

std::vector<std::string> offered(const plant_sim::ModelFile& model) {
  std::vector<std::string> names;
  for (const plant_sim::EffectInfo& effect : lacking_refinements(model)) {
    for (const plant_sim::ParameterInfo& p : effect.parameters) {
      names.push_back(effect.name + "." + p.name + " " + std::to_string(p.refinement));
    }
  }
  return names;
}

TEST(LackingRefinements, AreThoseOfWhichTheModelHasNoPart) {
  EXPECT_THAT(offered(axis_with({})), IsEmpty());
  EXPECT_THAT(offered(axis_with({{"friction.coulomb_N", 20.0}})),
              ElementsAre("friction.static_N 1", "friction.stribeck_mps 1",
                          "friction.presliding_stiffness_N_per_m 2",
                          "friction.presliding_damping_N_s_per_m 2", "friction.direction_ratio 3",
                          "friction.transition_mps 4", "friction.damping_speed_mps 5"));
  // a contact with bristles turns its sign by them, and a part of a refinement is the user's choice
  EXPECT_THAT(offered(axis_with({{"friction.coulomb_N", 20.0},
                                 {"friction.presliding_stiffness_N_per_m", 1e6},
                                 {"friction.static_N", 30.0}})),
              ElementsAre("friction.direction_ratio 0", "friction.damping_speed_mps 5"));
  EXPECT_THAT(offered(axis_with(
                  {{"force_ripple.amplitude_N", 12.0}, {"force_ripple.wavelength_m", 0.016}})),
              ElementsAre("force_ripple.second_sin_N 0", "force_ripple.second_cos_N 0"));
}

TEST(LackingRefinements, AreCandidatesBesideThePlantsOwnParameters) {
  const truth::Record truth =
      truth::simulate(truth::parse_case("rig=linear_axis,motion=multisine,length_s=10", 3));
  const DiagnosisProblem problem =
      make_problem(axis_with({{"friction.coulomb_N", 20.0}}), fit_dataset({dataset_of(truth)}, {}));
  const auto& all = problem.candidate_effects;
  const auto is_friction = [](const auto& effect) { return effect.name == "friction"; };
  EXPECT_EQ(std::count_if(all.begin(), all.end(), is_friction), 1);
  const FreeParameter& own = problem.plant_parameters.back();
  EXPECT_EQ(own.name, "friction.coulomb_N");
  EXPECT_TRUE(own.in_model);
  EXPECT_FALSE(belongs_to(own, "friction"));
}

Diagnosis diagnosed(const plant_sim::ModelFile& model, const std::string& rig, std::size_t seed) {
  const truth::Record truth = truth::simulate(
      truth::parse_case("rig=linear_axis,motion=multisine,length_s=20," + rig, seed));
  return diagnose(make_problem(model, fit_dataset({dataset_of(truth)}, {})), {});
}

// The fit of static friction and bristles ends beside the truth, above the error without them.
TEST(LackingRefinements, OfAFrictionThatSticksAreFound) {
  Diagnosis d =
      diagnosed(axis_with({{"friction.coulomb_N", 20.0}}),
                "friction.coulomb_N=20,friction.static_N=30,friction.stribeck_mps=0.01", 90017);
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_THAT(d.missing, ElementsAre("friction"));
  EXPECT_THAT(d.possible, IsEmpty());
  EXPECT_LT(d.rms_after_m, 1.1 * d.noise_floor_m);
  EXPECT_NEAR(*d.better.value("friction.coulomb_N"), 20.0, 0.05);
  EXPECT_NEAR(*d.better.value("friction.static_N"), 30.0, 0.05);
  EXPECT_NEAR(*d.better.value("friction.stribeck_mps"), 0.01, 1e-4);
}

// A fixed size is no parameter of the fit; the proportion is the model's.
TEST(LackingRefinements, OfAFrictionThatSticksAreFoundBesideAFixedOne) {
  const truth::Record truth = truth::simulate(
      truth::parse_case("rig=linear_axis,motion=multisine,length_s=20,friction.coulomb_N=20,"
                        "friction.static_N=30,friction.stribeck_mps=0.01",
                        90017));
  DiagnosisProblem problem =
      make_problem(axis_with({{"friction.coulomb_N", 20.0}}), fit_dataset({dataset_of(truth)}, {}));
  std::erase_if(problem.plant_parameters,
                [](const FreeParameter& p) { return p.name == "friction.coulomb_N"; });
  Diagnosis d = diagnose(problem, {});
  EXPECT_THAT(d.missing, ElementsAre("friction"));
  EXPECT_NEAR(*d.better.value("friction.static_N"), 30.0, 0.05);
  EXPECT_LT(d.rms_after_m, 1.1 * d.noise_floor_m);
}

TEST(RevivedRefinements, StartInProportionToASizeThatIsNotFree) {
  FitSummary fitted;
  fitted.parameters = effect_parameters(*plant_sim::find_effect("friction"), 1);
  std::erase_if(fitted.parameters, [](const FreeParameter& p) { return p.refinement == 0; });
  ASSERT_EQ(fitted.parameters.front().name, "friction.static_N");
  fitted.theta = Eigen::Vector2d::Zero();
  fitted.jacobian = Eigen::MatrixXd::Zero(3, 2);
  const auto static_N = [&](double coulomb_N) {
    std::vector<double> sizes;
    for (const Eigen::VectorXd& start :
         revived_refinements(axis_with({{"friction.coulomb_N", coulomb_N}}), fitted)) {
      sizes.push_back(fitted.parameters.front().to_physical(start[0]));
    }
    return sizes;
  };
  EXPECT_THAT(static_N(20.0), Each(AllOf(Gt(20.0), Lt(60.0))));
  EXPECT_DOUBLE_EQ(static_N(40.0).at(0), 2.0 * static_N(20.0).at(0));
}

// Static friction that the file has and the rig has not: the fit brings it to nothing, and the
// better model keeps that.
TEST(LackingRefinements, AreFoundBesideOnesThatTheRigLacks) {
  const truth::Record truth = truth::simulate(
      truth::parse_case("rig=linear_axis,length_s=20,motion=multisine,friction.coulomb_N=20,"
                        "friction.presliding_stiffness_N_per_m=1e6",
                        90020));
  const FitDataset data = fit_dataset({dataset_of(truth)}, {});
  Diagnosis d = diagnose(make_problem(axis_with({{"friction.coulomb_N", 20.0},
                                                 {"friction.static_N", 30.0},
                                                 {"friction.stribeck_mps", 0.01}}),
                                      data),
                         {});
  EXPECT_THAT(d.missing, ElementsAre("friction"));
  EXPECT_THAT(d.in_file, ElementsAre("friction"));
  EXPECT_NEAR(*d.better.value("friction.presliding_stiffness_N_per_m"), 1e6, 5e3);
  EXPECT_LT(d.rms_after_m, 1.1 * d.noise_floor_m);
  DatasetSimulation run(d.better, data, {});
  Eigen::MatrixXd residuals_m;
  run.residuals(Eigen::VectorXd(0), residuals_m);
  EXPECT_LT(rms(residuals_m.col(0), data.validation_mask), 1.1 * d.noise_floor_m)
      << "the model that is written";
}

TEST(LackingRefinements, AreNotFoundWhereTheFileHasAllThatActs) {
  const Diagnosis d =
      diagnosed(axis_with({{"friction.coulomb_N", 20.0},
                           {"friction.presliding_stiffness_N_per_m", 1e6},
                           {"friction.presliding_damping_N_s_per_m", 700.0}}),
                "friction.coulomb_N=22,friction.presliding_stiffness_N_per_m=1e6", 90018);
  EXPECT_EQ(d.verdict, Verdict::nothing_missing);
}

TEST(LackingRefinements, OfOneDirectionAreFoundBesideBristlesOfTheFile) {
  Diagnosis d = diagnosed(axis_with({{"friction.coulomb_N", 20.0},
                                     {"friction.presliding_stiffness_N_per_m", 1e6},
                                     {"friction.presliding_damping_N_s_per_m", 700.0}}),
                          "friction.coulomb_N=20,friction.presliding_stiffness_N_per_m=1e6,"
                          "friction.direction_ratio=0.2",
                          90019);
  EXPECT_THAT(d.missing, ElementsAre("friction"));
  EXPECT_NEAR(*d.better.value("friction.direction_ratio"), 0.2, 0.005);
  EXPECT_LT(d.rms_after_m, 1.1 * d.noise_floor_m);
}

}  // namespace
}  // namespace estimator::greybox::selection
