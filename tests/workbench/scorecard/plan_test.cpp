// The plan: sizes, parts, and the records that it asks for.
#include "workbench/scorecard/plan.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "config/schema/error.h"
#include "workbench/scorecard/shipped.h"
#include "workbench/scorecard/trials.h"

namespace workbench::scorecard {
namespace {

using testing::DoubleNear;
using testing::Pointwise;

Fault fault(double least, double greatest) {
  Fault out;
  out.id = "one";
  out.parameter = "supply_pressure_Pa";
  out.least = least;
  out.greatest = greatest;
  return out;
}

TEST(Fault, HasSixSizesADecade) {
  EXPECT_THAT(fault(0.5, 20.0).sizes(1), Pointwise(DoubleNear(1e-9), {0.5, 0.7, 1.0, 1.5, 2.0, 3.0,
                                                                      5.0, 7.0, 10.0, 15.0, 20.0}));
  EXPECT_THAT(fault(0.0, 0.0).sizes(1), testing::IsEmpty());
}

TEST(Fault, DoesNotTakeAwayMoreThanThereIs) {
  EXPECT_NEAR(fault(10.0, 500.0).sizes(1).back(), 500.0, 1e-9);
  EXPECT_NEAR(fault(10.0, 500.0).sizes(-1).back(), 70.0, 1e-9);
}

TEST(Shipped, PlanAndMethodsAreRead) {
  const Bench bench = load_bench("");
  EXPECT_EQ(bench.plan.motions.size(), 3U);
  EXPECT_GE(bench.plan.faults.size(), 10U);
  for (const std::string& method : shipped_methods()) {
    EXPECT_FALSE(load_method(method).name.empty()) << method;
  }
  EXPECT_THAT(shipped_methods(), testing::Contains("thesis_thresholds.toml"));
}

TEST(Shipped, EveryFaultAtEverySizeAndEveryBenignChangeCanBeSimulated) {
  const Bench bench = load_bench("");
  for (const Motion& motion : bench.plan.motions) {
    if (motion.id == "multisine") continue;  // its scaling takes long
    for (const Fault& each : bench.plan.faults) {
      for (const int direction : each.directions()) {
        std::vector<double> sizes = each.sizes(direction);
        sizes.push_back(each.stated);
        for (const double size : sizes) {
          const Samples samples = run(faulty(bench, motion, {&each, direction, size, 0.2}), 0.4, 1);
          for (const auto& s : samples) ASSERT_TRUE(std::isfinite(s.y_m)) << each.id << " " << size;
        }
      }
    }
    for (const Benign& change : bench.plan.benign) {
      EXPECT_EQ(run(changed(bench, motion, change), 0.4, 1).size(), 80U);
    }
  }
}

TEST(Bench, InjectsTheFaultAtItsTime) {
  const Bench bench = load_bench("");
  const Motion& sine = bench.plan.motions[0];
  const Samples whole = run(healthy(bench, sine), 4.0, 7);
  for (const Fault& each : bench.plan.faults) {
    const Samples samples = run(faulty(bench, sine, {&each, 1, each.greatest, 2.0}), 4.0, 7);
    for (std::size_t k = 0; k < 400; ++k) ASSERT_EQ(samples[k].y_m, whole[k].y_m) << each.id;
    double most_m = 0.0;
    for (std::size_t k = 400; k < 800; ++k) {
      most_m = std::max(most_m, std::abs(samples[k].y_m - whole[k].y_m));
    }
    EXPECT_GT(most_m, 2e-5) << each.id;
  }
}

TEST(Bench, HasTwoMoreRodSensorsThatNoSensorFaultTouches) {
  const Bench bench = load_bench("");
  Fault drift;
  drift.id = "drift";
  drift.sensor = "drift";
  drift.per_unit = 1.0;
  const Samples samples = run(faulty(bench, bench.plan.motions[0], {&drift, 1, 0.01, 1.0}), 2.0, 7);
  int apart = 0;
  constexpr double kNoise_m = 2e-5;  // steps of 5 um, six deviations of the noise of 2 um, twice
  for (const auto& s : samples) {
    ASSERT_EQ(s.rod_count, 3);
    EXPECT_EQ(s.rod_m[0], s.y_m);
    EXPECT_NEAR(s.rod_m[1], s.rod_m[2], kNoise_m);
    apart += s.rod_m[1] != s.rod_m[2] ? 1 : 0;
  }
  EXPECT_GT(apart, 0) << "each has its own noise";
  // 0.01 m/s for the last second
  EXPECT_NEAR(samples.back().rod_m[0] - samples.back().rod_m[1], 0.00995, kNoise_m);
}

TEST(Parts, CoverFaultsDirectionsAndMotionsAndTheHoursAskedFor) {
  const Bench bench = load_bench("");
  Scope scope;
  scope.faults = {"supply_pressure", "sensor_freeze"};
  scope.motions = {"sine", "triangle"};
  scope.hours = 3.0;
  const std::vector<Part> parts = parts_of(bench, scope);
  const auto count = [&](const std::string& prefix) {
    return std::count_if(parts.begin(), parts.end(),
                         [&](const Part& part) { return part.id.rfind(prefix, 0) == 0; });
  };
  EXPECT_EQ(count("stated/supply_pressure/"), 4);
  EXPECT_EQ(count("ladder/supply_pressure/down/"), 2);
  EXPECT_EQ(count("stated/sensor_freeze/"), 2);
  EXPECT_EQ(count("ladder/sensor_freeze/"), 0) << "it has no size";
  EXPECT_EQ(count("healthy/"), 6);
  EXPECT_EQ(count("stated/damping"), 0);
  Scope full;
  full.full = true;
  double hours = 0.0;
  for (const Part& part : parts_of(bench, full)) {
    if (part.kind == Part::Kind::healthy) hours += bench.plan.part_h;
  }
  EXPECT_GE(hours, 72.0);
}

TEST(Parts, OfHealthyHoursAreFewerForAMethodThatTakesLong) {
  const Bench bench = load_bench("");
  Method brief;
  brief.healthy_share = 0.25;
  double hours = 0.0;
  for (const Part& part : parts_of(bench, {})) {
    EXPECT_TRUE(part.is_for(Method()));
    if (part.kind == Part::Kind::healthy) {
      hours += part.is_for(brief) ? bench.plan.part_h : 0.0;
    } else {
      EXPECT_TRUE(part.is_for(brief)) << part.id;
    }
  }
  EXPECT_NEAR(hours, 0.25 * bench.plan.healthy_h, 1e-9);
}

TEST(Parts, RefuseAnUnknownName) {
  Scope scope;
  scope.faults = {"supply"};
  try {
    static_cast<void>(parts_of(load_bench(""), scope));
    FAIL();
  } catch (const config::schema::UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("--fault supply"));
    EXPECT_THAT(error.what(), testing::HasSubstr("supply_pressure, damping"));
  }
}

TEST(Seeds, AreTheSameEverywhereAndDiffer) {
  EXPECT_EQ(seed_of(1, "sine/0"), seed_of(1, "sine/0"));
  EXPECT_NE(seed_of(1, "sine/0"), seed_of(2, "sine/0"));
  EXPECT_NE(seed_of(1, "sine/0"), seed_of(1, "sine/1"));
  double sum = 0.0;
  for (std::uint64_t i = 0; i < 1000; ++i) sum += unit_of(seed_of(i, "x"));
  EXPECT_NEAR(sum / 1000.0, 0.5, 0.05);  // five standard errors of a mean of 1000
}

}  // namespace
}  // namespace workbench::scorecard
