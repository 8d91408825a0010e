#include "estimator/greybox/disturbance/simulated_lines.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/estimator/greybox/disturbance/axis_record.h"

namespace estimator::greybox::disturbance {
namespace {

using disturbance_test::axis;
using disturbance_test::axis_record;
using disturbance_test::kTs_s;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double kFrequency_Hz = 11.3;

double rms(const VectorXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

// M v' = -d v - F with F held over each sample, y' = v, solved exactly.
TEST(SimulatedLines, AForceMovesAnAxisAsItsExactSolutionSays) {
  plant_sim::ModelFile model = axis();
  const double damping_N_s_per_m = *model.value("damping_N_s_per_m");
  const double a_per_s = damping_N_s_per_m / *model.value("mass_kg");
  const double decay = std::exp(-a_per_s * kTs_s);
  const double travel_s = (1.0 - decay) / a_per_s;
  const Dataset record = axis_record();
  const VectorXd moved_m = simulated_lines_m(
      model, record, {}, VectorXd(), {{LineSite::force, kFrequency_Hz}}, {Vector2d(3.0, -4.0)});
  double y_m = 0.0;
  double v_mps = 0.0;
  for (std::size_t k = 0; k < record.size(); ++k) {
    ASSERT_NEAR(moved_m[static_cast<Eigen::Index>(k)], y_m, 1e-6 * 5.0 / damping_N_s_per_m);
    const double angle = 2.0 * std::numbers::pi * kFrequency_Hz * record.t_s[k];
    const double settled_mps = -(3.0 * std::sin(angle) - 4.0 * std::cos(angle)) / damping_N_s_per_m;
    y_m += settled_mps * kTs_s + (v_mps - settled_mps) * travel_s;
    v_mps = settled_mps + (v_mps - settled_mps) * decay;
  }
}

TEST(SimulatedLines, AShakingSensorIsAddedToTheReading) {
  const Dataset record = axis_record();
  const VectorXd moved_m = simulated_lines_m(
      axis(), record, {}, VectorXd(), {{LineSite::sensor, kFrequency_Hz}}, {Vector2d(2e-5, 0.0)});
  for (const std::size_t k : {0U, 7U, 300U}) {
    const double angle = 2.0 * std::numbers::pi * kFrequency_Hz * record.t_s[k];
    EXPECT_NEAR(moved_m[static_cast<Eigen::Index>(k)], 2e-5 * std::sin(angle), 1e-15);
  }
}

TEST(SimulatedLines, AForceBelowFrictionMovesNothingAtRest) {
  plant_sim::ModelFile rough = axis();
  *rough.value("friction.coulomb_N") = 50.0;
  for (auto& effect : rough.effects) effect.present = effect.name == "friction";
  Dataset record = axis_record();
  for (std::size_t k = 0; k < record.size(); ++k) record.u_V[k] = record.y_m[k] = 0.0;
  const auto moved_by = [&](double force_N) {
    return rms(simulated_lines_m(rough, record, {}, VectorXd(), {{LineSite::force, kFrequency_Hz}},
                                 {Vector2d(force_N, 0.0)}));
  };
  EXPECT_LT(moved_by(40.0), 1e-12);
  EXPECT_GT(moved_by(80.0), 1e-6);
}

// The observer follows a shake that is slower than it is.
TEST(SimulatedLines, TheErrorOfAFastLineIsTheLineItself) {
  const Dataset record = axis_record(2000);
  const std::vector<SpectralLine> lines = {{LineSite::sensor, kFrequency_Hz}};
  const std::vector<Vector2d> waves = {Vector2d(2e-5, 0.0)};
  const VectorXd error_m = simulated_line_error_m(axis(), record, {}, VectorXd(), lines, waves);
  const VectorXd line_m = simulated_lines_m(axis(), record, {}, VectorXd(), lines, waves);
  EXPECT_LT(rms((error_m - line_m).tail(1000)), 0.05 * rms(line_m));
  const std::vector<SpectralLine> slow = {{LineSite::sensor, 0.02}};
  const VectorXd followed_m = simulated_line_error_m(axis(), record, {}, VectorXd(), slow, waves);
  EXPECT_LT(rms(followed_m.tail(1000)),
            0.3 * rms(simulated_lines_m(axis(), record, {}, VectorXd(), slow, waves).tail(1000)));
}

// A valve that lets its largest flow through does so at any pressure.
TEST(SimulatedLines, AFlowThatIsLimitedPassesNoPulsation) {
  const auto moved_by = [](double limit_m3ps) {
    plant_sim::ModelFile model =
        plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/thesis.toml");
    for (auto& effect : model.effects) effect.present = effect.name == "flow_saturation";
    *model.value("flow_saturation.limit_m3ps") = limit_m3ps;
    Dataset record = axis_record(400);
    for (std::size_t k = 0; k < record.size(); ++k) {
      record.u_V[k] = 2.0;
      record.y_m[k] = 0.0;
    }
    const VectorXd moved_m = simulated_lines_m(
        model, record, {}, VectorXd(), {{LineSite::supply, kFrequency_Hz}}, {Vector2d(1e5, 0.0)});
    return rms(moved_m.tail(300).array() - moved_m.tail(300).mean());
  };
  EXPECT_LT(moved_by(1e-5), 1e-3 * moved_by(1.0));
}

}  // namespace
}  // namespace estimator::greybox::disturbance
