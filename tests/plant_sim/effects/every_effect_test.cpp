// Properties of every effect of the table, on every plant that it fits.
#include <gtest/gtest.h>

#include <algorithm>
#include <type_traits>

#include "plant_sim/library.h"
#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

template <class Plant>
class EveryEffect : public ::testing::Test {};
using Plants = ::testing::Types<Actuator, Servo, Axis>;
TYPED_TEST_SUITE(EveryEffect, Plants);

/// A run over both directions, standstill and steps; the axis is pushed harder than its friction.
template <class Plant>
std::vector<double> driven(Plant& plant) {
  const double scale = std::string(Plant::kName) == "force_driven_axis" ? 20.0 : 1.0;
  if constexpr (std::is_same_v<Plant, Servo>) plant.parameters.time_constant_s = 0.02;
  plant.prepare(1e-3);
  plant.reset();
  for (int k = 0; k < 3000; ++k) {
    const double u_V = 2.0 * std::sin(k * 0.01) + 0.3 * std::sin(k * 0.07);
    plant.step(scale * (u_V + (k % 400 < 200 ? 1.0 : -1.0)));
  }
  std::vector<double> end = {plant.effects.reading_m(plant.state.y_m)};
  plant.state.visit([&](const char*, double& value) { end.push_back(value); });
  return end;
}

template <class Plant>
bool fits(const EffectInfo& effect) {
  const PlantInfo& plant = *find_plant(Plant::kName);
  return std::all_of(effect.sites.begin(), effect.sites.end(), [&](const std::string& site) {
    return std::count(plant.sites.begin(), plant.sites.end(), site) == 1;
  });
}

TYPED_TEST(EveryEffect, ChangesNotOneBitWhenNeutral) {
  TypeParam without;
  TypeParam with;
  with.effects.set_always(true);
  const std::vector<double> a = driven(without);
  const std::vector<double> b = driven(with);
  EXPECT_TRUE(with.effects.any());
  EXPECT_FALSE(without.effects.any());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i], b[i]) << i;
}

TYPED_TEST(EveryEffect, HasNoParameterWithoutInfluence) {
  TypeParam none;
  const std::vector<double> without = driven(none);
  for (const EffectInfo& effect : effect_library()) {
    if (!fits<TypeParam>(effect)) continue;
    for (const ParameterInfo& changed : effect.parameters) {
      // all others at their typical size, but for a refinement that this one takes the place of
      const auto with_share = [&](double share) {
        TypeParam plant;
        for (const ParameterInfo& p : effect.parameters) {
          const bool replaced = changed.instead_of > 0 && p.refinement == changed.instead_of;
          EXPECT_TRUE(set_effect(plant, effect.name, p.name, replaced ? p.neutral : p.typical));
        }
        set_effect(plant, effect.name, changed.name, share * changed.typical);
        return driven(plant);
      };
      const std::vector<double> base = with_share(1.0);
      EXPECT_NE(base, without) << effect.name;
      EXPECT_GT(std::abs(with_share(0.5)[0] - base[0]), 1e-12)
          << effect.name << "." << changed.name;
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

/// Leaking oil leaves this balance; EveryDissipativeEffect.TakesPowerAtEveryInstant has it.
bool acts_on_rod(const EffectInfo& effect) {
  return effect.sites.back().find("force") != std::string::npos ||
         effect.sites.back() == "dry_friction";
}

TEST(EveryDissipativeEffect, NeverAddsEnergyToARodSwingingOnShutOil) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> spread(0.2, 4.0);
  for (const EffectInfo& effect : effect_library()) {
    if (!effect.dissipative || !acts_on_rod(effect)) continue;
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

TEST(EveryDissipativeEffect, TakesPowerAtEveryInstant) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int checked = 0;
  for (int run = 0; run < 2000; ++run) {
    Actuator plant;
    plant.effects.each([&](auto tag, auto& p) {
      using Effect = typename decltype(tag)::Type;
      if constexpr (Effect::kDissipative) {
        p.visit([&](const ParameterInfo& info, double& value) {
          value = std::clamp(2.0 * info.typical * unit(random), info.min, info.max);
        });
        const double v = unit(random), in = 1e7 * unit(random), out = 1e7 * unit(random);
        if constexpr (effects::has_site(Effect::kSites, effects::Site::force)) {
          EXPECT_GE(Effect::resisting_N(p, unit(random), v) * v, 0.0) << Effect::kName;
          ++checked;
        }
        if constexpr (effects::has_site(Effect::kSites, effects::Site::leakage)) {
          const effects::Leak<double> leak = Effect::leak(p, in, out);
          EXPECT_GE(leak.in_m3ps * in + leak.out_m3ps * out, 0.0) << Effect::kName;
          ++checked;
        }
        if constexpr (effects::has_site(Effect::kSites, effects::Site::supply)) {
          const double ahead = Effect::supply_Pa(p, 7e6, in, std::abs(1e-7 * v));
          EXPECT_GE((7e6 - ahead) * (ahead - in), 0.0) << Effect::kName;
          ++checked;
        }
      }
    });
  }
  EXPECT_EQ(checked, 2000 * 5);  // two forces, two leakages, the supply
}

}  // namespace
}  // namespace plant_sim::testing
