#include "estimator/greybox/observer_simulation.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "plant_sim/plant.h"

namespace estimator::greybox {

namespace {

constexpr double kTs = 0.005;

plant_sim::ModelFile model(const std::string& name) {
  return plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/" + name +
                               ".toml");
}

/// A made-up motion, which no model fits; a second segment begins in the middle.
Dataset record(std::size_t samples = 600, double sample_time_s = kTs) {
  Dataset m;
  m.name = "made";
  m.sample_time_s = sample_time_s;
  for (std::size_t k = 0; k < samples; ++k) {
    const double t_s = sample_time_s * static_cast<double>(k);
    m.t_s.push_back(t_s);
    m.u_V.push_back(1.5 * std::sin(4.0 * t_s) + 0.3 * std::cos(23.0 * t_s));
    m.y_m.push_back(0.3 + 0.02 * std::sin(4.0 * t_s + 0.5));
    m.valid.push_back(1);
  }
  m.starts = {0, samples / 2};
  return m;
}

void set_position(plant_sim::Plant& plant, double position_m) {
  std::vector<double> values;
  for (const plant_sim::NamedValue& state : plant.state()) {
    values.push_back(state.name == "y_m" ? position_m : state.value);
  }
  plant.set_state(values);
}

/// The equations of the header with the single plant, which shares no loop with the ensemble.
std::vector<double> by_single_plant(plant_sim::ModelFile file, const Dataset& m, double l_per_s,
                                    double added_V = 0.0, double added_N = 0.0) {
  if (added_N != 0.0) *file.value("load_force.force_N") += added_N;
  std::vector<double> e;
  std::unique_ptr<plant_sim::Plant> plant;
  for (std::size_t k = 0; k < m.size(); ++k) {
    if (k == 0 || k == m.starts[1]) {
      *file.value("initial.y_m") = m.y_m[k];
      plant = plant_sim::make_plant(file);
    }
    e.push_back(m.y_m[k] - plant->reading_m());
    if (l_per_s > 0.0) {
      set_position(*plant, plant->position_m() + l_per_s * m.sample_time_s * e.back());
    }
    plant->advance(m.u_V[k] + added_V, m.sample_time_s);
  }
  return e;
}

class ModelRunOf : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Plants, ModelRunOf,
                         testing::Values("thesis", "velocity_servo", "force_driven_axis"));

TEST_P(ModelRunOf, EqualsTheSinglePlantWithAndWithoutTheObserver) {
  plant_sim::ModelFile file = model(GetParam());
  if (file.plant != "velocity_servo") *file.value("friction.coulomb_N") = 30.0;
  const Dataset m = record();
  for (const double l_per_s : {0.0, 2.0}) {
    ObserverSimulation run(file, m, {}, l_per_s);
    Eigen::MatrixXd residuals_m;
    run.residuals(Eigen::MatrixXd(0, 1), residuals_m);
    const std::vector<double> expected = by_single_plant(file, m, l_per_s);
    for (std::size_t k = 0; k < m.size(); ++k) {
      ASSERT_NEAR(residuals_m(static_cast<Eigen::Index>(k), 0), expected[k], 1e-12)
          << "l " << l_per_s << " sample " << k;
    }
  }
}

TEST(ObserverSimulation, PutsEachColumnIntoALaneOfItsOwn) {
  const plant_sim::ModelFile file = model("thesis");
  const Dataset m = record();
  const FreeParameter damping{"damping_N_s_per_m", ParameterScale::logarithmic, 1000.0, -1.0, 1.0};
  ObserverSimulation run(file, m, {damping}, 2.0);
  Eigen::MatrixXd points(1, 2);
  points << 0.0, std::log(2.0);
  Eigen::MatrixXd residuals_m;
  run.residuals(points, residuals_m);
  plant_sim::ModelFile doubled = file;
  *doubled.value("damping_N_s_per_m") = 2000.0;
  const std::vector<double> first = by_single_plant(file, m, 2.0);
  const std::vector<double> second = by_single_plant(doubled, m, 2.0);
  for (std::size_t k = 0; k < m.size(); ++k) {
    ASSERT_NEAR(residuals_m(static_cast<Eigen::Index>(k), 0), first[k], 1e-12);
    ASSERT_NEAR(residuals_m(static_cast<Eigen::Index>(k), 1), second[k], 1e-11);
  }
  EXPECT_GT(std::abs(first.back() - second.back()), 1e-7);
}

TEST(ObserverSimulation, AddsToCommandAndLoadOfOneLane) {
  const plant_sim::ModelFile file = model("thesis");
  const Dataset m = record();
  ObserverSimulation run(file, m, {}, 2.0);
  const auto n = static_cast<Eigen::Index>(m.size());
  Eigen::MatrixXd added_V = Eigen::MatrixXd::Zero(n, 3);
  Eigen::MatrixXd added_N = Eigen::MatrixXd::Zero(n, 3);
  added_V.col(1).setConstant(0.05);
  added_N.col(2).setConstant(80.0);
  Eigen::MatrixXd residuals_m;
  run.residuals(Eigen::MatrixXd(0, 3), added_V, added_N, residuals_m);
  const std::vector<double> plain = by_single_plant(file, m, 2.0);
  const std::vector<double> with_V = by_single_plant(file, m, 2.0, 0.05);
  const std::vector<double> with_N = by_single_plant(file, m, 2.0, 0.0, 80.0);
  for (std::size_t k = 0; k < m.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    ASSERT_NEAR(residuals_m(row, 0), plain[k], 1e-12);
    ASSERT_NEAR(residuals_m(row, 1), with_V[k], 1e-12);
    ASSERT_NEAR(residuals_m(row, 2), with_N[k], 1e-12);
  }
  run.residuals(Eigen::MatrixXd(0, 1), residuals_m);  // the added load does not stay
  EXPECT_NEAR(residuals_m(n - 1, 0), plain.back(), 1e-12);
}

TEST(ObserverSimulation, GivesNothingBeforeASegmentHasSettled) {
  Dataset m = record();
  for (std::size_t k = 0; k < 100; ++k) m.valid[k] = 0;
  ObserverSimulation run(model("velocity_servo"), m, {}, 2.0);
  Eigen::MatrixXd residuals_m;
  run.residuals(Eigen::MatrixXd(0, 1), residuals_m);
  EXPECT_EQ(residuals_m.topRows(100).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_GT(std::abs(residuals_m(100, 0)), 1e-6);
}

/// The right model over the second half of its own motion, of which it knows neither speed nor
/// pressures at the beginning.
double error_after_settling_m(double observer_per_s, bool initialising) {
  const plant_sim::ModelFile file = model("thesis");
  const std::unique_ptr<plant_sim::Plant> plant = plant_sim::make_plant(file);
  Dataset whole = record(2000);
  whole.starts = {0};
  for (std::size_t k = 0; k < whole.size(); ++k) {
    whole.y_m[k] = plant->reading_m();
    plant->advance(whole.u_V[k], kTs);
  }
  Dataset half = part(whole, 1000, 2000);
  if (!initialising) half.initialising.clear();
  ObserverSimulation run(file, half, {}, observer_per_s);
  Eigen::MatrixXd residuals_m;
  run.residuals(Eigen::MatrixXd(0, 1), residuals_m);
  return residuals_m.cwiseAbs().maxCoeff();
}

TEST(ObserverSimulation, CatchesAMotionThatItsSegmentBeginsIn) {
  for (const double observer_per_s : {0.0, 2.0}) {
    EXPECT_LT(error_after_settling_m(observer_per_s, true), 2e-7) << observer_per_s;
    EXPECT_GT(error_after_settling_m(observer_per_s, false), 2e-5) << observer_per_s;
  }
}

/// The value at `n` of the straight line of least squares through the first n positions.
double line_through_first_m(const std::vector<double>& y_m, std::size_t n) {
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(n), 2);
  for (std::size_t k = 0; k < n; ++k) {
    columns.row(static_cast<Eigen::Index>(k)) << 1.0, static_cast<double>(k);
  }
  const Eigen::Map<const Eigen::VectorXd> values(y_m.data(), columns.rows());
  const Eigen::Vector2d line = columns.colPivHouseholderQr().solve(values);
  return line[0] + line[1] * static_cast<double>(n);
}

TEST(ObserverSimulation, AnAxisWithoutForceFollowsTheLineThroughTheSamplesOfItsStart) {
  plant_sim::ModelFile file = model("force_driven_axis");
  *file.value("damping_N_s_per_m") = 1e-9;
  Dataset m = record();
  m.starts = {0};
  m.u_V.assign(m.size(), 0.0);
  for (const Initialisation begins : {kFromRest, kInitialisingIfObserved, kInitialising}) {
    m.initialising.assign(m.size(), kNotInitialising);
    std::fill_n(m.initialising.begin(), 100, static_cast<char>(begins));
    ObserverSimulation run(file, m, {}, 2.0);
    Eigen::MatrixXd residuals_m;
    run.residuals(Eigen::MatrixXd(0, 1), residuals_m);
    for (const std::size_t n : {2U, 3U, 17U, 100U}) {
      EXPECT_NEAR(run.predicted().reading_m[n], line_through_first_m(m.y_m, n), 1e-9) << n;
    }
  }
}

TEST(ObserverSimulation, AFreeRunOfAnAxisFromRestKeepsTheStateOfTheFile) {
  plant_sim::ModelFile file = model("force_driven_axis");
  Dataset m = record();
  m.starts = {0};
  m.u_V.assign(m.size(), 0.0);
  m.initialising.assign(m.size(), kNotInitialising);
  std::fill_n(m.initialising.begin(), 100, static_cast<char>(kFromRest));
  ObserverSimulation run(file, m, {}, 0.0);
  Eigen::MatrixXd residuals_m;
  run.residuals(Eigen::MatrixXd(0, 1), residuals_m);
  EXPECT_NEAR(run.predicted().reading_m.back(), m.y_m.front(), 1e-12);
}

TEST(ObserverSimulation, RefusesAParameterThatTheModelDoesNotHave) {
  const Dataset m = record();
  EXPECT_THROW(ObserverSimulation(model("velocity_servo"), m, {{"mass_kg"}}),
               config::schema::Error);
}

TEST(StepFor, DividesTheSampleTimeAndIsNeverLongerThanTheModelsOwn) {
  const plant_sim::ModelFile file = model("thesis");  // 1 ms
  EXPECT_DOUBLE_EQ(step_for(file, 0.005), 0.001);
  EXPECT_DOUBLE_EQ(step_for(file, 0.001), 0.001);
  EXPECT_DOUBLE_EQ(step_for(file, 0.02), 0.001);
  EXPECT_DOUBLE_EQ(step_for(file, 0.0077531), 0.0077531 / 8.0);
  EXPECT_DOUBLE_EQ(step_for(file, 0.0002), 0.0002);
}

// y' = g u has the same position at common times whatever the rate, u held.
TEST(ObserverSimulation, ReachesTheSamePositionAtFiftyHertzAsAtAThousand) {
  plant_sim::ModelFile file = model("velocity_servo");
  *file.value("time_constant_s") = 0.0;
  for (const double sample_time_s : {0.02, 0.005, 0.001, 0.0077531}) {
    Dataset m;
    m.sample_time_s = sample_time_s;
    const auto samples = static_cast<std::size_t>(std::lround(4.0 / sample_time_s));
    for (std::size_t k = 0; k < samples; ++k) {
      m.t_s.push_back(sample_time_s * static_cast<double>(k));
      m.u_V.push_back(0.4);
      m.y_m.push_back(0.1 + 0.05 * 0.4 * m.t_s.back());
      m.valid.push_back(1);
    }
    m.starts = {0};
    ObserverSimulation run(file, m, {}, 0.0);
    Eigen::MatrixXd residuals_m;
    run.residuals(Eigen::MatrixXd(0, 1), residuals_m);
    EXPECT_LT(residuals_m.cwiseAbs().maxCoeff(), 1e-12) << sample_time_s;
  }
}

}  // namespace
}  // namespace estimator::greybox
