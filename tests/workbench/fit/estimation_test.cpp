#include "estimator/greybox/estimation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/workbench/fit/truth_record.h"
#include "workbench/fit/fit_report.h"

namespace workbench::fit {

namespace greybox = estimator::greybox;
namespace {

using testing::HasSubstr;
using workbench_test::parameter;
using workbench_test::problem;
using workbench_test::without_profiles;

const std::string kModels = SPOOLWATCH_SOURCE_DIR "/config/models/";

truth::Case healthy(const std::string& more, std::size_t seed = 3) {
  return truth::parse_case("motion=multisine,length_s=15," + more, seed);
}

/// y' = k u exactly: what is fitted is linear in k, so that weighted least squares has closed
/// forms. Steps of the record are short enough for the observer to be left out.
struct Straight {
  static constexpr double kGain = 0.05;
  static constexpr double kNoise_m = 20e-6;

  explicit Straight(double start) {
    std::mt19937_64 engine(5);
    std::normal_distribution<double> noise(0.0, kNoise_m);
    config::record::Record record;
    record.name = "straight";
    record.sample_time_s = 0.005;
    double y_m = 0.0;
    for (int k = 0; k < 2000; ++k) {
      record.t_s.push_back(0.005 * k);
      record.y_m.push_back(y_m + (k == 0 ? 0.0 : noise(engine)));
      reach_Vs.push_back(y_m / kGain);
      record.u_V.push_back(std::sin(2.0 * 0.005 * k) + 0.3 * std::sin(9.0 * 0.005 * k));
      y_m += 0.005 * kGain * record.u_V.back();
    }
    made = greybox::dataset_of(record);
    model = plant_sim::load_model(kModels + "velocity_servo.toml");
    *model.value("gain_mps_per_V") = start;
    *model.value("time_constant_s") = 0.0;
  }

  greybox::EstimationProblem fit(const ParameterSelection& selection) const {
    greybox::EstimationProblem t;
    t.model = model;
    const FreeParameters choice = select_parameters(model, selection);
    t.parameters = choice.parameters;
    t.start = choice.start;
    t.data = greybox::fit_dataset({made}, {});
    t.weights = t.data.all_mask;
    t.data.validation_mask.setZero();
    return t;
  }
  static greybox::EstimationOptions options() {
    greybox::EstimationOptions pure = without_profiles();
    pure.observer_per_s = 0.0;
    return pure;
  }
  /// sum w x^2 and sum w x y of y = gain x.
  std::pair<double, double> sums(const Eigen::VectorXd& weights) const {
    double xx = 0.0;
    double xy = 0.0;
    for (std::size_t k = 0; k < reach_Vs.size(); ++k) {
      const double w = weights[static_cast<Eigen::Index>(k)];
      xx += w * reach_Vs[k] * reach_Vs[k];
      xy += w * reach_Vs[k] * made.y_m[k];
    }
    return {xx, xy};
  }

  std::vector<double> reach_Vs;
  greybox::Dataset made;
  plant_sim::ModelFile model;
};

TEST(FitEstimation, IsWeightedLeastSquaresWhereTheModelIsLinear) {
  const Straight line(0.03);
  greybox::EstimationProblem t =
      line.fit({.free = {"gain_mps_per_V"}, .priors = {"gain_mps_per_V=none"}});
  t.weights.head(1000) *= 4.0;
  const greybox::EstimationSummary e = greybox::estimate(t, Straight::options());
  const auto [xx, xy] = line.sums(t.weights);
  const greybox::EstimatedParameter& gain = parameter(e, "gain_mps_per_V");
  // To the search's tolerance, a hundredth of the standard error.
  EXPECT_NEAR(gain.value, xy / xx, 1e-2 * gain.std_error);
  EXPECT_EQ(e.starts.same, 4);
  // Sandwich of two weights: var = s^2 sum w^2 x^2 / (sum w x^2)^2.
  Eigen::VectorXd square = t.weights.array().square();
  const double expected = Straight::kNoise_m * std::sqrt(line.sums(square).first) / xx;
  EXPECT_NEAR(gain.std_error / expected, 1.0, 0.1);
}

TEST(FitEstimation, APriorPullsAsBayesHasIt) {
  const Straight line(0.05);
  // As narrow as what the record says: the answer is half way.
  const auto [xx, xy] = line.sums(line.fit({}).weights);
  const double own = Straight::kNoise_m / std::sqrt(xx);
  const double mean = xy / xx + 4.0 * own;
  char prior[80];
  std::snprintf(prior, sizeof prior, "gain_mps_per_V=%.17g+-%.17g", mean, own);
  const greybox::EstimationSummary e = greybox::estimate(
      line.fit({.free = {"gain_mps_per_V"}, .priors = {prior}}), Straight::options());
  const greybox::EstimatedParameter& gain = parameter(e, "gain_mps_per_V");
  EXPECT_NEAR((gain.value - xy / xx) / own, 2.0, 0.15);
  EXPECT_NEAR(gain.std_error / own, std::sqrt(0.5), 0.1);
  EXPECT_NEAR(gain.record_share, 0.5, 0.1);
}

TEST(FitEstimation, StopsAtABoundAndSaysSo) {
  const Straight line(0.03);
  const greybox::EstimationSummary e = greybox::estimate(
      line.fit({.free = {"gain_mps_per_V"}, .bounds = {"gain_mps_per_V=0.01:0.04"}}),
      Straight::options());
  const greybox::EstimatedParameter& gain = parameter(e, "gain_mps_per_V");
  EXPECT_NEAR(gain.value, 0.04, 1e-12);
  EXPECT_EQ(gain.at_bound, 1);
  EXPECT_TRUE(std::isnan(gain.std_error));
}

TEST(FitEstimation, TheProfileOfAParabolaIsTheNormalInterval) {
  const Straight line(0.05);
  greybox::EstimationProblem t =
      line.fit({.free = {"gain_mps_per_V"}, .priors = {"gain_mps_per_V=none"}});
  greybox::EstimationOptions options = Straight::options();
  const greybox::EstimationSummary plain = greybox::estimate(t, options);
  options.profiling = greybox::Profiling::named;
  options.profiled = {"gain_mps_per_V"};
  const greybox::EstimationSummary walked = greybox::estimate(t, options);
  const greybox::EstimatedParameter& a = plain.parameters[0];
  const greybox::EstimatedParameter& b = walked.parameters[0];
  EXPECT_TRUE(b.from_profile);
  EXPECT_NEAR(b.low, a.low, 0.1 * a.std_error);
  EXPECT_NEAR(b.high, a.high, 0.1 * a.std_error);
}

TEST(FitEstimation, FindsAnotherPlantsParametersWithinItsErrors) {
  const auto model = plant_sim::load_model(kModels + "thesis.toml");
  const truth::Case of = healthy("");
  const greybox::EstimationSummary e =
      greybox::estimate(problem(model, of, {}), without_profiles());
  for (const truth::PlantField& field : truth::plant_fields(truth::Kind::actuator)) {
    const greybox::EstimatedParameter& p = parameter(e, field.name);
    EXPECT_LT(std::abs(p.value - of.plant.*field.member), 3.5 * p.std_error) << field.name;
  }
  EXPECT_LT(e.after.rms_m, 1.1 * e.fitted.sigma_m);
  EXPECT_GT(e.before.rms_m, 3.0 * e.after.rms_m);
  EXPECT_GT(e.after.fit_percent, e.before.fit_percent);
  EXPECT_EQ(e.starts.tried, 4);
  EXPECT_EQ(e.starts.same + e.starts.elsewhere, 4);
}

TEST(FitEstimation, SaysThatOnlyGainTimesTheRootOfThePressureIsVisible) {
  const auto model = plant_sim::load_model(kModels + "thesis.toml");
  const greybox::EstimationSummary e =
      greybox::estimate(problem(model, healthy(""), {}), without_profiles());
  for (const greybox::IdentifiabilityReport* report :
       {&e.identifiability_before, &e.identifiability_after}) {
    ASSERT_FALSE(report->unidentifiable.empty());
    const auto pressure = [&e](const greybox::UnidentifiableParameter& u) {
      return e.parameters[u.parameter].free.name == "supply_pressure_Pa";
    };
    const auto found =
        std::find_if(report->unidentifiable.begin(), report->unidentifiable.end(), pressure);
    ASSERT_NE(found, report->unidentifiable.end());
    EXPECT_THAT(workbench::fit::visible_words(*found, e.parameters),
                HasSubstr("valve_gain_m_per_V * sqrt(supply_pressure_Pa)"));
    EXPECT_THAT(workbench::fit::unidentifiable_words(*found, e.parameters),
                HasSubstr("its prior holds supply_pressure_Pa"));
  }
}

TEST(FitEstimation, SaysThatOnlyRatiosOfAMassADampingAndAForceAreVisible) {
  // M v' = gain u - d v: the motion is that of gain/M and d/M alone.
  greybox::EstimationProblem t = Straight(0.05).fit({});
  greybox::EstimationOptions options = without_profiles();
  t.model = plant_sim::load_model(kModels + "force_driven_axis.toml");
  const FreeParameters choice =
      select_parameters(t.model, {.free = {"mass_kg", "damping_N_s_per_m", "gain_N_per_V"},
                                  .priors = {"mass_kg=100+-10", "damping_N_s_per_m=none"}});
  t.parameters = choice.parameters;
  t.start = choice.start;
  options.starts = 1;
  const greybox::EstimationSummary e = greybox::estimate(t, options);
  ASSERT_FALSE(e.identifiability_before.unidentifiable.empty());
  const greybox::UnidentifiableParameter& first = e.identifiability_before.unidentifiable[0];
  EXPECT_EQ(first.partners.size(), 2U) << workbench::fit::unidentifiable_words(first, e.parameters);
  EXPECT_THAT(workbench::fit::visible_words(first, e.parameters), HasSubstr(" / "));
}

TEST(FitEstimation, StopsWhenAskedAndKeepsTheBestSoFar) {
  const auto model = plant_sim::load_model(kModels + "thesis.toml");
  greybox::EstimationProblem t = problem(model, healthy(""), {});
  greybox::EstimationOptions options = without_profiles();
  int asked = 0;
  options.threads = 1;
  options.cancel = [&] { return ++asked > 3; };
  const greybox::EstimationSummary e = greybox::estimate(t, options);
  EXPECT_TRUE(e.interrupted);
  EXPECT_LE(e.after.rms_m, e.before.rms_m);
  EXPECT_TRUE(std::isfinite(parameter(e, "valve_gain_m_per_V").std_error));
}

TEST(FitEstimation, GivesTheSameAnswerWhateverTheThreads) {
  const auto model = plant_sim::load_model(kModels + "thesis.toml");
  greybox::EstimationProblem t = problem(model, healthy("", 4), {});
  greybox::EstimationOptions options = without_profiles();
  const greybox::EstimationSummary one = [&] {
    options.threads = 1;
    return greybox::estimate(t, options);
  }();
  options.threads = 2;
  const greybox::EstimationSummary two = greybox::estimate(t, options);
  for (std::size_t i = 0; i < one.parameters.size(); ++i) {
    EXPECT_NEAR(one.parameters[i].value, two.parameters[i].value,
                0.02 * one.parameters[i].std_error);
  }
  const greybox::EstimationSummary again = greybox::estimate(t, options);
  EXPECT_EQ(again.parameters[1].value, two.parameters[1].value);
}

}  // namespace
}  // namespace workbench::fit
