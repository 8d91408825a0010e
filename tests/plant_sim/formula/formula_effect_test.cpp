// Formula effects in the plants: they do what an effect of the library with the same equation does,
// in a single run and in lanes, and nothing when neutral.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "plant_sim/library.h"
#include "plant_sim/plant.h"
#include "tests/plant_sim/formula/formula_support.h"
#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

/// Rounding of another order of the same operations.
constexpr double kAgree = 1e-12;

struct Twin {
  const char* plant;
  const char* site;
  const char* formula;
  const char* value;       ///< k's
  const char* of_library;  ///< the same with its table
  double full_V;
};

/// The same equation as a formula and as an effect of the library.
const Twin kTwins[] = {
    {"hydraulic_actuator", "force", "k*v_mps*abs(v_mps)", "2e4",
     "[effects.quadratic_damping]\ncoefficient_N_s2_per_m2 = 2e4\n", 5.0},
    {"force_driven_axis", "force", "if(v_mps < 0, -k, k)*v_mps^2", "300.0",
     "[effects.quadratic_damping]\ncoefficient_N_s2_per_m2 = 300.0\n", 20.0},
    {"hydraulic_actuator", "force", "k*(y_m - 0.3)", "2e4",
     "[effects.load_spring]\nstiffness_N_per_m = 2e4\nrest_m = 0.3\n", 3.0},
    {"hydraulic_actuator", "force", "k", "500.0", "[effects.load_force]\nforce_N = 500.0\n", 3.0},
    {"hydraulic_actuator", "leakage", "k*1e-15*(in_Pa - out_Pa)", "2e3",
     "[effects.internal_leakage]\nconductance_m3ps_per_Pa = 2e-12\n", 3.0},
    {"hydraulic_actuator", "flow", "q_m3ps - (q_m3ps - max(min(q_m3ps, 3e-5), -3e-5))*k", "1.0",
     "[effects.flow_saturation]\nlimit_m3ps = 3e-5\n", 5.0},
    {"hydraulic_actuator", "opening", "x_m*(1 + if(x_m < 0, -k, k))", "0.08",
     "[effects.flow_asymmetry]\nasymmetry_ratio = 0.08\n", 3.0},
    {"velocity_servo", "opening", "x_m - max(min(x_m, 0.05*k), -0.05*k)", "0.3",
     "[effects.deadband]\nhalf_width_V = 0.3\n", 2.0},
    {"velocity_servo", "command", "u_V + k", "-0.4", "[effects.null_bias]\noffset_V = -0.4\n", 2.0},
    {"hydraulic_actuator", "sensor", "y_m + k*sin(2*pi*y_m/0.02 + 0.7)", "5e-5",
     "[effects.encoder_eccentricity]\namplitude_m = 5e-5\nwavelength_m = 0.02\nphase_rad = 0.7\n",
     3.0},
};

double drive_V(int k, double full_V) { return full_V * std::sin(k * 0.05) + 0.1 * full_V; }

TEST(FormulaEffect, DoesWhatTheEffectOfTheLibraryWithTheSameEquationDoes) {
  for (const Twin& twin : kTwins) {
    const std::string head = plant_text(twin.plant);
    auto own = make_plant(model_of(head + own_text(twin.site, twin.formula, "-1e6", "1e6") +
                                   "[effects.own]\nk = " + twin.value + "\n"));
    auto library = make_plant(model_of(head + twin.of_library));
    auto without = make_plant(model_of(head));
    double influence_m = 0.0;
    for (int k = 0; k < 600; ++k) {
      for (const auto& plant : {&own, &library, &without}) {
        (*plant)->advance(drive_V(k, twin.full_V), 0.005);
      }
      ASSERT_NEAR(own->reading_m(), library->reading_m(), kAgree) << twin.formula << " at " << k;
      influence_m = std::max(influence_m, std::abs(own->reading_m() - without->reading_m()));
    }
    EXPECT_GT(influence_m, 1e-5) << twin.formula;
  }
}

double mass_kg(const std::string& plant) {
  return *ModelFile(model_of(plant_text(plant))).value("mass_kg");
}

// Levels, springs and damping of a contact go with its friction: half as much again is that of
// parameters half as large again.
TEST(FormulaEffect, RaisesDryFrictionAsAWhole) {
  const auto friction = [](double ratio, double spring, double transition_mps) {
    return fmt::format(
        "[effects.friction]\ncoulomb_N = {}\nstatic_N = {}\nstribeck_mps = 0.01\n"
        "presliding_stiffness_N_per_m = {}\npresliding_damping_N_s_per_m = {}\n"
        "transition_mps = {}\n",
        60.0 * ratio, 75.0 * ratio, 2e5 * ratio * spring, 300.0 * ratio * spring, transition_mps);
  };
  for (const char* name : {"force_driven_axis", "hydraulic_actuator", "hydraulic_cylinder"}) {
    // 64 parts of 1 ms resolve this one with the friction as it is, and not half as large again
    const double between_mps = 1.2 * 75.0 * 1e-3 / (2.0 * 64.0 * mass_kg(name));
    for (const auto& [spring, transition_mps] :
         {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.0, 2e-3}, {0.0, between_mps}}) {
      const std::string head = plant_text(name);
      auto own =
          make_plant(model_of(head + own_text("dry_friction", "k", "-1e6", "1e6") +
                              "[effects.own]\nk = 0.5\n" + friction(1.0, spring, transition_mps)));
      auto library = make_plant(model_of(head + friction(1.5, spring, transition_mps)));
      auto without = make_plant(model_of(head + friction(1.0, spring, transition_mps)));
      double influence_m = 0.0;
      for (int k = 0; k < 600; ++k) {
        for (const auto& plant : {&own, &library, &without}) {
          (*plant)->advance(drive_V(k, 4.0), 0.005);
        }
        ASSERT_NEAR(own->reading_m(), library->reading_m(), 1e-7)
            << name << " at " << k << ", spring " << spring << ", transition " << transition_mps;
        influence_m = std::max(influence_m, std::abs(own->reading_m() - without->reading_m()));
      }
      EXPECT_GT(influence_m, 1e-5) << name;
    }
  }
}

// m y'' = F - Fc (1 + k y) swings by y = a (1 - cos w t), a = (F - Fc) / (Fc k), w^2 = Fc k / m, up
// to 2 a, where the friction holds it.
TEST(FormulaEffect, RaisesDryFrictionAlongTheStroke) {
  auto plant = make_plant(model_of(
      plant_text("force_driven_axis") + "[parameters]\nmass_kg = 50.0\ndamping_N_s_per_m = 0.0\n" +
      own_text("dry_friction", "k*y_m", "0.0", "100.0") +
      "[effects.own]\nk = 5.0\n[effects.friction]\ncoulomb_N = 70.0\n"));
  const double swing_m = 35.0 / (70.0 * 5.0);
  const double rate_per_s = std::sqrt(70.0 * 5.0 / 50.0);
  plant->advance(3.0, 0.8);
  EXPECT_NEAR(plant->reading_m(), swing_m * (1.0 - std::cos(0.8 * rate_per_s)), 2e-5);
  plant->advance(3.0, 2.0);
  EXPECT_NEAR(plant->reading_m(), 2.0 * swing_m, 1e-4);
  EXPECT_LT(std::abs(plant->speed_mps()), 1e-8);
}

TEST(FormulaEffect, FollowsTheClosedFormOfASteadyState) {
  // F = k v^3 on the axis: gain u = d v + k v^3
  auto plant = make_plant(model_of(plant_text("force_driven_axis") +
                                   own_text("force", "k*v_mps^3", "0.0", "1e7") +
                                   "[effects.own]\nk = 5e4\n"));
  const double v_mps = 0.15;
  plant->advance((200.0 * v_mps + 5e4 * v_mps * v_mps * v_mps) / 35.0, 10.0);
  EXPECT_NEAR(plant->speed_mps(), v_mps, 1e-9);
}

/// Model with the formula `own`, its parameter k and a further line of its table.
ModelFile own_model(const std::string& plant, const std::string& site, const std::string& formula,
                    const std::string& line, const std::string& k) {
  return model_of(plant_text(plant) + "[formula_effects.own]\nsite = \"" + site +
                  "\"\nformula = \"" + formula + "\"\n" + line +
                  "\n[formula_effects.own.parameters.k]\nmin = -1e6\nmax = 1e6\ntypical = 1.0\n" +
                  "[effects.own]\nk = " + k + "\n");
}

TEST(FormulaEffect, SeesTheCommandInAForce) {
  // gain u - k u: an axis of a lower gain
  auto own = make_plant(own_model("force_driven_axis", "force", "k*u_V", "", "5.0"));
  auto library =
      make_plant(model_of(plant_text("force_driven_axis") + "[parameters]\ngain_N_per_V = 30.0\n"));
  for (int k = 0; k < 400; ++k) {
    own->advance(drive_V(k, 20.0), 0.005);
    library->advance(drive_V(k, 20.0), 0.005);
    ASSERT_NEAR(own->position_m(), library->position_m(), kAgree);
  }
}

TEST(FormulaEffect, SeesThePressuresInAForce) {
  // the force of the oil, A (Pi - Po), undone: the rod stays, whatever the valve does
  auto plant = make_plant(
      own_model("hydraulic_actuator", "force", "k*(in_Pa - out_Pa)", "", std::to_string(0.000633)));
  ASSERT_DOUBLE_EQ(*plant->parameter("area_m2"), 0.000633);
  plant->advance(2.0, 0.2);
  EXPECT_GT(std::abs(plant->state()[2].value - plant->state()[3].value), 1e5);
  EXPECT_NEAR(plant->position_m(), 0.305, 1e-9);
}

TEST(FormulaEffect, SeesThePositionInACommand) {
  // y' = g (u - k y) with y held through each step of h: y = u/k (1 - (1 - g k h)^n)
  auto plant = make_plant(own_model("velocity_servo", "command", "u_V - k*y_m", "", "40.0"));
  plant->advance(2.0, 0.3);
  const double left = std::pow(1.0 - 0.05 * 40.0 * 1e-3, 300);
  EXPECT_NEAR(plant->position_m(), 2.0 / 40.0 * (1.0 - left), kAgree);
}

TEST(FormulaEffect, SeesTheAccelerationOfTheLastStep) {
  // u constant, no speed yet: M a = gain u - k a, with the a of a step before
  auto plant = make_plant(own_model("force_driven_axis", "force", "k*a_mps2", "", "50.0"));
  *plant->parameter("damping_N_s_per_m") = 0.0;
  plant->advance(20.0, 0.5);
  const double before_mps = plant->speed_mps();
  plant->advance(20.0, 0.1);
  EXPECT_NEAR((plant->speed_mps() - before_mps) / 0.1, 35.0 * 20.0 / (100.0 + 50.0), 1e-9);
}

TEST(FormulaEffect, RemembersAFirstOrderLag) {
  // y' = g (u + k z), z' = (u - z)/tau: z = u (1 - exp(-t/tau)) at the start of each step
  auto plant = make_plant(
      own_model("velocity_servo", "command", "u_V + k*z", "memory = \"(u_V - z)/0.2\"", "0.5"));
  auto zero = plant->position_m();
  plant->advance(2.0, 0.4);
  double expected_m = 0.0;
  for (int i = 0; i < 400; ++i) {
    expected_m += 1e-3 * 0.05 * 2.0 * (1.0 + 0.5 * (1.0 - std::exp(-i * 1e-3 / 0.2)));
  }
  EXPECT_NEAR(plant->position_m() - zero, expected_m, 1e-9);
  plant->reset();
  plant->advance(2.0, 0.4);
  EXPECT_NEAR(plant->position_m() - zero, expected_m, 1e-9);
}

TEST(FormulaEffect, RemembersAHiddenLevelThatOnlyRises) {
  // z' = |v|: the way gone, and a drag that grows with it
  auto plant = make_plant(
      own_model("force_driven_axis", "force", "k*z*v_mps", "memory = \"abs(v_mps)\"", "0.0"));
  auto drags = make_plant(
      own_model("force_driven_axis", "force", "k*z*v_mps", "memory = \"abs(v_mps)\"", "1000.0"));
  double way_m = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const double u_V = k / 250 % 2 == 0 ? 20.0 : -20.0;
    const double from_m = drags->position_m();
    plant->advance(u_V, 0.01);
    drags->advance(u_V, 0.01);
    way_m += std::abs(drags->position_m() - from_m);
  }
  // nearly steady: gain u = (d + k way) v
  EXPECT_NEAR(drags->speed_mps() * (200.0 + 1000.0 * way_m), -35.0 * 20.0, 0.01 * 35.0 * 20.0);
  EXPECT_GT(std::abs(plant->speed_mps()), 2.0 * std::abs(drags->speed_mps()));
}

const std::string kDrag = own_text("force", "k*v_mps^3", "0.0", "1e7");

TEST(FormulaEffect, ChangesNotOneBitWhileItsParametersAreNeutral) {
  for (const Twin& twin : kTwins) {
    const std::string head = plant_text(twin.plant);
    const std::string declared = own_text(twin.site, twin.formula, "-1e6", "1e6");
    auto without = make_plant(model_of(head));
    auto candidate = make_plant(model_of(head + declared));
    auto neutral = make_plant(model_of(head + declared + "[effects.own]\n"));
    for (int k = 0; k < 300; ++k) {
      for (const auto& plant : {&without, &candidate, &neutral}) {
        (*plant)->advance(drive_V(k, twin.full_V), 0.005);
      }
      ASSERT_EQ(candidate->reading_m(), without->reading_m()) << twin.formula;
      ASSERT_EQ(neutral->reading_m(), without->reading_m()) << twin.formula;
    }
  }
}

/// The formulas of the model in a plant of any kind of number.
template <class Model>
void declare(Model& plant, const formula::Formulas& formulas) {
  plant.effects.formulas().declare(formulas.data(), formulas.size());
}

/// All that is not neutral also takes part when it is evaluated although neutral.
TEST(FormulaEffect, ChangesNotOneBitWhenNeutralAndEvaluated) {
  for (const Twin& twin : kTwins) {
    if (std::string(twin.plant) != "hydraulic_actuator") continue;
    const formula::Formulas formulas =
        model_of(plant_text(twin.plant) + own_text(twin.site, twin.formula, "-1e6", "1e6"))
            .formulas();
    Actuator with, without;
    declare(with, formulas);
    with.effects.set_always(true);
    without.effects.set_always(true);
    for (Actuator* plant : {&with, &without}) {
      plant->prepare(1e-3);
      plant->reset();
    }
    for (int k = 0; k < 3000; ++k) {
      with.step(drive_V(k / 5, twin.full_V));
      without.step(drive_V(k / 5, twin.full_V));
      ASSERT_EQ(with.effects.reading_m(with.state.y_m),
                without.effects.reading_m(without.state.y_m));
      ASSERT_EQ(with.state.in_Pa, without.state.in_Pa) << twin.formula << " at " << k;
    }
  }
}

/// Eight different values of k, one of them neutral, together and alone.
template <template <class> class Model>
void expect_lanes_agree(const Twin& twin) {
  const formula::Formulas formulas =
      model_of(plant_text(twin.plant) + own_text(twin.site, twin.formula, "-1e6", "1e6"))
          .formulas();
  const auto k_of = [&](std::size_t lane) {
    return std::stod(twin.value) * static_cast<double>(lane) / 7.0;
  };
  auto together = std::make_unique<Model<Simd>>();
  declare(*together, formulas);
  together->effects.formulas().each(
      [&](const formula::FormulaView&, const ParameterInfo&, Simd& value) {
        for (std::size_t lane = 0; lane < Simd::kSize; ++lane) value.set(lane, k_of(lane));
      });
  together->prepare(1e-3);
  together->reset();
  std::array<Model<double>, Simd::kSize> alone;
  for (std::size_t lane = 0; lane < Simd::kSize; ++lane) {
    declare(alone[lane], formulas);
    alone[lane].effects.formulas().each([&](const formula::FormulaView&, const ParameterInfo&,
                                            double& value) { value = k_of(lane); });
    alone[lane].prepare(1e-3);
    alone[lane].reset();
  }
  for (int k = 0; k < 2000; ++k) {
    const double u_V = drive_V(k / 5, twin.full_V);
    together->step(u_V);
    const Simd reading_m = together->effects.reading_m(together->state.y_m);
    for (std::size_t lane = 0; lane < Simd::kSize; ++lane) {
      alone[lane].step(u_V);
      ASSERT_NEAR(reading_m[lane], alone[lane].effects.reading_m(alone[lane].state.y_m), kAgree)
          << twin.formula << " lane " << lane << " step " << k;
    }
  }
}

TEST(FormulaEffect, RunsInLanesWithAParameterOfItsOwnInEach) {
  for (const Twin& twin : kTwins) {
    const std::string plant = twin.plant;
    if (plant == "hydraulic_actuator") expect_lanes_agree<HydraulicActuator>(twin);
    if (plant == "velocity_servo") expect_lanes_agree<VelocityServo>(twin);
    if (plant == "force_driven_axis") expect_lanes_agree<ForceDrivenAxis>(twin);
  }
}

TEST(FormulaEffect, ActsInTheOrderOfDeclaration) {
  const std::string two =
      "[formula_effects.zoom]\nsite = \"sensor\"\nformula = \"y_m*(1 + r)\"\n"
      "[formula_effects.zoom.parameters.r]\nmin = 0\nmax = 1\ntypical = 0.1\n"
      "[formula_effects.bias]\nsite = \"sensor\"\nformula = \"y_m + b_m\"\n"
      "[formula_effects.bias.parameters.b_m]\nmin = 0\nmax = 1\ntypical = 0.1\n"
      "[effects.bias]\nb_m = 0.01\n[effects.zoom]\nr = 0.5\n";
  auto plant = make_plant(model_of(plant_text("hydraulic_actuator") + two));
  EXPECT_DOUBLE_EQ(plant->reading_m(), 1.5 * 0.305 + 0.01);
}

TEST(FormulaEffect, StaysStableWhereItIsStiff) {
  // dF/dv up to 2e6 N s/m on 50 kg: 40 times what one step of 1 ms follows
  for (const char* formula : {"k*tanh(v_mps/0.001)", "2*k*v_mps/(0.001 + abs(v_mps))"}) {
    for (const char* plant_name : {"hydraulic_actuator", "force_driven_axis"}) {
      auto plant =
          make_plant(model_of(plant_text(plant_name) + own_text("force", formula, "0.0", "1e4") +
                              "[effects.own]\nk = 2000.0\n"));
      auto fine = make_plant(model_of(plant_text(plant_name) + "step_s = 1e-5\n" +
                                      own_text("force", formula, "0.0", "1e4") +
                                      "[effects.own]\nk = 2000.0\n"));
      double far_m = 0.0;
      for (int k = 0; k < 200; ++k) {
        const double u_V =
            (std::string(plant_name) == "hydraulic_actuator" ? 3.0 : 100.0) * std::sin(k * 0.06);
        plant->advance(u_V, 0.005);
        fine->advance(u_V, 0.005);
        far_m = std::max(far_m, std::abs(plant->position_m() - fine->position_m()));
      }
      EXPECT_LT(far_m, 2e-6) << formula << " on " << plant_name;
    }
  }
  // a spring of 1e9 N/m and a leak past which no pressure stays
  auto spring = make_plant(model_of(plant_text("hydraulic_actuator") +
                                    own_text("force", "k*(y_m - 0.305)", "0.0", "1e9") +
                                    "[effects.own]\nk = 1e9\n"));
  auto leak = make_plant(model_of(plant_text("hydraulic_actuator") +
                                  own_text("leakage", "k*1e-9*(in_Pa - out_Pa)", "0.0", "1e3") +
                                  "[effects.own]\nk = 1.0\n"));
  for (int k = 0; k < 200; ++k) {
    spring->advance(3.0 * std::sin(k * 0.06), 0.005);
    leak->advance(3.0 * std::sin(k * 0.06), 0.005);
    EXPECT_NEAR(spring->position_m(), 0.305, 1e-5);
    EXPECT_NEAR(leak->state()[2].value, leak->state()[3].value, 2e5);
  }
}

TEST(FormulaEffect, CountsAsAbsentWhereItIsNotFinite) {
  // beyond the range that was tried at the start: the axis comes past 3 m
  const std::string head = plant_text("force_driven_axis");
  auto plant = make_plant(model_of(head + own_text("force", "k*sqrt(3 - y_m)", "0.0", "100.0") +
                                   "[effects.own]\nk = 1.0\n"));
  auto without = make_plant(model_of(head));
  plant->advance(40.0, 3.0);
  ASSERT_GT(plant->position_m(), 3.0);
  const std::vector<NamedValue> state = plant->state();
  const std::array<double, 2> values = {state[0].value, state[1].value};
  without->set_state(values);
  plant->advance(40.0, 1.0);
  without->advance(40.0, 1.0);
  EXPECT_EQ(plant->position_m(), without->position_m());
  // and whatever comes, states stay finite
  for (const char* formula : {"k*exp(300*(abs(v_mps) - 2))", "-k*v_mps^8*1e30", "k/(y_m - 2.5)"}) {
    auto wild = make_plant(
        model_of(head + own_text("force", formula, "0.0", "100.0") + "[effects.own]\nk = 100.0\n"));
    for (int k = 0; k < 200; ++k) {
      wild->advance(1e4 * std::sin(k * 0.3), 0.02);
      for (const NamedValue& one : wild->state()) ASSERT_TRUE(std::isfinite(one.value)) << formula;
    }
  }
}

}  // namespace
}  // namespace plant_sim::testing
