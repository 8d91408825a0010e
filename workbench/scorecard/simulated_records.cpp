#include "workbench/scorecard/simulated_records.h"

#include <array>
#include <cmath>

#include "workbench/simulate/closed_loop.h"
#include "workbench/simulate/transducers.h"

namespace workbench::scorecard {
namespace {

/// Finalizer of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014).
std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

plant_sim::Encoder spare_rod(const simulate::Scenario& scenario, std::uint64_t seed) {
  return {scenario.instruments.encoder_resolution_m, scenario.instruments.noise_m, seed};
}

}  // namespace

simulate::Scenario healthy(const Bench& bench, const Motion& motion) {
  simulate::Scenario scenario = bench.healthy;
  scenario.reference = motion.reference;
  return scenario;
}

simulate::Scenario faulty(const Bench& bench, const Motion& motion, const Injected& injected) {
  simulate::Scenario scenario = healthy(bench, motion);
  const Fault& fault = *injected.fault;
  const double size = injected.direction * injected.size * fault.per_unit;
  if (!fault.sensor.empty()) {
    scenario.sensor_faults.push_back({fault.sensor, injected.at_s, size});
    return scenario;
  }
  plant_sim::Change change;
  change.parameter = fault.parameter;
  change.at_s = injected.at_s;
  (fault.how == "ratio" ? change.factor : change.value) = fault.how == "ratio" ? 1.0 + size : size;
  scenario.faults.push_back(change);
  return scenario;
}

simulate::Scenario changed(const Bench& bench, const Motion& motion, const Benign& benign) {
  simulate::Scenario scenario = healthy(bench, motion);
  monitor::control::ReferenceConfig& reference = scenario.reference;
  reference.amplitude_m *= benign.amplitude_ratio;
  reference.frequency_Hz *= benign.frequency_ratio;
  reference.frequency_end_Hz *= benign.frequency_ratio;
  for (double& frequency_Hz : reference.frequencies_Hz) frequency_Hz *= benign.frequency_ratio;
  reference.hold_s /= benign.frequency_ratio;
  if (!benign.parameter.empty()) {
    plant_sim::Change change;
    change.parameter = benign.parameter;
    change.factor = benign.factor;
    change.ramp_s = benign.ramp_s;
    scenario.faults.push_back(change);
  }
  return scenario;
}

Samples run(const simulate::Scenario& scenario, double duration_s, std::uint64_t seed) {
  simulate::ClosedLoop loop(scenario, seed);
  std::array<plant_sim::Encoder, 2> spare_rods{spare_rod(scenario, seed_of(seed, "rod_2")),
                                               spare_rod(scenario, seed_of(seed, "rod_3"))};
  simulate::SimulatedTransducers transducers(scenario.instruments, seed);
  Samples samples(static_cast<std::size_t>(std::llround(duration_s / simulate::kSampleTime_s)));
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const simulate::LoopRow row = loop.step();
    config::signals::Sample& s = samples[k];
    s.tick = static_cast<std::int64_t>(k);
    s.t_read_ns = std::llround(row.t_s * 1e9);
    s.t_write_ns = s.t_read_ns;
    s.utc_us = std::llround(row.t_s * 1e6);
    s.reference_m = row.reference_m;
    s.y_m = row.y_m;
    s.u_requested_V = row.u_requested_V;
    s.u_applied_V = row.u_applied_V;
    s.saturated = row.saturated;
    const config::signals::Pressures read = transducers.read(row.pressures);
    s.pressures = {read.supply_Pa, read.in_Pa, read.out_Pa};
    s.rod_count = 1;
    s.rod_m[0] = row.y_m;
    for (plant_sim::Encoder& rod : spare_rods) s.rod_m[s.rod_count++] = rod.read(row.rod_m);
  }
  return samples;
}

config::record::Record to_record(const Samples& samples, std::string_view name) {
  config::record::Record record;
  record.name = name;
  record.sample_time_s = simulate::kSampleTime_s;
  std::vector<double> reference_m;
  for (const config::signals::Sample& s : samples) {
    record.t_s.push_back(static_cast<double>(s.tick) * simulate::kSampleTime_s);
    record.u_V.push_back(s.u_applied_V);
    record.y_m.push_back(s.y_m);
    reference_m.push_back(s.reference_m);
  }
  record.further.emplace_back("reference_m", std::move(reference_m));
  return record;
}

std::uint64_t seed_of(std::uint64_t base, std::string_view text) {
  std::uint64_t hash = mix(base);
  for (const char c : text) hash = mix(hash ^ static_cast<unsigned char>(c));
  return hash;
}

double unit_of(std::uint64_t seed) { return static_cast<double>(mix(seed) >> 11U) * 0x1p-53; }

}  // namespace workbench::scorecard
