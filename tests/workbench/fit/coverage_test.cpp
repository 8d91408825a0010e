// Do 95 % intervals cover the truth in 95 % of records? Plants drawn by the truth generator, noise
// and motion too; the model starts from the printed values.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "tests/workbench/fit/truth_record.h"

namespace workbench::fit {

namespace greybox = estimator::greybox;
namespace {

const std::string kModels = SPOOLWATCH_SOURCE_DIR "/config/models/";
constexpr int kRecords = 40;

struct Count {
  int inside = 0;
  int of = 0;
  double square = 0.0;
};

/// Fits 40 records of `text` and counts how often the interval holds the truth, per parameter.
Count covered(const std::string& text, const ParameterSelection& selection) {
  const auto model = plant_sim::load_model(kModels + "thesis.toml");
  const std::vector<std::string> motions{"multisine", "fast_steps", "chirp", "slow_steps"};
  Count all;
  std::map<std::string, Count> each;
  for (int i = 0; i < kRecords; ++i) {
    const auto seed = static_cast<std::size_t>(1000 + i);
    const std::string motion = "motion=" + motions[static_cast<std::size_t>(i) % motions.size()];
    const truth::Case of = truth::parse_case(motion + text, seed);
    const greybox::EstimationProblem t = workbench_test::problem(model, of, selection);
    greybox::EstimationOptions options = workbench_test::without_profiles();
    options.starts = 1;
    const greybox::EstimationSummary e = greybox::estimate(t, options);
    for (const truth::PlantField& field : truth::plant_fields(truth::Kind::actuator)) {
      for (const greybox::EstimatedParameter& p : e.parameters) {
        if (p.free.name != field.name) continue;
        const double value = of.plant.*field.member;
        const double z = (value - p.value) / p.std_error;
        for (Count* count : {&all, &each[field.name]}) {
          count->inside += value >= p.low && value <= p.high ? 1 : 0;
          count->square += z * z;
          ++count->of;
        }
      }
    }
  }
  for (const auto& [name, count] : each) {
    std::printf("  %-36s covered %3d of %3d, RMS of (truth - fitted)/std error %.2f\n",
                name.c_str(), count.inside, count.of, std::sqrt(count.square / count.of));
  }
  return all;
}

// Parameters that the record itself determines: the priors do nothing here.
TEST(FitCoverage, IntervalsOfTheRecordAloneCover) {
  const Count count = covered("", {.free = {"valve_gain_m_per_V,damping_N_s_per_m,bulk_modulus_Pa"},
                                   .priors = {"valve_gain_m_per_V=none", "damping_N_s_per_m=none",
                                              "bulk_modulus_Pa=none"}});
  const double share = static_cast<double>(count.inside) / count.of;
  EXPECT_GE(share, 0.90);
  EXPECT_LE(share, 0.99);
}

TEST(FitCoverage, IntervalsWithPriorsCoverPlantsThatAreOffEverywhere) {
  const Count count = covered(",mismatched=1", {});
  const double share = static_cast<double>(count.inside) / count.of;
  EXPECT_GE(share, 0.90);
  // No upper limit: plants are drawn evenly within 1.7 standard deviations of the priors, so that a
  // parameter that only its prior knows is never outside. Errors are not far too large all the
  // same.
  EXPECT_GT(std::sqrt(count.square / count.of), 0.6);
}

}  // namespace
}  // namespace workbench::fit
