// Disturbances against what their equations make of them.
#include "tests/truth/outside.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "tests/truth/actuator.h"
#include "tests/truth/rig.h"

namespace truth {
namespace {

constexpr double kPi = 3.14159265358979;

TEST(TruthOutside, HasARandomForceOfItsSizeAndCorner) {
  Outside outside;
  outside.force_N = 30.0;
  outside.corner_Hz = 3.0;
  Disturber disturber(outside, 7);
  const auto lag = static_cast<std::size_t>(std::lround(1000.0 / (2.0 * kPi * 3.0)));
  std::vector<double> force_N;
  for (int k = 0; k < 2000000; ++k) force_N.push_back(disturber.force_N(1e-3 * (k + 0.5)));
  double square = 0.0;
  double later = 0.0;
  for (std::size_t k = lag; k < force_N.size(); ++k) {
    square += force_N[k] * force_N[k];
    later += force_N[k] * force_N[k - lag];
  }
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(force_N.size())), 30.0, 0.6);
  EXPECT_NEAR(later / square, std::exp(-1.0), 0.02);
}

TEST(TruthOutside, GivesTheSameForceWhateverElseActs) {
  Outside plain;
  plain.force_N = 30.0;
  Outside more = plain;
  more.line_N = 5.0;
  more.shake_m = 1e-5;
  Disturber one(plain, 7);
  Disturber both(more, 7);
  double square_N2 = 0.0;
  for (int k = 0; k < 1900; ++k) {  // a hundred of its periods is 100/19 s
    const double t_s = 100.0 / 19.0 * k / 1900.0;
    const double line_N = both.force_N(t_s) - one.force_N(t_s);
    EXPECT_LE(std::abs(line_N), 5.0 + 1e-9);
    square_N2 += line_N * line_N / 1900.0;
  }
  EXPECT_NEAR(square_N2, 12.5, 1e-6);
}

TEST(TruthOutside, PulsatesAtTheInletAndShakesTheReading) {
  Outside outside;
  outside.pulsation_Pa = 1e5;
  outside.pulsation_Hz = 20.0;
  outside.shake_m = 1e-5;
  outside.shake_Hz = 20.0;
  Rig still(std::make_unique<Actuator>(Plant{}, Hidden{}, LeftOut{}));
  Rig shaken(std::make_unique<Actuator>(Plant{}, Hidden{}, LeftOut{}), 0, outside, 3);
  double in = 0.0;
  double out = 0.0;
  for (int k = 0; k < 400; ++k) {
    const double turn = 2.0 * kPi * 20.0 * k * kSample_s;
    in += 2.0 / 400.0 * (shaken.reading_m() - still.reading_m()) * std::cos(turn);
    out += 2.0 / 400.0 * (shaken.reading_m() - still.reading_m()) * std::sin(turn);
    // A closed valve: the pulsation stops at it.
    EXPECT_NEAR(shaken.x[0], still.x[0], 1e-12);
    still.hold(0.0);
    shaken.hold(0.0);
  }
  EXPECT_NEAR(std::hypot(in, out), 1e-5, 1e-9);
  Disturber disturber(outside, 3);
  double most_Pa = 0.0;
  for (int k = 0; k < 1000; ++k) most_Pa = std::max(most_Pa, disturber.pulsation_Pa(1e-4 * k));
  EXPECT_NEAR(most_Pa, 1e5, 100.0);
}

}  // namespace
}  // namespace truth
