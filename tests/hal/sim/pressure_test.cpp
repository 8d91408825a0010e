// The simulated rig's pressure transducers.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "hal/rig.h"
#include "hal/sim/sim.h"

namespace hal::sim {
namespace {

constexpr double kTs_s = 0.005;
const std::filesystem::path kFolder = SPOOLWATCH_SOURCE_DIR "/config";

Tick tick(std::int64_t index) { return {index, index * 5'000'000}; }

/// A rig without any error of its own, and its three pressures.
struct Stand {
  explicit Stand(const SimConfig& config_) : config(config_) {
    config.encoder_resolution_m = 0.0;
    config.dac_bits = 0;
    rig =
        std::make_shared<SimRig>(plant_sim::make_plant(plant_sim::ModelFile()), config, kTs_s, 0.0);
    const auto transducers = std::make_shared<plant_sim::Transducers>(config.pressures, 1);
    for (std::size_t i = 0; i < 3; ++i) {
      inputs.push_back(
          std::make_shared<PressureInput>(rig, transducers, i, config.injected_faults));
    }
  }
  /// Reads the rig, then one pressure, and goes on with u_V.
  InputReading read(std::int64_t index, std::size_t which, double u_V = 1.0) {
    rig->read(tick(index));
    const InputReading reading = inputs[which]->read(tick(index));
    rig->write(u_V, tick(index));
    return reading;
  }
  SimConfig config;
  std::shared_ptr<SimRig> rig;
  std::vector<std::shared_ptr<PressureInput>> inputs;
};

plant_sim::TransducerConfig of(const char* which) {
  plant_sim::TransducerConfig config;
  config.of = which;
  return config;
}

TEST(PressureInput, ReadsThePlantAtTheSameTickAsThePosition) {
  const std::unique_ptr<plant_sim::Plant> twin = plant_sim::make_plant(plant_sim::ModelFile());
  Stand stand({});
  for (std::int64_t k = 0; k < 100; ++k) {
    stand.rig->read(tick(k));
    const config::signals::Pressures wanted = twin->pressures();
    const double wanted_Pa[] = {wanted.supply_Pa, wanted.in_Pa, wanted.out_Pa};
    for (std::size_t i = 0; i < 3; ++i) {
      const InputReading reading = stand.inputs[i]->read(tick(k));
      EXPECT_EQ(reading.value, wanted_Pa[i]) << k << ' ' << i;
      EXPECT_EQ(reading.quality, config::signals::Quality::good);
    }
    const double u_V = std::sin(0.05 * static_cast<double>(k));
    stand.rig->write(u_V, tick(k));
    twin->advance(u_V, kTs_s);
  }
}

TEST(PressureInput, TellsTheForceThatTheSteadyRodNeeds) {
  // Steady: A (Pi - Po) = d v and v = Cd w Kv u sqrt((Ps - d v / A) / rho) / A (model as printed).
  double v_mps = 0.0;
  for (int i = 0; i < 50; ++i) {
    v_mps =
        0.6 * 2.07e-2 * 2.79e-5 * std::sqrt((6.89e6 - 1000.0 * v_mps / 6.33e-4) / 847.0) / 6.33e-4;
  }
  Stand stand({});
  for (std::int64_t k = 0; k < 400; ++k) stand.read(k, 0);
  const double in_Pa = stand.read(400, 1).value;
  const double out_Pa = stand.inputs[2]->read(tick(400)).value;
  EXPECT_EQ(stand.inputs[0]->read(tick(400)).value, 6.89e6);
  // A thousandth: what is left of the oil's oscillation after 2 s, and of the lag of the spool.
  EXPECT_NEAR(in_Pa - out_Pa, 1000.0 * v_mps / 6.33e-4, 1e-3 * 1000.0 * v_mps / 6.33e-4);
}

TEST(PressureInput, HasTheErrorsThatItsTransducerIsDeclaredWith) {
  SimConfig config;
  plant_sim::TransducerConfig noisy = of("supply_pressure");
  noisy.noise_Pa = 2e4;
  plant_sim::TransducerConfig coarse = of("pressure_in");
  coarse.resolution_Pa = 3e3;
  plant_sim::TransducerConfig drifted = of("pressure_out");
  drifted.offset_Pa = 1e5;
  drifted.from_s = 0.5;
  config.pressures = {drifted, noisy, coarse};
  Stand stand(config);
  Stand ideal({});
  double sum_Pa = 0.0;
  double squares = 0.0;
  constexpr int kCount = 400;
  for (std::int64_t k = 0; k < kCount; ++k) {
    const double noise_Pa = stand.read(k, 0).value - ideal.read(k, 0).value;
    sum_Pa += noise_Pa;
    squares += noise_Pa * noise_Pa;
    const double in_Pa = stand.inputs[1]->read(tick(k)).value;
    EXPECT_NEAR(in_Pa / 3e3, std::round(in_Pa / 3e3), 1e-9);
    EXPECT_NEAR(in_Pa, ideal.inputs[1]->read(tick(k)).value, 1.5e3 + 1e-6);
    const double offset_Pa = k < 100 ? 0.0 : 1e5;
    EXPECT_NEAR(stand.inputs[2]->read(tick(k)).value,
                ideal.inputs[2]->read(tick(k)).value + offset_Pa, 1e-6)
        << k;
  }
  // Five standard errors of the mean of 400 normal numbers, and of their mean square.
  EXPECT_NEAR(sum_Pa / kCount, 0.0, 5.0 * 2e4 / std::sqrt(kCount));
  EXPECT_NEAR(squares / kCount, 4e8, 5.0 * 4e8 * std::sqrt(2.0 / kCount));
}

TEST(PressureInput, SuffersTheTroublesThatNameIt) {
  SimConfig config;
  const auto trouble = [&](const char* kind, const char* pressure, double from_s, double to_s) {
    config.injected_faults.push_back({kind, "", from_s, to_s, 0.0, 0.0, pressure});
  };
  trouble("missing", "supply_pressure", 0.1, 0.2);
  trouble("frozen", "pressure_in", 0.1, 0.2);
  trouble("stale", "pressure_out", 0.1, 0.2);
  Stand stand(config);
  Stand ideal({});
  double frozen_Pa = 0.0;
  for (std::int64_t k = 0; k < 60; ++k) {
    const bool now = k >= 20 && k < 40;
    const InputReading supply = stand.read(k, 0);
    EXPECT_EQ(std::isnan(supply.value), now) << k;
    EXPECT_EQ(supply.quality == config::signals::Quality::bad, now) << k;
    const double true_Pa = ideal.read(k, 1).value;
    const InputReading in = stand.inputs[1]->read(tick(k));
    if (!now) frozen_Pa = true_Pa;
    EXPECT_EQ(in.value, frozen_Pa) << k;
    EXPECT_EQ(in.quality, config::signals::Quality::good) << "nobody tells that it stands still";
    const bool is_stale = stand.inputs[2]->read(tick(k)).quality == config::signals::Quality::stale;
    EXPECT_EQ(is_stale, now) << k;
    EXPECT_EQ(stand.rig->read(tick(k)).y_m, ideal.rig->read(tick(k)).y_m) << "the rod is well";
  }
}

std::string outcome(const std::string& more, const std::string& model = "models/thesis.toml") {
  Rig rig;
  try {
    config::schema::Document::parse("schema_version = 1\n[rod]\nbackend = \"sim\"\n" + more +
                                        "[sim]\nmodel = \"" + model + "\"\n",
                                    "rig.toml")
        .read([&](config::schema::Visitor& v) { rig.visit(v); });
    const OpenContext context{"rig.toml", kFolder, 0.005, 0.0};
    (void)rig.open(context);
    const auto notes = rig.notes(context);
    return notes.empty() ? "" : notes.front();
  } catch (const config::schema::ConfigError& e) {
    return e.what();
  }
}

std::string input(const std::string& role, const std::string& channel) {
  return "[[input]]\nid = \"the " + role + " of " + channel + "\"\nrole = \"" + role +
         "\"\nbackend = \"sim\"\nchannel = \"" + channel + "\"\n";
}

TEST(PressureRoles, AreListedAndStandOnceEach) {
  EXPECT_EQ(outcome(input("supply_pressure", "supply_pressure") +
                    input("pressure_out", "pressure_out") + input("pressure", "pressure_in")),
            "Pressures with every sample: supply_pressure from sim \"supply_pressure\", "
            "pressure_out from sim \"pressure_out\".");
  EXPECT_EQ(outcome(input("pressure", "pressure_in") + input("pressure", "pressure_out")), "");
  EXPECT_EQ(outcome(input("pressure_in", "pressure_in") + input("pressure", "pressure_in") +
                    input("pressure_in", "pressure_out")),
            "rig.toml: [[input]] 3 role: is \"pressure_in\", and so is that of \"the pressure_in "
            "of pressure_in\"; allowed: one input of that role; \"pressure\" for any other");
}

TEST(PressureRoles, NeedAPlantThatHasPressures) {
  EXPECT_EQ(outcome(input("supply_pressure", "supply_pressure"), "models/velocity_servo.toml"),
            "rig.toml: [[input]] 1 channel: is \"supply_pressure\", which backend \"sim\" does not "
            "offer here; allowed: none");
}

TEST(PressureRoles, AreRefusedInOneLineWhereTheirErrorsOrTroublesContradict) {
  EXPECT_EQ(outcome("[[sim.pressure]]\nof = \"pressure_in\"\n[[sim.pressure]]\nof = "
                    "\"pressure_in\"\n"),
            "rig.toml: [[sim.pressure]] of: is \"pressure_in\" twice; allowed: one entry for each "
            "pressure");
  EXPECT_EQ(outcome("[[sim.trouble]]\nkind = \"frozen\"\npressure = \"supply\"\n"),
            "rig.toml: [[sim.trouble]] pressure: is \"supply\"; allowed: supply_pressure, "
            "pressure_in, pressure_out");
  EXPECT_NE(outcome("[[sim.trouble]]\nkind = \"jump\"\npressure = \"pressure_in\"\n")
                .find("pressure: is unknown"),
            std::string::npos)
      << "a jump has a size in metres";
}

}  // namespace
}  // namespace hal::sim
