// The shipped models give the coefficients that they were calibrated for. Least squares by modified
// Gram-Schmidt, independent of the estimators.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "plant_sim/instruments.h"
#include "plant_sim/plant.h"

namespace plant_sim {
namespace {

struct Log {
  std::vector<double> y, u;
};

/// The 200 Hz loop on the thesis's sine: y is read, then u written and held.
Log closed_loop(const std::string& name, double seconds, bool instruments,
                double needle_N_s2_per_m2 = -1.0) {
  ModelFile model =
      load_model(std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/" + name + ".toml");
  if (needle_N_s2_per_m2 >= 0.0) {
    *model.value("coupled_slaves.needle_N_s2_per_m2") = needle_N_s2_per_m2;
  }
  auto plant = make_plant(model);
  Encoder encoder(instruments ? 2.5e-6 : 0.0, instruments ? 0.2e-6 : 0.0, 1);
  const DacRange dac{instruments ? 12 : 0, 10.0};
  Log log;
  for (int k = 0; k < seconds * 200.0; ++k) {
    const double y_m = encoder.read(plant->reading_m()) - 0.305;
    const double wanted_m = 0.0254 * std::sin(M_PI * k * 0.005);
    const double u_V = dac.apply(model.loop.kp_V_per_m * (wanted_m - y_m));
    log.y.push_back(y_m);
    log.u.push_back(u_V);
    plant->advance(u_V, 0.005);
  }
  return log;
}

/// a1..an, b1 of ARX(n,1,1) over one period of 400 samples.
template <std::size_t N>
std::array<double, N + 1> arx(const Log& log, std::size_t period) {
  constexpr std::size_t kColumns = N + 2;  // the last is the right-hand side
  std::array<std::vector<long double>, kColumns> q;
  for (std::size_t t = 400 * period + N; t < 400 * (period + 1); ++t) {
    for (std::size_t i = 0; i < N; ++i) q[i].push_back(-log.y[t - 1 - i]);
    q[N].push_back(log.u[t - 1]);
    q[N + 1].push_back(log.y[t]);
  }
  std::array<std::array<long double, kColumns>, kColumns> r{};
  for (std::size_t i = 0; i + 1 < kColumns; ++i) {
    for (std::size_t j = i; j < kColumns; ++j) {
      for (std::size_t t = 0; t < q[i].size(); ++t) r[i][j] += q[i][t] * q[j][t];
    }
    for (std::size_t j = i + 1; j < kColumns; ++j) {
      for (std::size_t t = 0; t < q[i].size(); ++t) q[j][t] -= q[i][t] * r[i][j] / r[i][i];
    }
  }
  std::array<double, N + 1> theta{};
  for (std::size_t i = N + 1; i-- > 0;) {
    long double value = r[i][N + 1];
    for (std::size_t j = i + 1; j <= N; ++j) value -= r[i][j] * theta[j];
    theta[i] = static_cast<double>(value / r[i][i]);
  }
  return theta;
}

/// Lowest and highest of each coefficient over the periods after the first.
std::array<std::pair<double, double>, 3> ranges(const Log& log) {
  std::array<std::pair<double, double>, 3> found;
  found.fill({1e9, -1e9});
  for (std::size_t period = 1; 400 * (period + 1) <= log.y.size(); ++period) {
    const std::array<double, 3> theta = arx<2>(log, period);
    for (std::size_t i = 0; i < 3; ++i) {
      found[i].first = std::min(found[i].first, theta[i]);
      found[i].second = std::max(found[i].second, theta[i]);
    }
  }
  return found;
}

bool apart(const std::pair<double, double>& a, const std::pair<double, double>& b) {
  return a.second < b.first || b.second < a.first;
}

TEST(ThesisCalibrated, GivesThePrintedB1) {
  const Log log = closed_loop("thesis_calibrated", 10.0, false);
  for (std::size_t period = 1; period < 5; ++period) {
    EXPECT_NEAR(arx<1>(log, period)[1], 1.9672e-4, 1e-4 * 1.9672e-4) << period;
  }
}

TEST(Thesis, AsPrintedGivesAB1OutsideThePrintedBands) {
  EXPECT_NEAR(arx<1>(closed_loop("thesis", 6.0, false), 2)[1], 2.45e-4, 0.005e-4);
}

TEST(Rig2000Psi, KeepsB1OfArx211WithinTheNormalBand) {
  const auto normal = ranges(closed_loop("rig_2000psi", 60.0, true));
  EXPECT_GT(normal[2].first, 6.400e-5);
  EXPECT_LT(normal[2].second, 6.700e-5);
}

TEST(Rig2000Psi, SeparatesConnectedSlavesButNotTheNeedleSettings) {
  const auto normal = ranges(closed_loop("rig_2000psi", 60.0, true));
  const auto open = ranges(closed_loop("rig_2000psi_slaves", 60.0, true, 20.0));
  const auto shut = ranges(closed_loop("rig_2000psi_slaves", 60.0, true, 500.0));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(apart(normal[i], open[i])) << i;
    EXPECT_TRUE(apart(normal[i], shut[i])) << i;
    EXPECT_FALSE(apart(open[i], shut[i])) << i;
  }
}

}  // namespace
}  // namespace plant_sim
