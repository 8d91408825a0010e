// Windows: their figures against the truth, and when they must be invalid.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/estimator/greybox/tracking/tracked_rig.h"

namespace {

using namespace tracking_test;
using testing::HasSubstr;

TEST(WindowResult, FindsPressureWithinTwoPerMilleAndDampingWithinItsStandardErrors) {
  double squares = 0.0;
  double worst = 0.0;
  int count = 0;
  for (const std::size_t seed : {1, 2, 3, 4}) {
    truth::Case of = stand(40.0, seed);
    of.plant.supply_pressure_Pa *= 0.9;
    of.plant.damping_N_s_per_m *= 1.25;
    const Tracked t = tracked(truth::simulate(of));
    for (std::size_t i = 0; i < t.windows.size(); i += 16) {  // that have no window in common
      const iso::WindowResult& window = t.windows[i];
      ASSERT_TRUE(window.valid) << tracker::invalid_words(t.set, window.invalid);
      EXPECT_NEAR(window.estimates[0].value, of.plant.supply_pressure_Pa,
                  0.002 * of.plant.supply_pressure_Pa);
      const double off = window.estimates[1].value - of.plant.damping_N_s_per_m;
      squares += std::pow(off / window.estimates[1].std_error, 2);
      worst = std::max(worst, std::abs(off) / of.plant.damping_N_s_per_m);
      ++count;
    }
  }
  // The mean of about 20 squares of normal numbers, four standard deviations to either side.
  EXPECT_NEAR(squares / count, 1.0, 4.0 * std::sqrt(2.0 / count));
  EXPECT_LT(worst, 0.03);
}

TEST(WindowResult, IsInvalidWhereTheRigDoesWhatTheModelDoesNotHave) {
  truth::Case of = stand(25.0);
  of.changes.push_back({15.0, nullptr, &truth::Hidden::backlash_m, 60e-6});
  const Tracked t = tracked(truth::simulate(of));
  for (const iso::WindowResult& window : t.windows) {
    if (window.t_s < 15.0) {
      EXPECT_TRUE(window.valid) << window.t_s;
    } else if (window.from_s > 15.5) {
      EXPECT_FALSE(window.valid) << window.t_s;
      EXPECT_THAT(tracker::invalid_words(t.set, window.invalid),
                  HasSubstr("the model does not explain it"));
    }
  }
  EXPECT_TRUE(t.alarms.empty());
}

TEST(WindowResult, IsInvalidWithoutMotion) {
  truth::Record record = truth::simulate(stand(12.0));
  truth::Random random(7);
  for (std::size_t k = 0; k < 2000; ++k) {
    record.t_s.push_back(record.t_s.back() + truth::kSample_s);
    record.u_V.push_back(0.0);
    record.y_m.push_back(5e-6 * std::round((0.305 + 2e-6 * random.normal()) / 5e-6));
  }
  const Tracked t = tracked(record);
  const iso::WindowResult& last = t.windows.back();
  EXPECT_FALSE(last.valid);
  EXPECT_THAT(tracker::invalid_words(t.set, last.invalid), HasSubstr("no motion"));
  EXPECT_TRUE(t.alarms.empty());
}

TEST(WindowResult, TellsThePressureWhereATriangleDoesNotTellTheDamping) {
  truth::Case of = truth::parse_case("motion=triangle,plant=printed", 1);
  of.length_s = 40.0;
  fault(of, 20.0, &truth::Plant::supply_pressure_Pa, 0.9);
  iso::TrackerSettings settings;
  settings.fused = 1;
  const Tracked t = tracked(truth::simulate(of), usual(), settings);
  int poor = 0;
  for (const iso::WindowResult& window : t.windows) {
    if (window.from_s < 20.0) continue;
    EXPECT_TRUE(window.estimates[0].valid)
        << tracker::invalid_words(t.set, window.estimates[0].invalid);
    EXPECT_NEAR(window.estimates[0].value, 0.9 * 6.89e6, 0.002 * 6.89e6);
    if (window.estimates[1].valid) {
      EXPECT_NEAR(window.estimates[1].value, 1000.0, 30.0) << window.t_s;
    } else {
      ++poor;
      EXPECT_FALSE(window.valid);
      EXPECT_THAT(tracker::invalid_words(t.set, window.invalid), HasSubstr("damping is known to"));
    }
  }
  EXPECT_GT(poor, 0);
}

TEST(WindowResult, SaysWhatTheMotionDoesNotSeparate) {
  const truth::Record record = truth::simulate(stand(8.0));
  const plant_sim::ModelFile model = printed_model();
  // Both only appear as their product.
  const iso::ParameterSet set =
      iso::choose(model, {"valve_gain_m_per_V", "discharge_coefficient"}, "parameters");
  iso::ParameterTracker tracker(model, set, {}, truth::kSample_s, kFloor_m);
  iso::WindowResult last;
  for (std::size_t k = 0; k < record.t_s.size(); ++k) {
    auto window = tracker.push(record.t_s[k], record.u_V[k], record.y_m[k], k == 0);
    if (window) last = *window;
  }
  EXPECT_FALSE(last.valid);
  EXPECT_THAT(estimator::fdi::tracker::invalid_words(set, last.invalid),
              HasSubstr("does not separate valve gain from discharge coefficient"));
}

TEST(WindowResult, NeverReachesAcrossAGap) {
  const truth::Record record = truth::simulate(stand(20.0));
  const plant_sim::ModelFile model = printed_model();
  iso::ParameterTracker tracker(model, iso::choose(model, usual(), "parameters"), {},
                                truth::kSample_s, kFloor_m);
  for (std::size_t k = 0; k < record.t_s.size(); ++k) {
    const bool gap = k == 2001;  // behind 10 s the record goes on 0.7 s later
    if (k > 2001 && k < 2141) continue;
    const std::size_t row = gap ? 2141 : k;
    auto window = tracker.push(record.t_s[row], record.u_V[row], record.y_m[row], k == 0 || gap);
    if (!window) continue;
    EXPECT_TRUE(window->t_s < 10.1 || window->from_s > 10.7) << window->t_s;
    EXPECT_LT(window->rms_m, 1.2 * kFloor_m) << window->t_s;
  }
}

}  // namespace
