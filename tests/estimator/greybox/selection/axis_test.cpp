// An axis driven by force. Its gain is held in every fit, because mass and all forces scale with
// it; what it becomes within a record is seen nevertheless.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "config/record/record.h"
#include "estimator/greybox/selection/conclusion.h"
#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/law_search.h"
#include "estimator/greybox/selection/noise_credibility.h"
#include "estimator/greybox/selection/structure_search.h"
#include "plant_sim/model_file.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::SizeIs;
using testing::UnorderedElementsAre;

constexpr double kGain_N_per_V = 35.0;

constexpr auto kSteady = [](double) { return kGain_N_per_V; };
constexpr auto kNoRub = [](double, double) { return 0.0; };

struct Rig {
  double mass_kg = 98.0;
  double damping_N_s_per_m = 210.0;
  double kp_V_per_m = 30.0;
  double kd_V_s_per_m = 0.0;
  double shake_m = 0.0;  ///< amplitude of the reference at 5 Hz
};

/// M v' = g(t) u - d v - F - rub(v, y) under a proportional controller, in steps of 0.05 ms; the
/// encoder counts 1 um and has 2 um of noise.
template <class Gain, class Rub = decltype(kNoRub)>
config::record::Record axis_record(const Gain& gain_N_per_V, double load_N,
                                   const Rub& rub_N = kNoRub, const Rig& rig = {}) {
  constexpr double kTs_s = 0.005;
  constexpr int kSteps = 100;
  std::mt19937 random(7);
  std::normal_distribution<double> noise_m(0.0, 2e-6);
  config::record::Record record;
  record.name = "axis";
  record.sample_time_s = kTs_s;
  double y_m = 0.0;
  double v_mps = 0.0;
  double last_m = 0.0;
  for (int k = 0; k < 4000; ++k) {
    const double t_s = kTs_s * k;
    const double asked_m =
        0.05 * (std::sin(0.9 * t_s) + 0.6 * std::sin(3.1 * t_s) + 0.3 * std::sin(8.3 * t_s)) +
        rig.shake_m * std::sin(31.4 * t_s);
    const double read_m = 1e-6 * std::round((y_m + noise_m(random)) / 1e-6);
    const double rate_mps = (asked_m - read_m - last_m) / kTs_s;
    last_m = asked_m - read_m;
    const double u_V =
        std::clamp(rig.kp_V_per_m * last_m + rig.kd_V_s_per_m * rate_mps, -10.0, 10.0);
    record.t_s.push_back(t_s);
    record.u_V.push_back(u_V);
    record.y_m.push_back(read_m);
    for (int i = 0; i < kSteps; ++i) {
      constexpr double kStep_s = kTs_s / kSteps;
      const double force_N = gain_N_per_V(t_s + kStep_s * i) * u_V - rig.damping_N_s_per_m * v_mps -
                             load_N - rub_N(v_mps, y_m + 0.5 * kStep_s * v_mps);
      const double before_mps = v_mps;
      v_mps += kStep_s * force_N / rig.mass_kg;
      y_m += 0.5 * kStep_s * (before_mps + v_mps);
    }
  }
  return record;
}

SearchContext context_of(const config::record::Record& record, double mass_kg = 100.0) {
  plant_sim::ModelFile model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                                     "/config/models/force_driven_axis.toml");
  *model.value("gain_N_per_V") = kGain_N_per_V;
  *model.value("mass_kg") = mass_kg;
  return {make_problem(std::move(model), fit_dataset({dataset_of(record)}, {})), {}};
}

template <class Gain>
SearchContext axis_context(const Gain& gain_N_per_V, double load_N) {
  return context_of(axis_record(gain_N_per_V, load_N));
}

double fades(double t_s) { return t_s < 11.7 ? kGain_N_per_V : 0.85 * kGain_N_per_V; }

TEST(LongAxisGain, FadesBesideALoad) {
  const SearchContext context = axis_context(fades, 18.0);
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::changing);
  ASSERT_THAT(d.changing, SizeIs(1));
  const ParameterChange& change = d.changing.front();
  EXPECT_EQ(change.parameter, "gain_N_per_V");
  EXPECT_EQ(change.kind, ChangeKind::step);
  EXPECT_NEAR(change.at_s, 11.7, 0.01);
  EXPECT_EQ(change.from, kGain_N_per_V);
  EXPECT_NEAR(change.to, 0.85 * kGain_N_per_V, 3.0 * change.to_error + 1e-3);
  // a load and an offset of the command differ by the gain's step alone
  EXPECT_THAT(d.missing, ElementsAre("load_force"));
}

TEST(AxisGain, ThatIsSteadyDoesNotChange) {
  const SearchContext context = axis_context(kSteady, 0.0);
  EXPECT_EQ(diagnose(context.problem, context.options).verdict, Verdict::nothing_missing);
}

// A narrow resonance and a slow random force passed for it; and its level is the plant's damping,
// which alone sets the error of all points together.
TEST(LongAxis, ADampingThatRisesAboutAPlaceIsLearnedAsACurve) {
  const auto tight = [](double v_mps, double y_m) {
    return 120.0 * v_mps * std::exp(-std::pow((y_m - 0.02) / 0.05, 2));
  };
  const SearchContext context = context_of(axis_record(kSteady, 0.0, tight));
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::learned);
  EXPECT_THAT(d.missing, ElementsAre("force_over_y_times_v"));
  EXPECT_LT(d.rms_after_m, 1.15 * d.noise_floor_m);
  EXPECT_FALSE(d.disturbance && d.disturbance->value > 0.1);  // N
}

// Nothing but mass and damping, 0.47 s here, brings the speed back that a simulation starts with.
TEST(Axis, IsHealthyInARecordThatBeginsInMotionAndHasAGap) {
  config::record::Record record = axis_record(kSteady, 0.0);
  const auto cut = [&](std::ptrdiff_t from, std::ptrdiff_t to) {
    for (std::vector<double>* values : {&record.t_s, &record.u_V, &record.y_m}) {
      values->erase(values->begin() + from, values->begin() + to);
    }
  };
  cut(2000, 2001);
  cut(0, 700);
  record.gaps = {1300};
  const SearchContext context = context_of(record);
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::nothing_missing);
  EXPECT_LT(d.rms_after_m, 1.1 * d.noise_floor_m);
}

/// A force whose power is even up to 3 Hz, in the steps of axis_record().
class RandomForce {
 public:
  RandomForce(double rms_N, unsigned seed) : rms_N_(rms_N), random_(seed) {}
  double next_N() {
    constexpr double kRate = 5e-5 * 2.0 * 3.141592653589793 * 3.0;
    value_N_ += -kRate * value_N_ + std::sqrt(2.0 * kRate) * rms_N_ * normal_(random_);
    return value_N_;
  }

 private:
  double rms_N_;
  double value_N_ = 0.0;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

// Nothing holds the axis in place: the force carries it as far as it moves, and more friction or
// damping would leave less.
TEST(Axis, IsHealthyWhereAForceCarriesItFar) {
  RandomForce force(12.0, 3);
  const Rig light{12.0, 50.0, 158.0, 8.9, 0.02};
  SearchContext context =
      context_of(axis_record(
                     kSteady, 0.0, [&](double, double) { return force.next_N(); }, light),
                 light.mass_kg);
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::nothing_missing);
  ASSERT_TRUE(d.disturbance);
  EXPECT_NEAR(d.disturbance->value, 12.0, 3.0);
  plant_sim::ModelFile better = d.better;
  EXPECT_NEAR(*better.value("mass_kg"), light.mass_kg, 0.5);
  EXPECT_NEAR(*better.value("damping_N_s_per_m"), light.damping_N_s_per_m, 10.0);
}

// Half of the drive's force, over waves that the motion crosses several times: between two of them
// the smallest difference decides where a simulation goes.
TEST(AxisRipple, IsNamedWhereNoSimulationFollowsTheMotion) {
  const auto ripple_N = [](double, double y_m) {
    return 15.0 * std::sin(2.0 * std::numbers::pi * y_m / 0.032 + 1.0);
  };
  const Rig light{12.0, 50.0, 158.0, 8.9};
  const SearchContext context =
      context_of(axis_record(kSteady, 0.0, ripple_N, light), light.mass_kg);
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_THAT(d.missing, ElementsAre("force_ripple"));
  EXPECT_TRUE(d.loses_motion);
  plant_sim::ModelFile better = d.better;
  EXPECT_NEAR(*better.value("mass_kg"), light.mass_kg, 0.01);
  EXPECT_NEAR(*better.value("force_ripple.amplitude_N"), 15.0, 0.01);
  EXPECT_NEAR(*better.value("force_ripple.wavelength_m"), 0.032, 1e-5);
}

// Magnets are no sines: what a sine leaves looks like another effect of the position.
TEST(AxisRipple, TakesItsSecondHarmonicBeforeAnotherEffect) {
  const auto ripple_N = [](double, double y_m) {
    const double wave_rad = 2.0 * std::numbers::pi * y_m / 0.016 + 0.4;
    return 12.0 * std::sin(wave_rad) + 3.0 * std::sin(2.0 * wave_rad) -
           2.0 * std::cos(2.0 * wave_rad);
  };
  const SearchContext context = context_of(axis_record(kSteady, 0.0, ripple_N));
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_THAT(d.missing, ElementsAre("force_ripple"));
  EXPECT_LT(d.rms_after_m, 1.05 * d.noise_floor_m);
  plant_sim::ModelFile better = d.better;
  EXPECT_NEAR(*better.value("force_ripple.wavelength_m"), 0.016, 1e-5);
  EXPECT_NEAR(*better.value("force_ripple.amplitude_N"), 12.0, 0.1);
  EXPECT_NEAR(*better.value("force_ripple.second_sin_N"), 3.0, 0.1);
  EXPECT_NEAR(*better.value("force_ripple.second_cos_N"), -2.0, 0.1);
}

// Of a ripple at the noise the first round shows a shorter wave, and an encoder's makes up for it.
TEST(AxisRipple, IsOneWhereTwoWavesExplainAsMuch) {
  const truth::Record truth = truth::simulate(
      truth::parse_case("rig=linear_axis,motion=triangle,length_s=20,"
                        "force_ripple.amplitude_N=0.006,force_ripple.wavelength_m=0.02",
                        8));
  const SearchContext context{
      make_problem(plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                         "/config/models/force_driven_axis.toml"),
                   fit_dataset({diagnose_test::dataset_of(truth)}, {})),
      {}};
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_THAT(d.missing, ElementsAre("force_ripple"));
  plant_sim::ModelFile better = d.better;
  EXPECT_NEAR(*better.value("force_ripple.wavelength_m"), 0.02, 4e-4);
  EXPECT_NEAR(*better.value("force_ripple.amplitude_N"), 0.006, 6e-4);
}

TEST(AxisRipple, IsAmplifiedWhereTheRandomPartIsNextToNothing) {
  const SearchContext context = axis_context(kSteady, 0.0);
  const InnovationSearch search;
  Disturbance small;
  small.as = "force";
  small.value = 1e-3;
  small.rms_m = 1.0;
  EXPECT_TRUE(loses_motion(context, search, small));
  Disturbance other = small;
  other.lines = {{"force", 3.0, 20.0, 1.0}};
  EXPECT_FALSE(loses_motion(context, search, other)) << "a line moves the axis as far";
  other = small;
  other.value = 0.0;
  EXPECT_FALSE(loses_motion(context, search, other));
  other.value = 10.0;
  EXPECT_FALSE(loses_motion(context, search, other)) << "a strong force needs no amplifying";
  other = small;
  other.rms_m = 1e-6;
  EXPECT_FALSE(loses_motion(context, search, other));
}

// A contact that turns its sign over 0.3 or 2 mm/s; neither a spring before it slides nor a jump
// does.
TEST(AxisFriction, TurnsGradually) {
  for (const double transition_mps : {3e-4, 2e-3}) {
    const SearchContext context = context_of(axis_record(kSteady, 0.0, [&](double v_mps, double) {
      return 20.0 * std::tanh(v_mps / transition_mps);
    }));
    const Diagnosis d = diagnose(context.problem, context.options);
    EXPECT_EQ(d.verdict, Verdict::missing);
    EXPECT_THAT(d.missing, ElementsAre("friction"));
    EXPECT_LT(d.rms_after_m, 1.1 * d.noise_floor_m);
    plant_sim::ModelFile better = d.better;
    EXPECT_NEAR(*better.value("friction.coulomb_N"), 20.0, 0.02);
    EXPECT_NEAR(*better.value("friction.transition_mps"), transition_mps, 0.1 * transition_mps);
  }
}

// Laws are sought before further effects where one of the level of friction promises more than a
// remainder.
TEST(AxisFriction, LeavesSomethingToALawOfItsLevelWhereItChangesAlongTheStroke) {
  for (const double slope_per_m : {0.0, 4.0}) {
    const auto rub_N = [&](double v_mps, double y_m) {
      return 20.0 * (1.0 + slope_per_m * y_m) * std::tanh(v_mps / 3e-4);
    };
    config::record::Record record = axis_record(kSteady, 0.0, rub_N);
    for (std::vector<double>* values : {&record.t_s, &record.u_V, &record.y_m}) {
      values->resize(2800);
    }
    SearchContext context = context_of(record);
    EXPECT_EQ(friction_level_nats(context, {}), 0.0);  // no friction, no level
    *context.problem.model.value("friction.coulomb_N") = 15.0;
    *context.problem.model.value("friction.transition_mps") = 3e-4;
    context.problem = make_problem(context.problem.model, context.problem.data);
    const InnovationStage stage =
        settled(context, start_search(context).first, {}, Settling::once, SimulationWidth{});
    const double nats = friction_level_nats(context, stage);
    EXPECT_EQ(nats > kCurve_nats + 10.0, slope_per_m > 0.0) << nats;
  }
}

// The library has no such effect: a law of the level of friction.
TEST(LongAxisFriction, ChangesAlongTheStroke) {
  const auto rub_N = [](double v_mps, double y_m) {
    return 20.0 * (1.0 + 4.0 * y_m) * std::tanh(v_mps / 3e-4);
  };
  const SearchContext context = context_of(axis_record(kSteady, 0.0, rub_N));
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::learned);
  ASSERT_THAT(d.laws, SizeIs(1));
  EXPECT_EQ(d.laws.front().effect.name, "sloping_friction");
  EXPECT_LT(d.rms_after_m, 1.2 * d.noise_floor_m);
  EXPECT_EQ(d.where.front().site, "force");
  EXPECT_EQ(d.where.front().variable, "y");
}

// A tight spot that the motion passes in a tenth of its way.
TEST(LongAxisFriction, RisesAtATightSpot) {
  const auto rub_N = [](double v_mps, double y_m) {
    const double apart = (y_m - 0.03) / 0.008;
    return (12.0 + 25.0 * std::exp(-apart * apart)) * std::tanh(v_mps / 3e-4);
  };
  const SearchContext context = context_of(axis_record(kSteady, 0.0, rub_N));
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::learned);
  ASSERT_THAT(d.laws, SizeIs(1));
  EXPECT_EQ(d.laws.front().effect.name, "local_friction");
  plant_sim::ModelFile better = d.better;
  EXPECT_NEAR(*better.value("local_friction.rest_m"), 0.03, 2e-4);
  EXPECT_NEAR(*better.value("local_friction.width_m"), 0.008, 2e-4);
}

// An offset and a load are one on an axis, also where an error remains.
TEST(AxisGain, ThatIsNotSoughtLeavesOffsetAndLoadRivals) {
  SearchContext context = axis_context(fades, 18.0);
  context.problem.effects_only = true;
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::unexplained);
  ASSERT_THAT(d.missing, SizeIs(1));
  auto groups = d.ambiguous;
  groups.insert(groups.end(), d.same_here.begin(), d.same_here.end());
  EXPECT_THAT(groups, Contains(UnorderedElementsAre("null_bias", "load_force")));
}

}  // namespace
}  // namespace estimator::greybox::selection
