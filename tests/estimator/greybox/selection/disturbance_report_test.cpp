#include "estimator/greybox/selection/disturbance_report.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "estimator/greybox/selection/conclusion.h"
#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/prediction_error.h"
#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/selection/servo_problem.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

double humming_m(double y_m, double t_s) { return y_m + 30e-6 * std::sin(107.0 * t_s); }

TEST(StructureSearchOfInnovations, HasOneErrorOfTheModelAsGiven) {
  SearchContext context = diagnose_test::servo_context(
      {.rate_mps = diagnose_test::with_offset_and_band(0.02, 0.05), .reading_m = humming_m});
  std::erase_if(context.problem.candidate_effects, [](const plant_sim::EffectInfo& effect) {
    return effect.name != "null_bias" && effect.name != "deadband";
  });
  const ModelStage first = first_stage(context);
  const InnovationSearch search = search_innovations(context, first, {first, {}});
  const StructureSearch found = structure_search_of(context, first, search);
  ASSERT_FALSE(found.final.added.empty());
  std::size_t plain = 0;
  for (const Round& round : found.rounds) {
    if (!round.before.added.empty()) continue;
    ++plain;
    EXPECT_EQ(round.before.fitted.validation_rms_m, found.path.front().fitted.validation_rms_m);
  }
  EXPECT_GT(plain, 0U);
}

TEST(StepError, TakesBackTheRandomPartThatItCauses) {
  const Disturbance found{"reading", 2e-6, 0.0, 5e-6, 0.8, {{"force", 20.0, 1.0, 4e-6, {}}}, 3e-6};
  const auto left = [&](double step_error_m, bool lines) {
    std::optional<Disturbance> disturbance = found;
    if (!lines) disturbance->lines.clear();
    drop_step_error(disturbance, step_error_m);
    return disturbance;
  };
  EXPECT_FALSE(left(2.9e-6, false));
  EXPECT_TRUE(left(1e-6, false));
  EXPECT_TRUE(left(std::nan(""), false));
  const std::optional<Disturbance> of_lines = left(2.9e-6, true);
  ASSERT_TRUE(of_lines);
  EXPECT_EQ(of_lines->value, 0.0);
  EXPECT_EQ(of_lines->as, "force");
  EXPECT_NEAR(of_lines->rms_m, 4e-6, 1e-12);  // 5^2 - 3^2 = 4^2
  EXPECT_NEAR(of_lines->share, 0.8 * 16.0 / 25.0, 1e-12);
  EXPECT_EQ(left(1e-6, true)->value, 2e-6);
}

// Friction and play let less of a disturbance through than their linearised models: what is stated
// is no more than the error that there is.
TEST(Conclusion, StatesNoDisturbanceBeyondTheError) {
  SearchContext context = diagnose_test::servo_context(
      {.rate_mps = diagnose_test::with_offset(0.0), .reading_m = humming_m});
  context.problem.candidate_effects.clear();
  const ModelStage first = first_stage(context);
  InnovationSearch search = search_innovations(context, first, {first, {}});
  ASSERT_EQ(search.final.noise.lines.size(), 1U);
  for (std::vector<Eigen::Vector2d>& waves : search.final.noise.waves) {
    for (Eigen::Vector2d& wave : waves) wave *= 1.4;
  }
  const std::optional<Disturbance> linear = disturbance_of(context, search);
  Diagnosis result;
  result.noise_floor_m = context.problem.data.noise_floor_m;
  conclude(context, context, first, search, result);
  ASSERT_TRUE(linear && result.disturbance);
  ASSERT_GT(linear->rms_m, 1.2 * result.rms_after_m);
  EXPECT_LE(result.disturbance->rms_m, result.rms_after_m);
  for (const DisturbanceLine& line : result.disturbance->lines) {
    EXPECT_LE(line.rms_m, result.disturbance->rms_m);
  }
}

/// A search for nothing but lines in a record of a model that lacks nothing else.
struct LinesOf {
  SearchContext context;
  InnovationSearch search;
  Disturbance found;
};

LinesOf lines_of(plant_sim::ModelFile model, const std::string& spec, std::size_t seed) {
  LinesOf result;
  Dataset record = diagnose_test::dataset_of(truth::simulate(truth::parse_case(spec, seed)));
  result.context.problem = make_problem(std::move(model), fit_dataset({std::move(record)}, {}));
  result.context.problem.candidate_effects.clear();
  const ModelStage first = first_stage(result.context);
  result.search = search_innovations(result.context, first, {first, {}});
  const std::optional<Disturbance> found = disturbance_of(result.context, result.search);
  EXPECT_TRUE(found);
  if (found) result.found = *found;
  add_line_rivals(result.context, result.search.final, result.found);
  return result;
}

// On a mass that moves freely a force F at the angular frequency w shakes the reading by F / (m
// w^2), as a sensor that vibrates would.
TEST(LineRivals, AForceOnAFreeMassMayBeASensorThatVibrates) {
  plant_sim::ModelFile axis = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                                    "/config/models/force_driven_axis.toml");
  const LinesOf rig = lines_of(std::move(axis),
                               "rig=linear_axis,motion=multisine,length_s=10,plant=printed,"
                               "outside.line_N=3,outside.line_Hz=17",
                               4711);
  ASSERT_EQ(rig.found.lines.size(), 1U);
  const DisturbanceLine& line = rig.found.lines.front();
  ASSERT_EQ(line.rivals.size(), 1U);
  const bool as_force = line.as == "force";
  const double force_N = as_force ? line.amplitude : line.rivals.front().amplitude;
  const double sensor_m = as_force ? line.rivals.front().amplitude : line.amplitude;
  EXPECT_EQ(line.rivals.front().as, as_force ? "sensor" : "force");
  EXPECT_NEAR(force_N, 3.0, 0.1);
  const double w_per_s = 2.0 * std::numbers::pi * 17.0;
  EXPECT_NEAR(sensor_m, 3.0 / (100.0 * w_per_s * w_per_s), 0.05e-6);
}

// The motion that a supply pressure causes turns with the valve's opening.
TEST(LineRivals, APulsationOfTheSupplyHasNone) {
  const LinesOf rig = lines_of(diagnose_test::thesis(),
                               "motion=multisine,length_s=10,plant=printed,"
                               "outside.pulsation_Pa=150000,outside.pulsation_Hz=21.3",
                               4712);
  ASSERT_EQ(rig.found.lines.size(), 1U);
  EXPECT_EQ(rig.found.lines.front().as, "pressure");
  EXPECT_THAT(rig.found.lines.front().rivals, testing::IsEmpty());
}

// The errors of the predictions themselves, before they are scaled.
TEST(PredictionError, IsThatOfTheReadingsPredicted) {
  SearchContext context = diagnose_test::context_of(
      "motion=multisine,length_s=6,outside.force_N=20,outside.corner_Hz=2", 21);
  context.problem.candidate_effects.clear();
  const InnovationStage stage =
      settled(context, first_stage(context), {}, Settling::once, SimulationWidth{});
  const FitSummary& fitted = stage.model.fitted;
  const Dataset& record = stage.context.problem.data.records.front();
  ObserverSimulation run(context.problem.model, record, fitted.parameters);
  Eigen::MatrixXd residuals;
  run.residuals(fitted.theta, residuals);
  double sum_m2 = 0.0;
  double counted = 0.0;
  for (std::size_t k = 0; k < record.size(); ++k) {
    if (record.valid[k] == 0) continue;
    sum_m2 += std::pow(record.y_m[k] - run.predicted().reading_m[k], 2);
    counted += 1.0;
  }
  const double expected_m = std::sqrt(sum_m2 / counted);
  EXPECT_NEAR(prediction_rms_m(stage), expected_m, 1e-6 * expected_m);
  EXPECT_GT(expected_m, context.problem.data.noise_floor_m);
}

}  // namespace
}  // namespace estimator::greybox::selection
