// An ensemble's lanes do what single plants do, whatever instruction set they are compiled for.
#include "plant_sim/ensemble.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <thread>

#include "plant_sim/library.h"
#include "plant_sim/plant.h"

namespace plant_sim::testing {
namespace {

constexpr std::size_t kLanes = Ensemble::kLanes;
/// Rounding only; the operations are the same.
constexpr double kAgree = 1e-12;
constexpr double kAgree_Pa = 1e-4;
constexpr double kSample_s = 0.005;
constexpr double kStep_s = 0.001;

const char* name_of(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return "AVX-512";
    case InstructionSet::avx2:
      return "AVX2";
    default:
      return "baseline";
  }
}

/// Those that this machine has; says which are left out.
std::vector<InstructionSet> sets_here() {
  std::vector<InstructionSet> sets = {InstructionSet::baseline};
  for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
    if (runs_here(set)) {
      sets.push_back(set);
    } else {
      std::printf("  not run: this machine or build has no %s\n", name_of(set));
    }
  }
  return sets;
}

/// Eight models that differ in parameters, as an ensemble of every instruction set and alone.
class Side {
 public:
  explicit Side(ModelFile model, double start_m) : start_m_(start_m) {
    model.initial.push_back({"y_m", start_m});
    for (const InstructionSet set : sets_here()) {
      together_.push_back(make_ensemble(model, kStep_s, set));
    }
    for (auto& plant : alone_) plant = make_plant(model);
  }

  void set(std::size_t lane, const std::string& name, double value) {
    for (auto& ensemble : together_) {
      const auto found = ensemble->find(name);
      ASSERT_TRUE(found) << name;
      ensemble->set(*found, lane, value);
      EXPECT_EQ(ensemble->get(*found, lane), value);
    }
    *alone_[lane]->parameter(name) = value;
  }

  void start() {
    for (auto& ensemble : together_) ensemble->start(start_m_);
    for (auto& plant : alone_) {
      plant->advance(0.0, 0.0);  // takes over the parameters
      plant->reset();
      shift(*plant, start_m_ - plant->position_m());
      shift(*plant, -(plant->reading_m() - start_m_));
    }
  }

  /// One sample with these volts; then the observer's correction by that way.
  void sample(const Ensemble::Values& u_V, const Ensemble::Values& by_m) {
    for (auto& ensemble : together_) ensemble->advance(u_V, kSample_s);
    for (auto& ensemble : together_) ensemble->shift(by_m);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      alone_[lane]->advance(u_V[lane], kSample_s);
      shift(*alone_[lane], by_m[lane]);
    }
  }

  void compare(const std::string& what) const {
    for (const auto& ensemble : together_) {
      const Ensemble::Values reading_m = ensemble->reading_m();
      const Ensemble::Values speed_mps = ensemble->speed_mps();
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        ASSERT_NEAR(reading_m[lane], alone_[lane]->reading_m(), kAgree) << what << " lane " << lane;
        ASSERT_NEAR(speed_mps[lane], alone_[lane]->speed_mps(), kAgree) << what << " lane " << lane;
      }
      ASSERT_EQ(reading_m, together_[0]->reading_m()) << what;
      ASSERT_EQ(speed_mps, together_[0]->speed_mps()) << what;
      compare_pressures(ensemble->pressures(), what);
    }
  }

 private:
  void compare_pressures(const PressuresOf<Ensemble::Values>& found,
                         const std::string& what) const {
    const PressuresOf<Ensemble::Values> first = together_[0]->pressures();
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const config::signals::Pressures alone = alone_[lane]->pressures();
      const auto near = [&](double lanes_Pa, double baseline_Pa, double alone_Pa) {
        const std::string where = what + " lane " + std::to_string(lane);
        if (std::isnan(alone_Pa)) {
          ASSERT_TRUE(std::isnan(lanes_Pa)) << where;
          return;
        }
        ASSERT_NEAR(lanes_Pa, alone_Pa, kAgree_Pa) << where;
        ASSERT_EQ(lanes_Pa, baseline_Pa) << where;
      };
      near(found.supply_Pa[lane], first.supply_Pa[lane], alone.supply_Pa);
      near(found.in_Pa[lane], first.in_Pa[lane], alone.in_Pa);
      near(found.out_Pa[lane], first.out_Pa[lane], alone.out_Pa);
    }
  }
  static void shift(Plant& plant, double by_m) {
    const double y_m = plant.position_m() + by_m;
    plant.set_state({&y_m, 1});
  }

  double start_m_;
  std::vector<std::unique_ptr<Ensemble>> together_;
  std::array<std::unique_ptr<Plant>, kLanes> alone_;
};

class EveryEnsemble : public ::testing::TestWithParam<const char*> {
 protected:
  static ModelFile model() {
    ModelFile model;
    model.plant = GetParam();
    model.parameters.clear();
    model.initial.clear();
    return model;
  }
  static bool actuator() { return std::string(GetParam()).find("hydraulic") == 0; }

  /// Three seconds over both directions; at 10 V the actuator reaches its stops.
  static void drive(Side& side, double most_V, const std::string& what) {
    side.start();
    side.compare(what + " at the start");
    for (int k = 0; k < 600 && !HasFatalFailure(); ++k) {
      Ensemble::Values u_V;
      Ensemble::Values by_m;
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        u_V[lane] = most_V * std::sin(k * 0.02) + 0.01 * static_cast<double>(lane);
        by_m[lane] = 1e-6 * static_cast<double>(k % 7) - 3e-6;
      }
      side.sample(u_V, by_m);
      side.compare(what + " sample " + std::to_string(k));
    }
  }
  static double volts() { return std::string(GetParam()) == "force_driven_axis" ? 30.0 : 3.0; }
};
INSTANTIATE_TEST_SUITE_P(Plants, EveryEnsemble,
                         ::testing::Values("hydraulic_actuator", "hydraulic_cylinder",
                                           "velocity_servo", "force_driven_axis"),
                         [](const auto& of) { return std::string(of.param); });

TEST_P(EveryEnsemble, HasLanesThatAgreeWithSinglePlantsForEachEffect) {
  const PlantInfo& plant = *find_plant(GetParam());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> spread(0.25, 1.5);
  for (const EffectInfo& effect : effect_library()) {
    bool fits = true;
    for (const std::string& site : effect.sites) {
      fits = fits && std::find(plant.sites.begin(), plant.sites.end(), site) != plant.sites.end();
    }
    if (!fits) continue;
    Side side(model(), 0.3);
    for (std::size_t lane = 1; lane < kLanes; ++lane) {  // neutral stands beside active
      for (const ParameterInfo& p : effect.parameters) {
        // the friction that slides at once and the one with bristles
        if (lane % 2 == 0 && p.refinement > 1) continue;
        side.set(lane, effect.name + "." + p.name, p.typical * spread(random));
      }
    }
    drive(side, volts(), effect.name);
    if (HasFatalFailure()) return;
  }
}

TEST_P(EveryEnsemble, HasLanesThatAgreeWithSinglePlantsForAllEffectsAndAtTheLimits) {
  const PlantInfo& plant = *find_plant(GetParam());
  std::mt19937 random(6);
  std::uniform_real_distribution<double> spread(0.6, 1.6);
  for (int run = 0; run < 4; ++run) {
    Side side(model(), 0.3);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      for (const ParameterInfo& p : plant.parameters) {
        side.set(lane, p.name, p.neutral * spread(random));
      }
      for (const EffectInfo& effect : effect_library()) {
        const std::string first = effect.name + "." + effect.parameters[0].name;
        if (run % 2 == 0 || lane % 3 == 0 || spread(random) < 1.0) continue;
        if (!make_plant(model())->parameter(first)) continue;
        for (const ParameterInfo& p : effect.parameters) {
          side.set(lane, effect.name + "." + p.name, p.typical * spread(random) * 0.5);
        }
      }
    }
    drive(side, run < 2 ? volts() : 10.0 * volts(), "run " + std::to_string(run));
    if (HasFatalFailure()) return;
  }
}

TEST(Ensemble, TakesFormulasOfTheModelFile) {
  ModelFile model;
  formula::FormulaEffect effect;
  effect.name = "seal";
  effect.site = "force";
  effect.formula = "a * v_mps / sqrt(v_mps*v_mps + 1e-4) * (1 + 0.3 * sin(40 * y_m))";
  formula::FormulaEffect::Parameter a;
  a.name = "a";
  a.what = "size";
  a.min = 0.0;
  a.max = 1e4;
  a.typical = 200.0;
  a.neutral = 0.0;
  effect.parameters = {a};
  model.declare(effect, "test");
  Side side(model, 0.3);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    side.set(lane, "seal.a", 100.0 * static_cast<double>(lane));
  }
  side.start();
  Ensemble::Values still{};
  for (int k = 0; k < 600 && !::testing::Test::HasFatalFailure(); ++k) {
    Ensemble::Values u_V;
    u_V.fill(2.0 * std::sin(k * 0.03));
    side.sample(u_V, still);
    side.compare("sample " + std::to_string(k));
  }
}

Ensemble::Values run(InstructionSet set, double volts) {
  const auto ensemble = make_ensemble(ModelFile(), kStep_s, set);
  ensemble->start(0.3);
  Ensemble::Values u_V;
  for (int k = 0; k < 400; ++k) {
    u_V.fill(volts * std::sin(k * 0.01));
    ensemble->advance(u_V, kSample_s);
  }
  return ensemble->reading_m();
}

TEST(Ensemble, IsIndependentOfAnotherInASecondThread) {
  const InstructionSet set = fastest_here();
  const Ensemble::Values one_m = run(set, 1.0);
  const Ensemble::Values two_m = run(set, 2.0);
  Ensemble::Values beside_m;
  std::thread thread([&] { beside_m = run(set, 2.0); });
  EXPECT_EQ(run(set, 1.0), one_m);
  thread.join();
  EXPECT_EQ(beside_m, two_m);
}

/// Reading at each sample with a force in lane 3 that alternates, by `hold(ensemble, force_N)`.
template <class Hold>
std::vector<Ensemble::Values> alternating_force(const std::string& plant, const Hold& hold) {
  ModelFile model;
  model.plant = plant;
  const auto ensemble = make_ensemble(model, kStep_s);
  if (const auto friction = ensemble->find("friction.coulomb_N")) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) ensemble->set(*friction, lane, 40.0);
  }
  ensemble->start(0.3);
  std::vector<Ensemble::Values> readings_m;
  for (int k = 0; k < 400; ++k) {
    hold(*ensemble, k % 50 < 25 ? 300.0 : -200.0);
    Ensemble::Values u_V;
    u_V.fill(0.5 * std::sin(k * 0.03));
    ensemble->advance(u_V, kSample_s);
    readings_m.push_back(ensemble->reading_m());
  }
  return readings_m;
}

TEST(Ensemble, ADisturbanceIsALoadOfItsLane) {
  const auto disturbed = [](Ensemble& ensemble, double force_N) {
    Ensemble::Values forces_N{};
    forces_N[3] = force_N;
    ensemble.disturb(forces_N);
  };
  const auto loaded = [](Ensemble& ensemble, double force_N) {
    ensemble.set(ensemble.find("load_force.force_N").value(), 3, force_N);
  };
  const auto alone = [](Ensemble& /*ensemble*/, double /*force_N*/) {};
  for (const char* const plant :
       {"hydraulic_actuator", "hydraulic_cylinder", "force_driven_axis"}) {
    SCOPED_TRACE(plant);
    const auto one_m = alternating_force(plant, disturbed);
    const auto other_m = alternating_force(plant, loaded);
    const auto alone_m = alternating_force(plant, alone);
    double moved_m = 0.0;
    for (std::size_t k = 0; k < one_m.size(); ++k) {
      ASSERT_NEAR(one_m[k][3], other_m[k][3], kAgree) << "sample " << k;
      ASSERT_EQ(one_m[k][2], alone_m[k][2]) << "sample " << k;
      moved_m = std::fmax(moved_m, std::fabs(one_m[k][3] - one_m[k][2]));
    }
    EXPECT_GT(moved_m, 1e-5);
  }
  EXPECT_EQ(alternating_force("velocity_servo", disturbed),
            alternating_force("velocity_servo", alone));
}

TEST(Ensemble, TakesAParameterThatIsSetBetweenSamples) {
  const auto ensemble = make_ensemble(ModelFile(), kStep_s);
  ensemble->start(0.3);
  Ensemble::Values u_V;
  u_V.fill(1.0);
  ensemble->advance(u_V, kSample_s);
  ensemble->set(ensemble->find("valve_gain_m_per_V").value(), 1, 0.0);
  for (int k = 0; k < 400; ++k) ensemble->advance(u_V, kSample_s);  // the oil comes to rest
  const Ensemble::Values before_m = ensemble->reading_m();
  for (int k = 0; k < 100; ++k) ensemble->advance(u_V, kSample_s);
  EXPECT_NEAR(ensemble->reading_m()[1], before_m[1], 1e-6);
  EXPECT_GT(std::fabs(ensemble->reading_m()[0] - before_m[0]), 1e-3);
}

TEST(Ensemble, RunsOnTheBaselineAndTakesTheWidestThatRunsHere) {
  EXPECT_TRUE(runs_here(InstructionSet::baseline));
  EXPECT_TRUE(runs_here(fastest_here()));
  EXPECT_EQ(fastest_here(), sets_here().back());
}

}  // namespace
}  // namespace plant_sim::testing
