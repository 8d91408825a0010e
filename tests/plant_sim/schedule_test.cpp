#include "plant_sim/schedule.h"

#include <gtest/gtest.h>

#include <cmath>

#include "config/schema/error.h"

namespace plant_sim {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Schedule, AStepTakesEffectAtTheIntegrationStepOfItsTime) {
  auto plant = make_plant(ModelFile{});
  auto by_hand = make_plant(ModelFile{});
  Schedule schedule({{"supply_pressure_Pa", 0.103, 8e6, kNan, 0.0}}, *plant);
  for (int k = 0; k < 40; ++k) schedule.advance(*plant, 1.0, k * 0.005, 0.005);
  by_hand->advance(1.0, 0.103);
  *by_hand->parameter("supply_pressure_Pa") = 8e6;
  by_hand->advance(1.0, 0.097);
  EXPECT_EQ(plant->position_m(), by_hand->position_m());
}

TEST(Schedule, ARampIsLinearFromTheValueFoundAtItsStart) {
  auto plant = make_plant(ModelFile{});
  Schedule schedule({{"damping_N_s_per_m", 0.1, kNan, 3.0, 0.2}}, *plant);
  const double* damping = plant->parameter("damping_N_s_per_m");
  for (int k = 0; k < 500; ++k) {
    const double t_s = k * 0.001;
    schedule.advance(*plant, 0.0, t_s, 0.001);
    const double part = std::min(1.0, std::max(0.0, (t_s - 0.1) / 0.2));
    EXPECT_NEAR(*damping, 1000.0 + 2000.0 * part, 1e-2) << t_s;
  }
  EXPECT_EQ(*damping, 3000.0);
}

TEST(Schedule, ChangesOfOneParameterFollowEachOther) {
  auto plant = make_plant(ModelFile{});
  Schedule schedule({{"mass_kg", 0.2, kNan, 1.0, 0.0}, {"mass_kg", 0.1, 70.0, kNan, 0.0}}, *plant);
  schedule.advance(*plant, 0.0, 0.0, 0.15);
  EXPECT_EQ(*plant->parameter("mass_kg"), 70.0);
  schedule.advance(*plant, 0.0, 0.15, 0.15);
  EXPECT_EQ(*plant->parameter("mass_kg"), 50.0);
}

TEST(Schedule, ReachesAnEffectThatTheModelDoesNotName) {
  auto plant = make_plant(ModelFile{});
  auto healthy = make_plant(ModelFile{});
  Schedule schedule({{"friction.coulomb_N", 0.05, 500.0, kNan, 0.0}}, *plant);
  for (int k = 0; k < 20; ++k) {
    schedule.advance(*plant, 1.0, k * 0.005, 0.005);
    healthy->advance(1.0, 0.005);
    EXPECT_EQ(plant->position_m() == healthy->position_m(), k < 10) << k;
  }
}

TEST(Schedule, TheWayTheTimeIsCutMakesNoDifference) {
  const auto run = [](double piece_s) {
    auto plant = make_plant(ModelFile{});
    Schedule schedule(
        {{"bulk_modulus_Pa", 0.0333, kNan, 0.5, 0.05}, {"valve_gain_m_per_V", 0.1, kNan, 1.2, 0.0}},
        *plant);
    const long pieces = std::lround(0.3 / piece_s);
    for (long k = 0; k < pieces; ++k) {
      schedule.advance(*plant, 1.0, static_cast<double>(k) * piece_s, piece_s);
    }
    return plant->position_m();
  };
  EXPECT_NEAR(run(0.001), run(0.3), 1e-12);
}

TEST(Schedule, RefusesWhatItCannotDo) {
  auto plant = make_plant(ModelFile{});
  const auto refused = [&](Change change) {
    try {
      Schedule schedule({std::move(change)}, *plant);
    } catch (const config::schema::Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused({"supply_presure_Pa", 1.0, 1e6, kNan, 0.0}).find("supply_pressure_Pa"),
            std::string::npos);
  EXPECT_NE(refused({"mass_kg", 1.0, kNan, kNan, 0.0}), "");
  EXPECT_NE(refused({"mass_kg", 1.0, 60.0, 1.2, 0.0}), "");
  EXPECT_NE(refused({"mass_kg", 1.0, -1.0, kNan, 0.0}), "");
  EXPECT_EQ(refused({"mass_kg", 1.0, 60.0, kNan, 0.0}), "");
  // twice nothing is nothing: the fault would not happen
  EXPECT_NE(refused({"friction.coulomb_N", 1.0, kNan, 2.0, 0.0}), "");
  EXPECT_NE(refused({"mass_kg", 1.0, 60.0, kNan, 2.0, 3.0}), "");
}

}  // namespace
}  // namespace plant_sim
