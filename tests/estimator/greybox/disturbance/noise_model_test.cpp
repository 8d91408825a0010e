// Noise models and searches on records of the independent simulator (tests/truth), disturbed.
#include "estimator/greybox/disturbance/noise_model.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::disturbance {
namespace {

using diagnose_test::context_of;

TEST(NoiseModel, ARandomForceIsMeasured) {
  const selection::SearchContext context =
      context_of("motion=multisine,length_s=20,outside.force_N=30,outside.corner_Hz=3", 41);
  const selection::ModelStage first = selection::first_stage(context);
  const Linearisations linear = linearise(context.problem.model, context.problem.data,
                                          first.fitted.parameters, first.fitted.theta);
  const NoiseEstimate found =
      estimate_noise(context.problem.model, context.problem.data, first.fitted.parameters,
                     first.fitted.theta, linear, {}, 2);
  const double intensity =
      found.noise.noise.disturbance_sd * std::sqrt(found.noise.noise.corner_Hz);
  EXPECT_NEAR(intensity, 30.0 * std::sqrt(3.0), 0.25 * 30.0 * std::sqrt(3.0));
}

// A linear encoder of 0.1 um on an axis of little damping: the force moves it by millimetres.
TEST(NoiseModel, ARandomForceFarAboveTheSensorsNoiseIsMeasured) {
  const truth::Record record = truth::simulate(
      truth::parse_case("rig=linear_axis,motion=multisine,length_s=20,encoder_m=1e-7,noise_m=3e-7,"
                        "outside.force_N=10,outside.corner_Hz=2",
                        44));
  const auto model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                           "/config/models/force_driven_axis.toml");
  const selection::SearchContext context{
      selection::make_problem(model, fit_dataset({diagnose_test::dataset_of(record)}, {})), {}};
  const selection::InnovationStage stage = selection::settled(
      context, selection::first_stage(context), {}, selection::Settling::fully, wide(2));
  const NoiseParameters& found = stage.noise.noise;
  const double intensity = found.disturbance_sd * std::sqrt(found.corner_Hz);
  EXPECT_NEAR(intensity, 10.0 * std::sqrt(2.0), 0.1 * 10.0 * std::sqrt(2.0));
  EXPECT_LT(found.walk_m, 1e-7);
}

// Differences of the readings take a fast resonance for the sensor's noise.
TEST(NoiseModel, TheSensorsNoiseIsFoundFarBelowAFloorThatIsTooHigh) {
  selection::SearchContext context =
      context_of("motion=multisine,length_s=20,outside.force_N=30,outside.corner_Hz=3", 45);
  context.problem.data.noise_floor_m *= 6.0;
  const selection::InnovationStage stage = selection::settled(
      context, selection::first_stage(context), {}, selection::Settling::fully, wide(2));
  constexpr double kSensor_m = 2.46e-6;  // 2 um, and an encoder of 5 um
  EXPECT_NEAR(stage.noise.noise.sensor_m, kSensor_m, 0.1 * kSensor_m);
}

TEST(NoiseModel, TheLikeliestOneDoesNotDependOnTheStart) {
  const selection::SearchContext context = context_of(
      "motion=multisine,length_s=20,outside.force_N=20,outside.corner_Hz=5,"
      "outside.shake_m=1e-5,outside.shake_Hz=41.3",
      43);
  const selection::ModelStage first = selection::first_stage(context);
  const Linearisations linear = linearise(context.problem.model, context.problem.data,
                                          first.fitted.parameters, first.fitted.theta);
  const double noise_m = context.problem.data.noise_floor_m;
  std::vector<double> costs;
  for (const double sd_N : {0.3, 20.0, 300.0}) {
    for (const double corner_Hz : {0.2, 30.0}) {
      NoiseModel start;
      start.lines = {{LineSite::sensor, 41.3}};
      start.noise = {sd_N, corner_Hz, 0.1 * noise_m, 1.5 * noise_m};
      costs.push_back(estimate_noise(context.problem.model, context.problem.data,
                                     first.fitted.parameters, first.fitted.theta, linear, start, 2)
                          .minus_two_log_likelihood);
    }
  }
  const auto [least, most] = std::minmax_element(costs.begin(), costs.end());
  EXPECT_LT(*most - *least, 0.5);
}

TEST(NoiseModel, ASearchUnderDisturbanceIsTheSameForAnyNumberOfThreads) {
  selection::SearchContext context =
      context_of("motion=multisine,length_s=10,deadband.half_width_V=0.15,outside.force_N=30", 42);
  std::vector<double> costs;
  std::vector<Eigen::VectorXd> thetas;
  for (const unsigned threads : {1U, 2U, 5U}) {
    context.options.threads = threads;
    const selection::InnovationSearch search =
        selection::search_innovations(context, selection::first_stage(context), {});
    EXPECT_THAT(search.final.model.added, testing::ElementsAre("deadband"));
    costs.push_back(search.final.minus_two_log);
    thetas.push_back(search.final.model.fitted.theta);
  }
  EXPECT_EQ(costs[0], costs[1]);
  EXPECT_EQ(costs[0], costs[2]);
  EXPECT_EQ(thetas[0], thetas[1]);
  EXPECT_EQ(thetas[0], thetas[2]);
}

}  // namespace
}  // namespace estimator::greybox::disturbance
