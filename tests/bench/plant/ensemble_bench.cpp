// The loop that fitting spends its time in: a record of 30 s at 200 Hz through eight parameter sets
// with an observer's correction at each sample. And one evaluation of the model with all its
// sensitivities: eight lanes at once against central differences of the single plant.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "plant_sim/ensemble.h"
#include "plant_sim/library.h"
#include "plant_sim/plant.h"

namespace {

using namespace plant_sim;

constexpr int kSamples = 6000;
constexpr double kSample_s = 0.005;
constexpr double kStep_s = 0.001;
constexpr double kStart_m = 0.305;

/// Parameters that a record of the actuator determines: base and nuisance parameters.
constexpr std::array kSought = {"valve_gain_m_per_V",
                                "damping_N_s_per_m",
                                "bulk_modulus_Pa",
                                "mass_kg",
                                "dead_volume_m3",
                                "valve_damping_ratio",
                                "valve_natural_frequency_rad_per_s"};

double command_V(int k) { return std::sin(k * 0.02) + 0.3 * std::sin(k * 0.13); }

void run(Ensemble& ensemble) {
  ensemble.start(kStart_m);
  Ensemble::Values u_V;
  Ensemble::Values by_m;
  for (int k = 0; k < kSamples; ++k) {
    const Ensemble::Values reading_m = ensemble.reading_m();
    u_V.fill(command_V(k));
    for (std::size_t i = 0; i < Ensemble::kLanes; ++i) by_m[i] = 1e-6 * (kStart_m - reading_m[i]);
    ensemble.shift(by_m);
    ensemble.advance(u_V, kSample_s);
  }
}

void fitting(benchmark::State& bench, InstructionSet set, const ModelFile& model) {
  const auto ensemble = make_ensemble(model, kStep_s, set);
  const std::size_t mass = *ensemble->find("mass_kg");
  for (auto _ : bench) {
    for (std::size_t i = 0; i < Ensemble::kLanes; ++i) {
      ensemble->set(mass, i, 50.0 + 0.01 * static_cast<double>(i));
    }
    run(*ensemble);
  }
}

void sensitivities_in_lanes(benchmark::State& bench) {
  const auto ensemble = make_ensemble(ModelFile(), kStep_s);
  for (auto _ : bench) {
    for (std::size_t i = 0; i < kSought.size(); ++i) {
      const std::size_t parameter = *ensemble->find(kSought[i]);
      const double value = ensemble->get(parameter, 0);
      ensemble->set(parameter, i + 1, value * (1.0 + 1e-6));
    }
    run(*ensemble);
  }
}

void sensitivities_by_central_differences(benchmark::State& bench) {
  const auto plant = make_plant(ModelFile());
  const auto simulate = [&] {
    plant->reset();
    for (int k = 0; k < kSamples; ++k) {
      benchmark::DoNotOptimize(plant->reading_m());
      plant->advance(command_V(k), kSample_s);
    }
  };
  for (auto _ : bench) {
    simulate();
    for (const char* name : kSought) {
      double& value = *plant->parameter(name);
      const double nominal = value;
      for (const double part : {1.0 - 1e-6, 1.0 + 1e-6}) {
        value = nominal * part;
        simulate();
      }
      value = nominal;
    }
  }
}

const bool kRegistered = [] {
  const auto add = [](const std::string& name, auto&& f) {
    benchmark::RegisterBenchmark(name.c_str(), f)->Unit(benchmark::kMillisecond)->MinTime(0.05);
  };
  ModelFile none;
  ModelFile every;
  for (const EffectInfo& effect : effect_library()) {
    for (const ParameterInfo& p : effect.parameters) {
      *every.value(effect.name + "." + p.name) = p.typical;
    }
  }
  const auto both = [&](const std::string& name, InstructionSet set) {
    if (!runs_here(set)) return;
    add("ensemble " + name + ", no effect",
        [=](benchmark::State& bench) { fitting(bench, set, none); });
    add("ensemble " + name + ", all effects",
        [=](benchmark::State& bench) { fitting(bench, set, every); });
  };
  both("baseline", InstructionSet::baseline);
  both("AVX2", InstructionSet::avx2);
  both("AVX-512", InstructionSet::avx512);
  for (const EffectInfo& effect : effect_library()) {
    ModelFile one;
    for (const ParameterInfo& p : effect.parameters) {
      *one.value(effect.name + "." + p.name) = p.typical;
    }
    add("ensemble, " + effect.name,
        [=](benchmark::State& bench) { fitting(bench, fastest_here(), one); });
  }
  add("sensitivities in lanes", sensitivities_in_lanes);
  add("sensitivities by central differences", sensitivities_by_central_differences);
  return true;
}();

}  // namespace
