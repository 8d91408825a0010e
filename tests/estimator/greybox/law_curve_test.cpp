// Curves of formulas against their closed forms.
#include "estimator/greybox/law_curve.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace estimator::greybox {
namespace {

/// A rod that swings by 0.05 m about 0.2 m at 1 Hz.
FitDataset swinging() {
  std::vector<double> u_V;
  std::vector<double> y_m;
  for (int k = 0; k < 2000; ++k) {
    const double phase = 2.0 * M_PI * 0.005 * k;
    u_V.push_back(3.0 * std::cos(phase));
    y_m.push_back(0.2 + 0.05 * std::sin(phase));
  }
  return fit_dataset({dataset_of(0.005, u_V, y_m)}, {});
}

plant_sim::ModelFile with_formula(const std::string& plant, const std::string& site,
                                  const std::string& formula,
                                  const std::vector<std::pair<std::string, double>>& values) {
  plant_sim::ModelFile model =
      plant_sim::load_model(SPOOLWATCH_SOURCE_DIR "/config/models/" + plant + ".toml");
  plant_sim::formula::FormulaEffect effect{"law", site, formula, "", {}, "", {}};
  for (const auto& [name, value] : values)
    effect.parameters.push_back({name, "", -1e6, 1e6, 1.0, 0.0});
  model.declare(effect, "test");
  for (const auto& [name, value] : values) *model.value("law." + name) = value;
  return model;
}

TEST(LawCurve, OfOneParameterScalesItsStandardError) {
  const plant_sim::ModelFile model = with_formula(
      "force_driven_axis", "force", "c_N_s3_per_m3 * v_mps^3", {{"c_N_s3_per_m3", 800.0}});
  const LawCurve curve = law_curve(model, swinging(), "law", "v", Eigen::VectorXd::Constant(1, 4.0),
                                   Eigen::MatrixXd::Constant(1, 1, 16.0));
  EXPECT_EQ(curve.variable, "v_mps");
  EXPECT_EQ(curve.quantity, "force_N");
  EXPECT_FALSE(curve.held.has_value());
  ASSERT_EQ(curve.f.size(), curve.x.size());
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double cube = std::pow(curve.x[i], 3);
    EXPECT_NEAR(curve.f[i], 800.0 * cube, 1e-9);
    EXPECT_NEAR(curve.std_error[i], 4.0 * std::abs(cube), 1e-6 * std::abs(cube) + 1e-12);
  }
  // as far as the record goes: the speed's amplitude, less what its smoothing over 50 ms takes off
  EXPECT_NEAR(curve.x.back(), 2.0 * M_PI * 0.05, 0.02 * 2.0 * M_PI * 0.05);
}

TEST(LawCurve, TakesTheCorrelationOfParametersIntoItsBand) {
  const plant_sim::ModelFile model = with_formula(
      "force_driven_axis", "force", "a * v_mps + b * v_mps^2", {{"a", 10.0}, {"b", -3.0}});
  const Eigen::Vector2d errors(0.5, 2.0);
  Eigen::Matrix2d covariance;
  covariance << 0.25, -0.9, -0.9, 4.0;
  const LawCurve known = law_curve(model, swinging(), "law", "v", errors, covariance);
  const LawCurve worst = law_curve(model, swinging(), "law", "v", errors, Eigen::MatrixXd());
  for (std::size_t i = 0; i < known.x.size(); ++i) {
    const double v = known.x[i];
    const double variance = 0.25 * v * v - 1.8 * v * v * v + 4.0 * v * v * v * v;
    EXPECT_NEAR(known.std_error[i], std::sqrt(variance), 1e-7);
    EXPECT_NEAR(worst.std_error[i], 0.5 * std::abs(v) + 2.0 * v * v, 1e-7);
  }
}

TEST(LawCurve, HoldsTheOtherVariableAndSaysWhere) {
  const plant_sim::ModelFile model =
      with_formula("force_driven_axis", "force", "c * v_mps * y_m", {{"c", 5.0}});
  const LawCurve curve = law_curve(model, swinging(), "law", "y", Eigen::VectorXd::Constant(1, 1.0),
                                   Eigen::MatrixXd());
  ASSERT_TRUE(curve.held.has_value());
  EXPECT_EQ(curve.variable, "y_m");
  EXPECT_EQ(curve.held->variable, "v_mps");
  EXPECT_NEAR(curve.held->value, 2.0 * M_PI * 0.05 / std::sqrt(2.0), 0.005);
  EXPECT_NEAR(curve.f.back(), 5.0 * curve.held->value * curve.x.back(), 1e-9);
}

TEST(LawCurve, OfDryFrictionIsAShareOfIt) {
  const plant_sim::ModelFile model =
      with_formula("force_driven_axis", "dry_friction", "c * y_m", {{"c", 5.0}});
  const LawCurve curve = law_curve(model, swinging(), "law", "y", Eigen::VectorXd::Constant(1, 1.0),
                                   Eigen::MatrixXd());
  EXPECT_EQ(curve.quantity, "friction_ratio");
  EXPECT_NEAR(curve.f.back(), 5.0 * curve.x.back(), 1e-9);
}

TEST(LawCurve, OfAChainedSiteIsWhatTheFormulaAdds) {
  const plant_sim::ModelFile model =
      with_formula("velocity_servo", "command", "u_V * (1 + a * u_V)", {{"a", 0.1}});
  const LawCurve curve = law_curve(model, swinging(), "law", "u", Eigen::VectorXd::Constant(1, 1.0),
                                   Eigen::MatrixXd());
  EXPECT_EQ(curve.quantity, "command_V");
  EXPECT_NEAR(curve.x.front(), -3.0, 1e-9);
  EXPECT_NEAR(curve.f.front(), 0.1 * 9.0, 1e-9);
}

TEST(LawCurve, TellsWhereTheSamplesLie) {
  const plant_sim::ModelFile model =
      with_formula("force_driven_axis", "force", "k * y_m", {{"k", 5.0}});
  const LawCurve curve = law_curve(model, swinging(), "law", "y", Eigen::VectorXd::Constant(1, 1.0),
                                   Eigen::MatrixXd());
  EXPECT_NEAR(std::accumulate(curve.share.begin(), curve.share.end(), 0.0), 1.0, 1e-9);
  // a sine dwells at its ends: 1/(pi sqrt(1 - x^2)) is least in the middle
  EXPECT_GT(curve.share[1], 2.0 * curve.share[curve.share.size() / 2]);
  EXPECT_NEAR(curve.share[curve.share.size() / 2], 2.0 / (M_PI * 60.0), 0.003);
}

TEST(LawCurve, OverAPressureThatNoRecordShowsHasNoDensity) {
  const plant_sim::ModelFile model =
      with_formula("thesis", "leakage", "c * (in_Pa - out_Pa)", {{"c", 1e-12}});
  const LawCurve curve = law_curve(model, swinging(), "law", "pressure",
                                   Eigen::VectorXd::Constant(1, 1e-13), Eigen::MatrixXd());
  EXPECT_EQ(curve.variable, "in_Pa");
  EXPECT_TRUE(curve.share.empty());
  EXPECT_FALSE(curve.x.empty());
}

}  // namespace
}  // namespace estimator::greybox
