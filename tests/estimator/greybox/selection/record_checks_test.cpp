// Records of the independent simulator with what users get wrong in theirs.
#include "estimator/greybox/selection/record_checks.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <memory>

#include "estimator/greybox/observer_simulation.h"
#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/structure_search.h"
#include "estimator/greybox/selection/two_areas.h"
#include "plant_sim/plant.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::context_with;
using diagnose_test::dataset_of;

Dataset record() {
  return dataset_of(truth::simulate(truth::parse_case("motion=multisine,length_s=10", 51)));
}

RecordChecks checked(Dataset data) {
  const SearchContext context = context_with(std::move(data));
  return check_records(context, first_stage(context).fitted.validation_rms_m);
}

TEST(RecordChecks, ATurnedCommandIsNoticed) {
  Dataset turned = record();
  for (double& u_V : turned.u_V) u_V = -u_V;
  const RecordChecks checks = checked(turned);
  EXPECT_TRUE(checks.turned_sign());
  ASSERT_EQ(checks.responses.size(), 1U);
  EXPECT_TRUE(checks.responses.front().against_command());
  EXPECT_FALSE(checked(record()).turned_sign());
}

TEST(RecordChecks, OneOfTwoRecordingsWhoseCommandIsTurnedIsNoticed) {
  Dataset good = record();
  good.name = "good.csv";
  Dataset turned = good;
  turned.name = "turned.csv";
  for (double& u_V : turned.u_V) u_V = -u_V;
  SearchContext context = context_with(good);
  context.problem.data = fit_dataset({good, turned}, {});
  const RecordChecks checks = check_records(context, 1.0);
  EXPECT_TRUE(checks.records_differ);
  EXPECT_TRUE(checks.misread());
  EXPECT_FALSE(checks.turned_sign());
}

TEST(RecordChecks, APositionThatLiesWithinTheStrokeWhenTurnedIsNoticed) {
  Dataset turned = record();
  for (double& y_m : turned.y_m) y_m = -y_m;
  EXPECT_TRUE(checked(turned).position_turned);
  EXPECT_TRUE(checked(turned).misread());
  for (double& u_V : turned.u_V) u_V = -u_V;
  EXPECT_FALSE(checked(turned).position_turned) << "the zero of a sensor that follows the command";
}

TEST(RecordChecks, APositionOutsideTheStrokeIsNoticed) {
  Dataset off = record();
  for (double& y_m : off.y_m) y_m -= 0.305;
  const RecordChecks checks = checked(off);
  EXPECT_LT(checks.below_m, 0.0);
  EXPECT_EQ(checks.beyond_m, 0.0);
  EXPECT_FALSE(checked(record()).outside_stroke());
}

TEST(RecordChecks, AThousandthOfTheMotionThatNoFitMakesUpForIsNoticed) {
  Dataset small = record();
  const double begin_m = small.y_m.front();
  for (double& y_m : small.y_m) y_m = begin_m + 1e-3 * (y_m - begin_m);
  const SearchContext context = context_with(std::move(small));
  constexpr double kNotMadeUp_m = 1.0;
  EXPECT_TRUE(check_records(context, kNotMadeUp_m).wrong_scale);
  EXPECT_FALSE(check_records(context, 1e-9).wrong_scale);
  EXPECT_FALSE(checked(record()).misread());
}

TEST(RecordChecks, MillimetresTakenForMetresAreNoticedByTheStroke) {
  Dataset large = record();
  for (double& y_m : large.y_m) y_m *= 1000.0;
  EXPECT_TRUE(checked(large).wrong_scale);
}

TEST(RecordChecks, AFirstSampleFarOffIsNoUnit) {
  Dataset far = record();
  far.y_m.front() = 65.535;
  EXPECT_FALSE(check_records(context_with(std::move(far)), 1.0).wrong_scale);
}

TEST(RecordChecks, AMisreadRecordIsNotSearched) {
  Dataset exchanged = record();
  std::swap(exchanged.u_V, exchanged.y_m);
  const SearchContext context = context_with(std::move(exchanged));
  const Diagnosis found = diagnose(context.problem, context.options);
  EXPECT_EQ(found.verdict, Verdict::unexplained);
  EXPECT_TRUE(found.checks && found.checks->misread());
  EXPECT_TRUE(found.search.rounds.empty());
  EXPECT_TRUE(found.where.empty());
}

TEST(RecordChecks, ExchangedColumnsAreNoticed) {
  Dataset exchanged = record();
  std::swap(exchanged.u_V, exchanged.y_m);
  const RecordChecks checks = checked(exchanged);
  EXPECT_TRUE(checks.columns_exchanged);
  EXPECT_TRUE(checks.misread());
  EXPECT_FALSE(checks.turned_sign());
}

/// The positions as they are, the command by `shift` samples late.
Dataset command_late(const Dataset& whole, std::size_t shift) {
  const auto ahead = static_cast<std::ptrdiff_t>(shift);
  return estimator::greybox::dataset_of(whole.sample_time_s,
                                        {whole.u_V.begin(), whole.u_V.end() - ahead},
                                        {whole.y_m.begin() + ahead, whole.y_m.end()});
}

TEST(RecordChecks, ACommandThatIsLoggedLateIsNoticedToTheSample) {
  const Dataset whole = record();
  const RecordChecks checks = checked(command_late(whole, 8));
  EXPECT_NEAR(checks.command_late_s, 8.0 * whole.sample_time_s, 1e-12);
  EXPECT_TRUE(checks.misread());
  EXPECT_EQ(checked(whole).command_late_s, 0.0);
}

TEST(RecordChecks, OneOfTwoRecordingsWhoseCommandIsLoggedLateDoesNotShiftBoth) {
  Dataset good = record();
  good.name = "good.csv";
  Dataset late = command_late(good, 8);
  late.name = "late.csv";
  const auto late_s = [](const Dataset& one, const Dataset& other) {
    SearchContext context = context_with(one);
    context.problem.data = fit_dataset({one, other}, {});
    return check_records(context, first_stage(context).fitted.validation_rms_m).command_late_s;
  };
  EXPECT_EQ(late_s(good, late), 0.0);
  EXPECT_EQ(late_s(late, good), 0.0);
  SearchContext mixed = context_with(good);
  mixed.problem.data = fit_dataset({good, late}, {});
  EXPECT_TRUE(check_records(mixed, first_stage(mixed).fitted.validation_rms_m).records_differ);
  Dataset other_late = late;
  other_late.name = "other.csv";
  EXPECT_NEAR(late_s(late, other_late), 8.0 * good.sample_time_s, 1e-12);
}

// An offset makes the model drift by far more than the shift changes its error.
TEST(RecordChecks, ACommandThatIsLoggedLateIsNoticedBesideAnEffect) {
  const Dataset whole = dataset_of(truth::simulate(
      truth::parse_case("motion=multisine,length_s=10,null_bias.offset_V=0.1", 52)));
  const RecordChecks checks = checked(command_late(whole, 4));
  EXPECT_NEAR(checks.command_late_s, 4.0 * whole.sample_time_s, 1e-12);
  EXPECT_EQ(checked(whole).command_late_s, 0.0);
}

/// Rod side over cap side of a fitted hydraulic_cylinder, whose cap side is the model file's area.
double rod_side_ratio(const PlantFit& cylinder) {
  const auto area = std::find_if(cylinder.values.begin(), cylinder.values.end(),
                                 [](const auto& one) { return one.name == "rod_side_area_m2"; });
  return area == cylinder.values.end() ? 0.0
                                       : area->value / *diagnose_test::thesis().value("area_m2");
}

// A valve and its cylinder follow the command by speed: a servo comes near, an axis does not.
TEST(RecordChecks, TheOtherPlantsAreRankedByWhatTheyLeave) {
  const std::vector<PlantFit> plants = fit_other_plants(context_with(record()));
  ASSERT_EQ(plants.size(), 3U);
  EXPECT_EQ(plants[0].plant, "hydraulic_cylinder");  // the given one with a free rod side
  EXPECT_NEAR(rod_side_ratio(plants[0]), 1.0, 0.01);
  EXPECT_EQ(plants[1].plant, "velocity_servo");
  EXPECT_LT(3.0 * plants[1].validation_rms_m, plants[2].validation_rms_m);
}

Eigen::VectorXd residual_m(const plant_sim::ModelFile& model, const Dataset& data) {
  ObserverSimulation run(model, data, {});
  Eigen::MatrixXd residuals_m;
  run.residuals(Eigen::MatrixXd(0, 1), residuals_m);
  return residuals_m.col(0);
}

TEST(RecordChecks, TheSameNumbersAsATwoAreaCylinderMoveAlike) {
  const SearchContext context = context_with(record());
  plant_sim::ModelFile actuator = context.problem.model;
  *actuator.value("extended_cushion_length_m") = 0.29;  // within the motion
  plant_sim::ModelFile cylinder = with_two_areas(actuator);
  const Dataset& data = context.problem.data.records.front();
  const Eigen::VectorXd one_m = residual_m(actuator, data);
  EXPECT_LT((residual_m(cylinder, data) - one_m).cwiseAbs().maxCoeff(), 1e-9);
  *cylinder.value("rod_side_area_m2") *= 0.9;
  EXPECT_GT((residual_m(cylinder, data) - one_m).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(RecordChecks, ARodThatFillsOneSideIsFound) {
  plant_sim::ModelFile rod = with_two_areas(diagnose_test::thesis());
  *rod.value("rod_side_area_m2") *= 0.7;
  const std::unique_ptr<plant_sim::Plant> plant = plant_sim::make_plant(rod);
  Dataset data = record();
  for (std::size_t k = 0; k < data.size(); ++k) {
    data.y_m[k] = plant->reading_m();
    data.u_V[k] -= 100.0 * (data.y_m[k] - 0.305);  // stays within the stroke
    plant->advance(data.u_V[k], data.sample_time_s);
  }
  const std::vector<PlantFit> plants = fit_other_plants(context_with(std::move(data)));
  ASSERT_FALSE(plants.empty());
  EXPECT_EQ(plants.front().plant, "hydraulic_cylinder");
  EXPECT_NEAR(rod_side_ratio(plants.front()), 0.7, 0.01);
}

}  // namespace
}  // namespace estimator::greybox::selection
