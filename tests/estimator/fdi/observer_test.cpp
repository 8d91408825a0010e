// Observers whose residuals an unknown input does not move, and banks of them.
#include "estimator/fdi/observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/estimator/fdi/plain_values.h"

namespace estimator::fdi {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using fdi_test::PlainValues;
using fdi_test::refusal;

/// Chen and Patton 1999, section 3.2: A, C, E; continuous.
StateSpaceModel textbook() {
  StateSpaceModel m;
  m.a = MatrixXd{{-1, 1, 0}, {-1, 0, 0}, {0, -1, -1}};
  m.b = MatrixXd{{0}, {1}, {0}};
  m.c = MatrixXd{{1, 0, 0}, {0, 0, 1}};
  m.e = MatrixXd{{-1}, {0}, {0}};
  m.k = MatrixXd(3, 0);
  m.discrete = false;
  return m;
}

/// The same sampled at 0.1 s. Octave: A = expm(0.1 A), B and E = (A_d - I) inv(A) [B E].
StateSpaceModel sampled() {
  StateSpaceModel m = textbook();
  m.a = MatrixXd{{0.900162501369, 0.0950040833529, 0},
                 {-0.0950040833529, 0.995166584722, 0},
                 {0.00467491666691, -0.0950040833529, 0.904837418036}};
  m.b = MatrixXd{{0.00483341527802}, {0.0998374986309}, {-0.00483341527802}};
  m.e = MatrixXd{{-0.0950040833529}, {0.00483341527802}, {-0.000158498611114}};
  m.discrete = true;
  return m;
}

TEST(UnknownInput, ObserverExistsForTheTextbookExample) {
  // By hand: C E = (-1, 0)', so H = E (C E)^+ = [1 0; 0 0; 0 0] and A1 is A without its first row.
  const Existence found = unknown_input_existence(textbook());
  EXPECT_TRUE(found.exists) << found.why;
  EXPECT_TRUE(found.h.isApprox(MatrixXd{{1, 0}, {0, 0}, {0, 0}}, 1e-12));
  EXPECT_TRUE(found.a1.isApprox(MatrixXd{{0, 0, 0}, {-1, 0, 0}, {0, -1, -1}}, 1e-12));
}

TEST(UnknownInput, GainIsThatOfTheRiccatiEquation) {
  const StateSpaceModel m = sampled();
  const Existence found = unknown_input_existence(m);
  ASSERT_TRUE(found.exists);
  // Octave: P = dare(A1', C', eye(3), eye(2)); K1 = A1*P*C'*inv(C*P*C' + eye(2))
  const MatrixXd expected{{-2.150453675e-06, -0.001052369331},
                          {-0.02359316726, -0.605634483},
                          {0.001288982148, 0.6307902825}};
  EXPECT_LT((predictor_gain(found.a1, m.c) - expected).cwiseAbs().maxCoeff(), 1e-8);
  const UnknownInputObserver observer = unknown_input_observer(m, "test");
  // Octave: abs(eig(A1 - K1*C)) = 0, 0.90924, 0.36479
  EXPECT_NEAR(observer.f.eigenvalues().cwiseAbs().maxCoeff(), 0.90924, 1e-4);
}

/// Greatest residual over the second half of a run of 400 samples.
double residual(const StateSpaceModel& m, double d_size, double f_size, const VectorXd& fault) {
  const UnknownInputObserver o = unknown_input_observer(m, "test");
  VectorXd x = VectorXd::Ones(m.a.rows());
  VectorXd z = VectorXd::Zero(m.a.rows());
  double greatest = 0.0;
  for (int t = 0; t < 400; ++t) {
    const VectorXd y = m.c * x;
    const VectorXd u = VectorXd::Constant(m.b.cols(), std::sin(0.1 * t));
    if (t >= 200) greatest = std::max(greatest, (o.l1 * z + o.l2 * y).cwiseAbs().maxCoeff());
    z = (o.f * z + o.j * u + o.g * y).eval();
    x = (m.a * x + m.b * u + m.e * d_size * (t % 7 < 3 ? 1.0 : -2.0) +
         fault * (t > 300 ? f_size : 0.0))
            .eval();
  }
  return greatest;
}

TEST(UnknownInput, DoesNotMoveTheResidualHoweverLargeWhileAFaultDoes) {
  const VectorXd none = VectorXd::Zero(3);
  const VectorXd fault = VectorXd::Unit(3, 1);
  EXPECT_LT(residual(sampled(), 0.0, 0.0, none), 1e-6);
  EXPECT_LT(residual(sampled(), 1000.0, 0.0, none), 1e-4) << "rounding of 1000";
  EXPECT_GT(residual(sampled(), 1000.0, 1.0, fault), 0.1);
}

TEST(UnknownInput, TellsWhichFaultsFadeAway) {
  // A1 has an integrator (Octave: eig(A1) = 0, 1, 0.905): its state comes to explain a constant
  // fault of the third state, Octave: C*((eye(3) - F)\(T*[0;0;1])) = (1e-16, 2e-16).
  StateSpaceModel m = sampled();
  m.k = MatrixXd{{0}, {0}, {1}};
  EXPECT_LT(unknown_input_observer(m, "test").fault_gain.cwiseAbs().maxCoeff(), 1e-9);
  m.k = MatrixXd{{0}, {1}, {0}};
  EXPECT_GT(unknown_input_observer(m, "test").fault_gain.cwiseAbs().maxCoeff(), 0.1);
}

/// The linearised actuator, states y, v, Pi, Po; the spool as input; a load force as unknown input.
///   m v' = A (Pi - Po) - d v - F,  P' = beta/V (Kq xv -+ A v -+ Kc P),  Kc = Q0/(2 dp)
StateSpaceModel actuator(double opening_m, const MatrixXd& c) {
  constexpr double kArea = 6.33e-4, kMass = 50.0, kDamping = 1000.0, kSupply = 6.89e6;
  constexpr double kBetaPerVolume = 6.89e8 / (1e-5 + kArea * 0.305);
  const double gradient = 0.6 * 2.07e-2 * std::sqrt(2.0 / 847.0);
  const double gain = gradient * std::sqrt(kSupply / 2.0);
  const double leak = gradient * opening_m / (2.0 * std::sqrt(kSupply / 2.0));
  StateSpaceModel m;
  m.a = MatrixXd{{0, 1, 0, 0},
                 {0, -kDamping / kMass, kArea / kMass, -kArea / kMass},
                 {0, -kBetaPerVolume * kArea, -kBetaPerVolume * leak, 0},
                 {0, kBetaPerVolume * kArea, 0, -kBetaPerVolume * leak}};
  m.b = MatrixXd{{0}, {0}, {kBetaPerVolume * gain}, {-kBetaPerVolume * gain}};
  m.c = c;
  m.e = MatrixXd{{0}, {-1.0 / kMass}, {0}, {0}};
  m.k = MatrixXd(4, 0);
  m.discrete = false;
  return m;
}

TEST(UnknownInput, ObserverOfTheActuatorNeedsMoreThanPosition) {
  const MatrixXd position{{1, 0, 0, 0}};
  const Existence blind = unknown_input_existence(actuator(1e-4, position));
  EXPECT_FALSE(blind.exists);
  EXPECT_EQ(blind.rank_ce, 0);
  EXPECT_EQ(blind.rank_e, 1);
  EXPECT_NE(blind.why.find("do not see at once"), std::string::npos);
  // Speed sees the force at once, but while the valve is shut the pressures' sum decays nowhere and
  // is seen nowhere; open, it leaks away.
  const MatrixXd with_speed{{1, 0, 0, 0}, {0, 1, 0, 0}};
  const Existence shut = unknown_input_existence(actuator(0.0, with_speed));
  EXPECT_FALSE(shut.exists);
  EXPECT_NE(shut.why.find("detectable"), std::string::npos);
  EXPECT_TRUE(unknown_input_existence(actuator(1e-4, with_speed)).exists);
  // A chamber pressure measured beside speed leaves the other one unseen; both do.
  const MatrixXd with_both{{0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}, {1, 0, 0, 0}};
  EXPECT_TRUE(unknown_input_existence(actuator(0.0, with_both)).exists);
}

TEST(UnknownInput, IsRefusedWithTheReason) {
  StateSpaceModel m = sampled();
  m.c = MatrixXd{{0, 1, 0}};
  m.e = MatrixXd{{1}, {0}, {0}};
  try {
    (void)unknown_input_observer(m, "[[observer]] o");
    FAIL();
  } catch (const config::schema::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("rank(C E) = 0"), std::string::npos) << error.what();
  }
}

/// x+ = 0.9 x + 0.1 u, seen by two sensors; reference_m and y_m, driven by u_V.
std::string bank(const std::string& more) {
  return "[[observer]]\nid = 'o'\nu = ['sample.u_V']\ny = ['sample.y_m', 'sample.reference_m']\n"
         "a = [0.9]\nb = [0.1]\nc = [1.0, 1.0]\noutput_std = [0.01, 0.01]\nwindow_s = 20.0\n"
         "stride_s = 10.0\nprocess_std = 1e-4\n" +
         more;
}

TEST(ObserverBank, NamesTheSensorThatIsWrong) {
  PlainValues values(bank("bank = true\nlimit = 3.0\n"));
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal(0.0, 0.01);
  double x = 0.0;
  const auto run = [&](int samples, double offset) {
    for (int i = 0; i < samples; ++i) {
      const double u = std::sin(0.3 * static_cast<double>(values.tick));
      values.feed(x + normal(random), u, x + offset + normal(random));
      x = 0.9 * x + 0.1 * u;
    }
  };
  run(200, 0.0);
  EXPECT_TRUE(values.alarms.empty());
  // An innovation's variance is that of the noise and of the prediction: a little above 1.
  EXPECT_NEAR(values.last("r1"), 1.0, 0.5);
  EXPECT_NEAR(values.last("r2"), 1.0, 0.5);
  run(100, 0.3);
  ASSERT_EQ(values.alarms.size(), 1U);
  EXPECT_EQ(values.alarms[0].parameter, "sample.reference_m");
  EXPECT_GT(values.last("r1"), 3.0);
  EXPECT_LT(values.last("r2"), 2.0);
  run(200, 0.0);
  EXPECT_EQ(values.alarms.back().severity, Severity::ok);
}

TEST(ObserverBank, GoesOnBitForBitAfterASnapshot) {
  PlainValues one(bank("bank = true\n"));
  for (int i = 0; i < 75; ++i) one.feed(std::sin(0.2 * i), std::cos(0.3 * i), 0.1 * i);
  std::vector<std::uint8_t> bytes;
  StateArchive out = StateArchive::saving(bytes);
  one.pipeline.serialize(out);
  PlainValues two(bank("bank = true\n"));
  StateArchive in = StateArchive::restoring(bytes);
  two.pipeline.serialize(in);
  ASSERT_TRUE(in.complete());
  two.tick = one.tick;
  for (int i = 0; i < 10; ++i) {
    one.feed(0.1 * i, 0.2, 0.3);
    two.feed(0.1 * i, 0.2, 0.3);
  }
  EXPECT_GT(one.last("r1"), 0.0);
  EXPECT_EQ(one.last("r1"), two.last("r1"));
  EXPECT_EQ(one.last("r2"), two.last("r2"));
}

TEST(ObserverBank, IsRefusedWhenMatricesDoNotFit) {
  std::string text = bank("");
  text.replace(text.find("[0.9]"), 5, "[0.9, 0.1, 0.2]");
  EXPECT_NE(refusal(text).find("a: has 3 numbers; allowed: 2 x 2"), std::string::npos);
  text = bank("");
  text.replace(text.find("[1.0, 1.0]"), 10, "[1.0]");
  EXPECT_NE(refusal(text).find("c: has 1 numbers; allowed: 2 x 1"), std::string::npos);
}

}  // namespace
}  // namespace estimator::fdi
