// What holds for every effect of the table, and each effect against its own closed form.
#include <gtest/gtest.h>

#include "plant_sim/library.h"
#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

/// A run over both directions, standstill and a stop's neighbourhood; the whole final state.
Actuator::State driven(Actuator& plant) {
  plant.prepare(1e-3);
  plant.reset();
  for (int k = 0; k < 3000; ++k) plant.step(2.0 * std::sin(k * 0.01) + 0.3 * std::sin(k * 0.07));
  return plant.state;
}

TEST(EveryEffect, ChangesNotOneBitWhenNeutral) {
  Actuator without;
  Actuator with;
  with.effects.set_always(true);
  const Actuator::State a = driven(without);
  const Actuator::State b = driven(with);
  EXPECT_EQ(a.y_m, b.y_m);
  EXPECT_EQ(a.v_mps, b.v_mps);
  EXPECT_EQ(a.in_Pa, b.in_Pa);
  EXPECT_EQ(a.out_Pa, b.out_Pa);
  EXPECT_EQ(a.spool_m, b.spool_m);
}

TEST(EveryEffect, HasNoParameterWithoutInfluence) {
  for (const EffectInfo& effect : effect_library()) {
    // pre-sliding hides nothing of the others: all are at their typical size
    Actuator typical;
    for (const ParameterInfo& p : effect.parameters) {
      ASSERT_TRUE(set_effect(typical, effect.name, p.name, p.typical));
    }
    const double base = driven(typical).y_m;
    EXPECT_NE(base, driven(*at_rest()).y_m) << effect.name;
    for (const ParameterInfo& changed : effect.parameters) {
      Actuator other;
      for (const ParameterInfo& p : effect.parameters)
        set_effect(other, effect.name, p.name, p.typical);
      set_effect(other, effect.name, changed.name, 0.5 * changed.typical);
      EXPECT_GT(std::abs(driven(other).y_m - base), 1e-12) << effect.name << "." << changed.name;
    }
  }
}

/// Energy of the rod and of the oil shut in both chambers, p = c - beta ln V with c per chamber.
class ShutEnergy {
 public:
  explicit ShutEnergy(const Actuator& plant)
      : beta_(plant.parameters.bulk_modulus_Pa),
        in_(plant.state.in_Pa + beta_ * std::log(in_m3(plant))),
        out_(plant.state.out_Pa + beta_ * std::log(out_m3(plant))) {}
  [[nodiscard]] double joules(const Actuator& plant, double mass_kg) const {
    return 0.5 * mass_kg * plant.state.v_mps * plant.state.v_mps + oil(in_, in_m3(plant)) +
           oil(out_, out_m3(plant));
  }

 private:
  static double in_m3(const Actuator& p) {
    return p.parameters.dead_volume_m3 + p.parameters.area_m2 * p.state.y_m;
  }
  static double out_m3(const Actuator& p) {
    return p.parameters.dead_volume_m3 +
           p.parameters.area_m2 * (p.parameters.stroke_m - p.state.y_m);
  }
  [[nodiscard]] double oil(double c, double v_m3) const {
    return -(c * v_m3 - beta_ * (v_m3 * std::log(v_m3) - v_m3));
  }
  double beta_, in_, out_;
};

TEST(EveryDissipativeEffect, NeverAddsEnergyToARodSwingingOnShutOil) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> spread(0.2, 4.0);
  for (const EffectInfo& effect : effect_library()) {
    if (!effect.dissipative) continue;
    for (int run = 0; run < 20; ++run) {
      Actuator plant;
      plant.parameters.damping_N_s_per_m = 0.0;
      double mass_kg = plant.parameters.mass_kg;
      for (const ParameterInfo& p : effect.parameters) {
        // a spring stores and gives back; what it stores is not in this balance
        if (std::string(p.name) == "presliding_stiffness_N_per_m") continue;
        const double value = std::min(p.max, p.typical * spread(random));
        set_effect(plant, effect.name, p.name, value);
        if (std::string(p.name) == "mass_kg") mass_kg += value;
      }
      plant.prepare(1e-4);
      plant.reset();
      plant.state.v_mps = 0.2;
      const ShutEnergy energy(plant);
      double least = energy.joules(plant, mass_kg);
      for (int k = 0; k < 5000; ++k) {
        plant.step(0.0);
        const double after = energy.joules(plant, mass_kg);
        // the rod starts with 1 J; a stop inside a step is where RK4's own error shows, which falls
        // with the square of the step
        ASSERT_LE(after - least, 1e-5) << effect.name << " run " << run << " step " << k;
        least = std::min(least, after);
      }
    }
  }
}

TEST(Deadband, OpensNothingInsideAndShiftsTheCommandOutside) {
  auto plant = at_rest();
  set_effect(*plant, "deadband", "half_width_V", 0.2);
  hold(*plant, 0.19, 1.0);
  EXPECT_EQ(plant->state.y_m, 0.305);
  hold(*plant, -1.2, 4.0);
  EXPECT_NEAR(plant->state.v_mps, -steady_speed_mps(plant->parameters, 2.79e-5), 1e-9);
}

TEST(CoupledSlaves, AddMassAndDampingLikeAHeavierRod) {
  Actuator slaves;
  set_effect(slaves, "coupled_slaves", "mass_kg", 30.0);
  set_effect(slaves, "coupled_slaves", "damping_N_s_per_m", 2500.0);
  Actuator heavy;
  heavy.parameters.mass_kg = 80.0;
  heavy.parameters.damping_N_s_per_m = 3500.0;
  EXPECT_NEAR(driven(slaves).y_m, driven(heavy).y_m, 1e-12);
}

TEST(CoupledSlaves, NeedleResistsWithTheSquareOfTheSpeed) {
  auto plant = at_rest();
  set_effect(*plant, "coupled_slaves", "needle_N_s2_per_m2", 3e4);
  hold(*plant, 1.0, 4.0);
  const double expected = steady_speed_mps(plant->parameters, 2.79e-5, 0.0, 3e4);
  EXPECT_NEAR(plant->state.v_mps, expected, 1e-9);
}

}  // namespace
}  // namespace plant_sim::testing
