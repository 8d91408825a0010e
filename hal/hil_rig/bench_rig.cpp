#include "hal/hil_rig/bench_rig.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "config/schema/error.h"

namespace hal::hil_rig {
namespace {

constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();
/// Count of an encoder without steps.
constexpr double kIdealCount_m = 1e-6;
/// Time for the reply to the request that asked for silence.
constexpr std::int64_t kMuteLead_ns = 100'000'000;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::int64_t to_ns(double s) { return std::llround(s * 1e9); }

std::unique_ptr<plant_sim::Plant> load_plant(const RigConfig& config) {
  const std::filesystem::path file = config.folder / config.sim.model;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    throw config::schema::bad_config(config.file + ": [sim] model",
                                     "is \"" + file.string() + "\", which is not a file",
                                     "a model file (TOML)");
  }
  plant_sim::ModelFile model = plant_sim::load_model(file);
  model.step_s = config.field.step_s;
  return plant_sim::make_plant(model);
}

plant_sim::Schedule make_schedule(const RigConfig& config, plant_sim::Plant& plant) {
  try {
    return {config.sim.faults, plant};
  } catch (const config::schema::Error& e) {
    throw config::schema::ConfigError(config.file + ": [[sim.fault]] " + e.what());
  }
}

plant_sim::Transducers make_transducers(const RigConfig& config) {
  try {
    return {config.sim.pressures, static_cast<std::uint64_t>(config.sim.seed)};
  } catch (const config::schema::Error& e) {
    throw config::schema::ConfigError(config.file + ": " + e.what());
  }
}

}  // namespace

BenchRig::BenchRig(const RigConfig& config, std::int64_t now_ns)
    : field_(config.field),
      plant_(load_plant(config)),
      schedule_(make_schedule(config, *plant_)),
      encoder_(config.sim.encoder_resolution_m, config.sim.noise_m,
               static_cast<std::uint64_t>(config.sim.seed)),
      transducers_(make_transducers(config)),
      dac_{static_cast<int>(config.sim.dac_bits), config.sim.dac_range_V},
      count_m_(config.sim.encoder_resolution_m > 0.0 ? config.sim.encoder_resolution_m
                                                     : kIdealCount_m),
      start_ns_(now_ns),
      now_ns_(now_ns),
      asked_V_(config.field.null_V) {
  own_ = {{"e_stop", &e_stop_, 0.0, 1.0, 1.0},
          {"enable", &enable_, 0.0, 1.0, 1.0},
          {"mute_s", &mute_s_, 0.0, 60.0, 0.0},
          {"encoder_frozen", &frozen_, 0.0, 1.0, 0.0},
          {"valve_sign", &field_.valve_sign, -1.0, 1.0, 0.0},
          {"valve_scale", &field_.valve_scale, -1e3, 1e3, 0.0},
          {"encoder_sign", &field_.encoder_sign, -1.0, 1.0, 0.0},
          {"encoder_scale", &field_.encoder_scale, -1e3, 1e3, 0.0},
          {"encoder_offset_m", &field_.encoder_offset_m, -100.0, 100.0, 0.0},
          {"null_V", &field_.null_V, -100.0, 100.0, 0.0},
          {"command_timeout_s", &field_.command_timeout_s, 0.0, 60.0, 0.0},
          {"permit_timeout_s", &field_.permit_timeout_s, 0.0, 60.0, 0.0}};
  for (Own& own : own_) own.at_start = *own.value;
  for (const std::string& name : plant_->parameter_names()) {
    plant_at_start_.push_back(*plant_->parameter(name));
  }
}

std::int64_t BenchRig::deadline_ns(double timeout_s, std::int64_t last_ns) const {
  return timeout_s > 0.0 && last_ns >= 0 ? last_ns + to_ns(timeout_s) : kNever_ns;
}

bool BenchRig::timed_out(std::int64_t t_ns) const {
  return t_ns >= deadline_ns(field_.command_timeout_s, command_ns_);
}

bool BenchRig::permit_missing(std::int64_t t_ns) const {
  return field_.permit_timeout_s > 0.0 &&
         (permit_ns_ < 0 || t_ns >= deadline_ns(field_.permit_timeout_s, permit_ns_));
}

double BenchRig::converter_V() const {
  const bool null =
      command_ns_ < 0 || timed_out(now_ns_) || permit_missing(now_ns_) || !e_stop_released();
  return dac_.apply(null ? field_.null_V : asked_V_);
}

void BenchRig::hold_until(std::int64_t t_ns) {
  const auto steps =
      static_cast<std::int64_t>(static_cast<double>(t_ns - start_ns_) * 1e-9 / plant_->step_s());
  const std::int64_t ahead = steps - steps_;
  if (ahead > 0) {
    const double u_V = field_.valve_sign * field_.valve_scale * converter_V();
    const double duration_s = static_cast<double>(ahead) * plant_->step_s();
    if (command_ns_ < 0) {
      plant_->advance(u_V, duration_s);
    } else {
      schedule_.advance(*plant_, u_V, static_cast<double>(schedule_steps_) * plant_->step_s(),
                        duration_s);
      schedule_steps_ += ahead;
    }
    steps_ = steps;
  }
  now_ns_ = t_ns;
}

void BenchRig::advance_to(std::int64_t now_ns) {
  // The voltage changes at the end of a time-out.
  const std::int64_t ends[] = {deadline_ns(field_.command_timeout_s, command_ns_),
                               deadline_ns(field_.permit_timeout_s, permit_ns_)};
  for (const std::int64_t end : {std::min(ends[0], ends[1]), std::max(ends[0], ends[1])}) {
    if (end > now_ns_ && end < now_ns) hold_until(end);
  }
  hold_until(std::max(now_ns, now_ns_));
}

void BenchRig::command(double u_V) {
  if (std::isfinite(u_V)) {
    asked_V_ = u_V;
    command_ns_ = now_ns_;
  }
}

void BenchRig::permit(bool on) {
  if (on != permit_on_) permit_ns_ = now_ns_;
  permit_on_ = on;
}

double BenchRig::read_position_m() {
  if (frozen_ == 0.0) {
    last_position_m_ = encoder_.read(
        field_.encoder_sign * field_.encoder_scale * plant_->reading_m() + field_.encoder_offset_m);
  }
  return last_position_m_;
}

double BenchRig::read_pressure_Pa(std::size_t which) {
  const double t_s = static_cast<double>(schedule_steps_) * plant_->step_s();
  return transducers_.read(which, plant_->pressures(), t_s);
}

std::int32_t BenchRig::counts(double position_m) const {
  return static_cast<std::int32_t>(
      std::clamp(std::round(position_m / count_m_), -2147483648.0, 2147483647.0));
}

std::uint16_t BenchRig::status() const {
  unsigned bits = 0;
  if (command_ns_ >= 0) bits |= kCommanded;
  if (timed_out(now_ns_)) bits |= kTimedOut;
  if (!e_stop_released()) bits |= kEStopPressed;
  if (permit_missing(now_ns_)) bits |= kPermitMissing;
  if (!enabled()) bits |= kNotEnabled;
  return static_cast<std::uint16_t>(bits);
}

std::uint32_t BenchRig::time_us() const {
  return static_cast<std::uint32_t>((now_ns_ - start_ns_) / 1000);
}

std::string BenchRig::set(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return "is not name=value";
  const std::string name(text.substr(0, equals));
  std::string number(text.substr(equals + 1));
  const bool factor = !number.empty() && number.front() == 'x';
  if (factor) number.erase(0, 1);
  char* end = nullptr;
  double value = std::strtod(number.c_str(), &end);
  if (number.empty() || *end != '\0' || std::isnan(value)) return "has no number for " + name;

  double* target = nullptr;
  double at_start = 0.0;
  double min = -kInfinite;
  double max = kInfinite;
  for (const Own& own : own_) {
    if (name != own.name) continue;
    target = own.value;
    at_start = own.at_start;
    min = own.min;
    max = own.max;
  }
  if (target == nullptr) {
    target = plant_->parameter(name);
    if (target == nullptr) return "names no parameter: " + name;
    const std::vector<std::string> names = plant_->parameter_names();
    const auto index = std::find(names.begin(), names.end(), name) - names.begin();
    at_start = plant_at_start_[static_cast<std::size_t>(index)];
    min = plant_->parameter_info(name)->min;
    max = plant_->parameter_info(name)->max;
  }
  if (factor) value *= at_start;
  if (!(value >= min && value <= max)) {
    return name + " is out of range; allowed: " + std::to_string(min) + " to " +
           std::to_string(max);
  }
  *target = value;
  if (target == &mute_s_) {
    mute_from_ns_ = now_ns_ + kMuteLead_ns;
    mute_until_ns_ = mute_from_ns_ + to_ns(value);
  }
  return "";
}

}  // namespace hal::hil_rig
