// The on-line classes take no memory after construction.
#include <gtest/gtest.h>

#include <cstdlib>

#include "estimator/preprocess.h"
#include "estimator/recursive.h"
#include "estimator/sliding_window.h"
#include "tests/count_allocations.h"
#include "tests/estimator/data.h"

namespace estimator {
namespace {

using namespace testing_data;

class Allocation : public testing::Test {
 protected:
  void SetUp() override {
    if (!SPOOLWATCH_COUNTS_MALLOC) GTEST_SKIP() << "malloc belongs to a sanitizer in this build";
    const long before = allocations;
    delete new int(1);
    void* const memory = std::malloc(static_cast<std::size_t>(10 + std::rand() % 10));
    ASSERT_NE(memory, nullptr);
    std::free(memory);
    ASSERT_GE(allocations, before + 1) << "the counter does not count";
  }
};

TEST_F(Allocation, NoneInTheOnLineClassesAfterConstruction) {
  const Structure largest{10, 10, 50, true};
  const Data data = excited(3000, 1e-6, 1);
  for (const Structure& s : {kTruth, largest}) {
    SlidingWindow sliding({s, 400, 5, {}});
    Recursive cold({.structure = s, .forgetting = 0.98, .limits = {}});
    Recursive warm({.structure = s, .warmup = 100, .limits = {}});
    Preprocess stream({.filter = true,
                       .design = {.band = Band::band_pass,
                                  .order = 8,
                                  .low_Hz = 0.5,
                                  .high_Hz = 40.0,
                                  .sample_Hz = 200.0},
                       .decimation = 2});
    const long before = allocations;
    double checksum = 0.0;
    for (int t = 0; t < 3000; ++t) {
      stream.push(data.u_V[t], data.y_m[t]);
      if (t == 1500) {
        checksum += static_cast<double>(sliding.gap(37)) + static_cast<double>(stream.gap(37));
        cold.gap();
      }
      const double y_m = t % 997 == 0 ? std::nan("") : data.y_m[t];
      if (sliding.push(data.u_V[t], y_m)) checksum += sliding.estimate().samples;
      cold.push(data.u_V[t], y_m);
      warm.push(data.u_V[t], y_m);
      checksum += cold.estimate().samples + warm.estimate().samples;
    }
    // Data that need the singular-value solution.
    for (int t = 0; t < 1000; ++t) {
      sliding.push(std::sin(0.01 * t), std::cos(0.01 * t));
      checksum += sliding.estimate().samples;
    }
    EXPECT_EQ(sliding.estimate().reason, Reason::rank_deficient);
    sliding.reset();
    warm.reset();
    EXPECT_EQ(allocations, before) << s.text();
    EXPECT_GT(checksum, 0.0);
  }
}

}  // namespace
}  // namespace estimator
