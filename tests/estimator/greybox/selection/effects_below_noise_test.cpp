// Effects that remove less than the noise, of a model that noise explains without them.
#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "estimator/greybox/selection/diagnosis.h"

namespace estimator::greybox::selection {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Entrained air, and a load of -52 +- 4 N that leaves so much of `without_m`.
Diagnosis with_load(double without_m, double with_m) {
  Diagnosis d;
  d.verdict = Verdict::missing;
  d.by_innovations = true;
  d.missing = {"entrained_air", "load_force"};
  d.parameters = {{"entrained_air.fraction_ratio", 0.0335, 2e-4, false},
                  {"load_force.force_N", -52.0, 4.0, false}};
  d.noise_floor_m = 1.6e-6;
  d.rms_before_m = 35e-6;
  d.rms_after_m = with_m;
  d.steps = {{"", 35e-6}, {"entrained_air", without_m}, {"load_force", with_m}};
  return d;
}

std::vector<std::string> doubted(const Diagnosis& d) {
  std::vector<std::string> names;
  for (const PossibleEffect& one : possible_effects(d)) {
    EXPECT_EQ(one.why, Doubt::below_noise);
    names.push_back(one.effect);
  }
  return names;
}

TEST(EffectsBelowNoise, AreNotEstablishedWhereTheyRemoveLessThanAQuarterOfIt) {
  // 1.6 hypot(1, 0.24) and hypot(1, 0.26) of what is left
  EXPECT_THAT(doubted(with_load(1.6e-6 * std::hypot(1.0, 0.24), 1.6e-6)),
              ElementsAre("load_force"));
  EXPECT_THAT(doubted(with_load(1.6e-6 * std::hypot(1.0, 0.26), 1.6e-6)), IsEmpty());
}

TEST(EffectsBelowNoise, AreEstablishedWhereNoiseDoesNotExplainTheModelWithoutThem) {
  EXPECT_THAT(doubted(with_load(1.6e-6 * 1.16, 1.6e-6 * 1.14)), IsEmpty());
}

TEST(EffectsBelowNoise, DoNotIncludeTheFirstOfAPairThatHelpsOnlyTogether) {
  Diagnosis d = with_load(1.6e-6, 1.6e-6);
  d.steps = {{"", 35e-6}, {"load_force", 39e-6}, {"entrained_air", 1.6e-6}};
  EXPECT_THAT(doubted(d), IsEmpty());
}

TEST(EffectsBelowNoise, AloneLeaveNothingEstablished) {
  Diagnosis d = with_load(1.6e-6 * std::hypot(1.0, 0.2), 1.6e-6);
  d.missing = {"load_force"};
  d.steps.erase(d.steps.begin());
  weigh_doubts(d);
  EXPECT_EQ(d.verdict, Verdict::undetermined);
}

}  // namespace
}  // namespace estimator::greybox::selection
