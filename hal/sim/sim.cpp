#include "hal/sim/sim.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/schema/error.h"
#include "config/schema/joined.h"

namespace hal::sim {
namespace {

/// Duration of the open-valve run that finds the fastest speed: many time constants of any rod.
constexpr double kSpeedSearch_s = 0.5;
/// Largest deviation of a period from a whole number of integration steps, in steps.
constexpr double kWholeSteps = 1e-6;

/// Throws where it names no transducer, or a rod sensor as well.
void check_pressure(const std::string& file, const InjectedFault& fault) {
  const auto& known = plant_sim::kTransducers;
  const std::string where = file + ": [[sim.trouble]] pressure";
  if (!fault.rod.empty()) {
    throw config::schema::bad_config(where, "is given together with rod", "one of the two");
  }
  if (std::find(known.begin(), known.end(), fault.pressure) != known.end()) return;
  throw config::schema::bad_config(where, "is \"" + fault.pressure + "\"",
                                   std::string(known[0]) + ", " + known[1] + ", " + known[2]);
}

}  // namespace

void SimConfig::visit(config::schema::Visitor& v) {
  BenchPlant::visit(v);
  v.number({"command_timeout_s", "time without a write after which the valve goes to null"},
           command_timeout_s, {1e-3, std::numeric_limits<double>::infinity()});
  v.boolean({"pretend_real", "obey the rules of a rig that moves something"}, pretend_real);
  config::schema::visit_list(v, {"trouble", "injected fault of a sensor or the valve"},
                             injected_faults);
  config::schema::visit_list(v, {"rod", "a spare rod sensor"}, rods);
  config::schema::visit_list(v, {"input", "a switch or another signal"}, inputs);
}

SimRig::SimRig(std::unique_ptr<plant_sim::Plant> plant, const SimConfig& config,
               double sample_time_s, double null_V)
    : plant_(std::move(plant)),
      schedule_(config.faults, *plant_),
      encoder_(config.encoder_resolution_m, config.noise_m,
               static_cast<std::uint64_t>(config.seed)),
      dac_{static_cast<int>(config.dac_bits), config.dac_range_V},
      sample_time_s_(sample_time_s),
      null_V_(null_V),
      held_V_(dac_.apply(null_V)),
      timeout_ticks_(
          std::isfinite(config.command_timeout_s)
              ? std::max(1LL, std::llround(std::floor(config.command_timeout_s / sample_time_s +
                                                      kWholeSteps)))
              : std::numeric_limits<std::int64_t>::max()),
      faulty_(config.injected_faults, "") {}

Reading SimRig::read(const Tick& tick) noexcept {
  double u_V = held_V_.load(std::memory_order_relaxed);
  for (; index_ < tick.index; ++index_) {
    if (index_ - written_.load(std::memory_order_relaxed) >= timeout_ticks_) {
      u_V = dac_.apply(null_V_);
      held_V_.store(u_V, std::memory_order_relaxed);
    }
    schedule_.advance(*plant_, u_V, static_cast<double>(index_) * sample_time_s_, sample_time_s_);
  }
  Reading reading;
  reading.y_m = encoder_.read(plant_->reading_m());
  reading.command_V = u_V;
  reading.quality = config::signals::Quality::good;
  const double t_s = static_cast<double>(tick.index) * sample_time_s_;
  valve_unresponsive_.store(faulty_.apply(reading, t_s), std::memory_order_relaxed);
  return reading;
}

Applied SimRig::take(double u_V) noexcept {
  if (valve_unresponsive_.load(std::memory_order_relaxed)) return {kMissing, false};
  const double applied_V = dac_.apply(u_V);
  held_V_.store(applied_V, std::memory_order_relaxed);
  return {applied_V, true};
}

Applied SimRig::write(double u_V, const Tick& tick) noexcept {
  const Applied applied = take(u_V);
  if (applied.good) written_.store(tick.index, std::memory_order_relaxed);
  return applied;
}

Applied SimRig::go_null() noexcept { return take(null_V_); }

Reading SpareRod::read(const Tick& tick) noexcept {
  const double t_s = static_cast<double>(tick.nominal_ns) * 1e-9;
  Reading reading;
  reading.y_m = encoder_.read(rig_->position_m() + (t_s >= from_s_ ? offset_m_ : 0.0));
  reading.quality = config::signals::Quality::good;
  faulty_.apply(reading, t_s);
  return reading;
}

InputReading PressureInput::read(const Tick& tick) noexcept {
  const double t_s = static_cast<double>(tick.nominal_ns) * 1e-9;
  InputReading reading{transducers_->read(which_, rig_->pressures(), t_s), 0,
                       config::signals::Quality::good};
  faulty_.apply(reading, t_s);
  return reading;
}

std::unique_ptr<plant_sim::Plant> SimBackend::load(const OpenContext& context) const {
  const std::filesystem::path file = resolve(context, config_.model);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    throw config::schema::bad_config(context.file + ": [sim] model",
                                     "is \"" + file.string() + "\", which is not a file",
                                     "a model file (TOML)");
  }
  return plant_sim::make_plant(plant_sim::load_model(file));
}

void SimBackend::check_injected_faults(const OpenContext& context) const {
  const std::string known = config::schema::joined_by(config_.rods, &SpareConfig::id);
  for (const InjectedFault& fault : config_.injected_faults) {
    if (!fault.pressure.empty()) {
      check_pressure(context.file, fault);
      continue;
    }
    const auto is_it = [&](const SpareConfig& spare) { return spare.id == fault.rod; };
    if (fault.rod.empty() || std::any_of(config_.rods.begin(), config_.rods.end(), is_it)) continue;
    throw config::schema::bad_config(context.file + ": [[sim.trouble]] rod",
                                     "is \"" + fault.rod + "\", which is not a [[sim.rod]]",
                                     known.empty() ? "none is there" : known);
  }
}

void SimBackend::add_pressures(const std::string& file, const std::shared_ptr<SimRig>& rig,
                               BackendDevices& devices) const {
  std::shared_ptr<plant_sim::Transducers> transducers;
  try {
    transducers = std::make_shared<plant_sim::Transducers>(
        config_.pressures, static_cast<std::uint64_t>(config_.seed));
  } catch (const config::schema::Error& e) {
    throw config::schema::ConfigError(file + ": " + e.what());
  }
  const config::signals::Pressures now = rig->pressures();
  const double values_Pa[] = {now.supply_Pa, now.in_Pa, now.out_Pa};
  for (std::size_t i = 0; i < plant_sim::kTransducers.size(); ++i) {
    if (std::isnan(values_Pa[i])) continue;  // such a plant has none
    devices.inputs[plant_sim::kTransducers[i]] =
        std::make_shared<PressureInput>(rig, transducers, i, config_.injected_faults);
  }
}

BackendDevices SimBackend::open(const OpenContext& context) const {
  check_injected_faults(context);
  std::unique_ptr<plant_sim::Plant> plant = load(context);
  const double steps = context.sample_time_s / plant->step_s();
  if (std::abs(steps - std::round(steps)) > kWholeSteps) {
    throw config::schema::bad_config(
        context.file + ": [loop] rate_hz",
        "makes a period of " + std::to_string(steps) + " integration steps of the model",
        "a whole number of steps");
  }
  if (std::abs(context.null_V) > config_.dac_range_V) {
    throw config::schema::bad_config(context.file + ": [valve] null_V",
                                     "is outside the range of the D/A converter",
                                     "at most [sim] dac_range_V in magnitude");
  }
  std::shared_ptr<SimRig> rig;
  try {
    rig =
        std::make_shared<SimRig>(std::move(plant), config_, context.sample_time_s, context.null_V);
  } catch (const config::schema::Error& e) {
    throw config::schema::ConfigError(context.file + ": [[sim.fault]] " + e.what());
  }
  BackendDevices devices;
  devices.rods[kRodChannel] = rig;
  devices.valve = rig;
  std::uint64_t seed = static_cast<std::uint64_t>(config_.seed);
  for (const SpareConfig& spare : config_.rods) {
    devices.rods[spare.id] =
        std::make_shared<SpareRod>(rig, spare, config_.injected_faults, ++seed);
  }
  add_pressures(context.file, rig, devices);
  for (const SimSwitchConfig& input : config_.inputs) {
    devices.inputs[input.id] = std::make_shared<Switch>(input);
  }
  devices.outputs["permit"] = std::make_shared<CountingLine>();
  return devices;
}

NullTimes SimBackend::null_times() const {
  NullTimes times;
  const bool timeout = std::isfinite(config_.command_timeout_s);
  if (timeout) times.bus_lost_s = times.process_stopped_s = config_.command_timeout_s;
  if (!timeout) times.process_stopped_s = std::numeric_limits<double>::infinity();
  times.process_dead_s = config_.pretend_real ? times.bus_lost_s : 0.0;
  return times;
}

double SimBackend::worst_speed_mps(const OpenContext& context, double limit_V) const {
  const std::unique_ptr<plant_sim::Plant> plant = load(context);
  double worst_mps = 0.0;
  for (const double u_V : {limit_V, -limit_V}) {
    plant->reset();
    const auto steps = static_cast<int>(kSpeedSearch_s / plant->step_s());
    for (int i = 0; i < steps; ++i) {
      plant->advance(context.null_V + u_V, plant->step_s());
      worst_mps = std::max(worst_mps, std::abs(plant->speed_mps()));
    }
  }
  return worst_mps;
}

}  // namespace hal::sim
