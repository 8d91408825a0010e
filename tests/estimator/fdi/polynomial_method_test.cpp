// [[polynomial]] in a pipeline: it follows a change of gain under coloured noise, keeps still
// without excitation, and goes on bit for bit.
#include "estimator/fdi/polynomial_method.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/fdi/pipeline.h"

namespace estimator::fdi {
namespace {

constexpr double kSampleTime_s = 0.005;

PipelineConfig read(const std::string& text) {
  PipelineConfig config;
  config::schema::Document::parse("schema_version = 1\n" + text, "test.toml")
      .read([&](config::schema::Visitor& v) { config.visit(v); });
  return config;
}

const std::string kArmax =
    "[[polynomial]]\nid = 'p'\nstructure = 'armax1111'\nforgetting = 0.998\noffset_m = 0.3\n"
    "warmup_s = 5.0\n";

/// y(t) = 0.9 y(t-1) + gain u(t-1) + e(t) + 0.7 e(t-1) about 0.3 m, e: 2 um.
class Rod {
 public:
  double gain_m_per_V = 2e-4;
  double amplitude_V = 1.0;
  config::signals::Sample next() {
    const double e = 2e-6 * normal_(random_);
    y_ = 0.9 * y_ + gain_m_per_V * u_ + e + 0.7 * e_;
    e_ = e;
    u_ = amplitude_V * normal_(random_);
    config::signals::Sample s;
    s.tick = tick_++;
    s.y_m = 0.3 + y_;
    s.u_applied_V = u_;
    return s;
  }

 private:
  std::mt19937_64 random_{1};
  std::normal_distribution<double> normal_;
  double y_ = 0.0, u_ = 0.0, e_ = 0.0;
  std::int64_t tick_ = 0;
};

struct Last final : Events {
  void on_estimate(const EstimateEvent& event) override {
    valid = event.valid;
    reason = std::string(event.reason);
    b1 = event.value("b1");
    c1 = event.value("c1");
    rms_m = event.value("residual_rms_m");
  }
  void on_alarm(const Alarm& alarm) override { alarms.push_back(alarm); }
  bool valid = false;
  std::string reason;
  double b1 = 0.0, c1 = 0.0, rms_m = 0.0;
  std::vector<Alarm> alarms;
};

void run(Pipeline& pipeline, Rod& rod, int samples, Last& seen) {
  for (int i = 0; i < samples; ++i) pipeline.process(rod.next(), seen);
}

TEST(PolynomialMethod, FollowsGainAndNoiseModelAndFeedsBands) {
  Pipeline pipeline(read(kArmax + "[[band]]\nid = 'gain'\nquantity = 'p.b1'\nlow = 1.8e-4\n"
                                  "high = 2.2e-4\n"),
                    kSampleTime_s);
  Rod rod;
  Last seen;
  run(pipeline, rod, 100, seen);
  EXPECT_FALSE(seen.valid);
  EXPECT_EQ(seen.reason, "too few samples yet");
  run(pipeline, rod, 5900, seen);
  EXPECT_TRUE(seen.valid) << seen.reason;
  // About 1000 effective samples: 2 um / (1 V sqrt(1000)) = 0.06e-6 of b1, 0.03 of c1.
  EXPECT_NEAR(seen.b1, 2e-4, 0.4e-6);
  EXPECT_NEAR(seen.c1, 0.7, 0.12);
  EXPECT_NEAR(seen.rms_m, 2e-6, 0.3e-6);
  EXPECT_TRUE(seen.alarms.empty());
  rod.gain_m_per_V = 2.5e-4;
  run(pipeline, rod, 6000, seen);
  EXPECT_NEAR(seen.b1, 2.5e-4, 0.6e-6);
  ASSERT_FALSE(seen.alarms.empty());
  EXPECT_EQ(seen.alarms[0].source, "p");
}

TEST(PolynomialMethod, KeepsItsCoefficientsWhileNothingMoves) {
  Pipeline pipeline(read(kArmax), kSampleTime_s);
  Rod rod;
  Last seen;
  run(pipeline, rod, 4000, seen);
  const double before = seen.b1;
  rod.amplitude_V = 0.0;
  run(pipeline, rod, 4000, seen);
  EXPECT_FALSE(seen.valid);
  EXPECT_EQ(seen.reason, "not excited: coefficients are kept");
  // The window of 2 s still counts as excited for a while; it must not wind up in it.
  EXPECT_NEAR(seen.b1, before, 2e-6);
}

TEST(PolynomialMethod, GoesOnBitForBitAfterASnapshot) {
  const PipelineConfig config = read(kArmax);
  Pipeline one(config, kSampleTime_s);
  Pipeline two(config, kSampleTime_s);
  Rod rod;
  Last seen, other;
  run(one, rod, 1500, seen);
  std::vector<std::uint8_t> bytes;
  StateArchive out = StateArchive::saving(bytes);
  one.serialize(out);
  StateArchive in = StateArchive::restoring(bytes);
  two.serialize(in);
  ASSERT_TRUE(in.complete());
  for (int i = 0; i < 500; ++i) {
    const config::signals::Sample sample = rod.next();
    one.process(sample, seen);
    two.process(sample, other);
  }
  EXPECT_EQ(seen.b1, other.b1);
  EXPECT_EQ(seen.rms_m, other.rms_m);
}

TEST(PolynomialMethod, RefusesWhatCannotBe) {
  for (const char* bad :
       {"structure = 'armax11'", "structure = 'oe121'\nmethod = 'extended-least-squares'"}) {
    const std::string text = "[[polynomial]]\nid = 'p'\n" + std::string(bad) + "\n";
    try {
      Pipeline pipeline(read(text), kSampleTime_s);
      ADD_FAILURE() << bad;
    } catch (const config::schema::ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find("[[polynomial]] p"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace estimator::fdi
