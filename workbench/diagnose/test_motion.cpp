#include "workbench/diagnose/test_motion.h"

#include <algorithm>
#include <cmath>

#include "config/record/record.h"
#include "config/schema/error.h"
#include "estimator/greybox/kinematics.h"
#include "estimator/greybox/observer_simulation.h"
#include "estimator/residual/noise_floor.h"
#include "workbench/diagnose/advice_words.h"
#include "workbench/simulate/closed_loop.h"

namespace workbench::diagnose {
namespace {

using monitor::control::ReferenceConfig;

constexpr double kTwoPi = 6.283185307179586;
/// A motion is sought up to so much further than that of the records.
constexpr double kFurther = 1.5;
/// ... or over this share of the stroke, either way, if that is more.
constexpr double kFarShare = 0.1;
/// Share of the way to the nearer end of the stroke that a motion may use.
constexpr double kOfStroke = 0.8;
/// Without a motion to begin with and without a stroke.
constexpr double kFirst_m = 0.025;
constexpr double kFirst_Hz = 0.5;
constexpr double kLeastTravel = 200.0;  ///< in noise floors, or steps of the encoder
constexpr double kSlowest_Hz = 0.05;
constexpr double kFastest_Hz = 2.0;
constexpr double kShortest_s = 30.0;
constexpr double kLongest_s = 120.0;
constexpr double kPeriods = 15.0;
constexpr double kMostSaturated = 0.05;  ///< share of the samples
constexpr double kDac_V = 10.0;
constexpr int kDacBits = 12;

/// To two digits, as it will be said.
double rounded(double value) {
  if (!(value > 0.0)) return value;
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::round(value / digit) * digit;
}

struct Room {
  double centre_m = 0.0;
  double amplitude_m = kFirst_m;
  double frequency_Hz = kFirst_Hz;  ///< at which the records' speed goes with their travel
};

double stroke_of(const plant_sim::ModelFile& model) {
  plant_sim::ModelFile copy = model;
  const double* stroke_m = copy.value("stroke_m");
  return stroke_m == nullptr ? std::nan("") : *stroke_m;
}

Room room_of(const selection::DiagnosisProblem& problem) {
  const greybox::FitDataset& data = problem.data;
  double low_m = data.records.front().y_m.front();
  double high_m = low_m;
  double fastest_mps = 0.0;
  for (const greybox::Dataset& record : data.records) {
    const auto [low, high] = std::minmax_element(record.y_m.begin(), record.y_m.end());
    low_m = std::min(low_m, *low);
    high_m = std::max(high_m, *high);
    for (const double v_mps : greybox::kinematics(record, data.noise_floor_m).speed_mps) {
      fastest_mps = std::max(fastest_mps, std::abs(v_mps));
    }
  }
  Room room;
  room.centre_m = std::round(500.0 * (low_m + high_m)) * 1e-3;
  const double half_m = 0.5 * (high_m - low_m);
  const double stroke_m = stroke_of(problem.model);
  const greybox::Dataset& first = data.records.front();
  const double noise_m =
      std::max(data.noise_floor_m, estimator::residual::encoder_step_m(first.y_m));
  if (half_m > kLeastTravel * noise_m) {
    room.amplitude_m = kFurther * half_m;
    room.frequency_Hz = std::clamp(fastest_mps / (kTwoPi * half_m), kSlowest_Hz, kFastest_Hz);
  } else if (std::isfinite(stroke_m)) {
    room.centre_m = 0.5 * stroke_m;
    room.amplitude_m = kFarShare * stroke_m;
  }
  if (std::isfinite(stroke_m)) {
    room.amplitude_m = std::max(room.amplitude_m, kFarShare * stroke_m);
    const double to_end_m = std::min(room.centre_m, stroke_m - room.centre_m);
    room.amplitude_m = std::min(room.amplitude_m, kOfStroke * to_end_m);
  }
  room.amplitude_m = rounded(room.amplitude_m);
  return room;
}

/// A reference of that kind, as far as the room allows times `share`.
ReferenceConfig reference_in(const Room& room, const char* kind, double share) {
  ReferenceConfig reference;
  reference.kind = kind;
  reference.centre_m = room.centre_m;
  reference.amplitude_m = rounded(share * room.amplitude_m);
  return reference;
}

ReferenceConfig multisine(const Room& room, double faster) {
  ReferenceConfig reference = reference_in(room, "multisine", 1.0);
  for (double& f_Hz : reference.frequencies_Hz)
    f_Hz = rounded(2.0 * faster * room.frequency_Hz * f_Hz);
  return reference;
}

ReferenceConfig steps(const Room& room, double hold_periods, double rise_periods) {
  ReferenceConfig reference = reference_in(room, "steps", 1.0);
  reference.hold_s = rounded(hold_periods / room.frequency_Hz);
  reference.rise_s = rounded(rise_periods / room.frequency_Hz);
  return reference;
}

}  // namespace

std::vector<TestMotion> test_motions(const selection::DiagnosisProblem& problem) {
  const Room room = room_of(problem);
  const double duration_s =
      std::round(std::clamp(kPeriods / room.frequency_Hz, kShortest_s, kLongest_s));
  ReferenceConfig chirp = reference_in(room, "chirp", 0.4);
  chirp.frequency_Hz = rounded(0.2 * room.frequency_Hz);
  chirp.frequency_end_Hz = rounded(5.0 * room.frequency_Hz);
  chirp.sweep_s = duration_s;
  ReferenceConfig prbs = reference_in(room, "prbs", 0.3);
  prbs.hold_s = rounded(0.25 / room.frequency_Hz);
  ReferenceConfig sine = reference_in(room, "sine", 1.0);
  sine.frequency_Hz = rounded(0.2 * room.frequency_Hz);
  std::vector<TestMotion> result;
  for (const ReferenceConfig& reference :
       {multisine(room, 1.0), steps(room, 0.2, 0.06), steps(room, 0.75, 0.02),
        steps(room, 1.5, 0.5), chirp, multisine(room, 0.25), prbs, sine}) {
    result.push_back({reference, duration_s, motion_words(reference, duration_s)});
  }
  return result;
}

std::optional<greybox::Dataset> simulated(const selection::DiagnosisProblem& problem,
                                          plant_sim::ModelFile model, const TestMotion& motion,
                                          std::uint64_t seed) {
  const greybox::Dataset& like = problem.data.records.front();
  const estimator::residual::NoiseFloor floor =
      estimator::residual::noise_floor(like.y_m, like.sample_time_s);
  simulate::Scenario scenario;
  scenario.reference = motion.reference;
  scenario.instruments.encoder_resolution_m = floor.encoder_step_m;
  const double rounding_m = floor.encoder_step_m / std::sqrt(12.0);
  const double noise_m = std::isfinite(floor.sd_m) ? floor.sd_m : 0.0;
  scenario.instruments.noise_m =
      std::sqrt(std::max(0.0, noise_m * noise_m - rounding_m * rounding_m));
  scenario.instruments.dac_bits = kDacBits;
  scenario.instruments.dac_range_V = kDac_V;
  model.step_s = greybox::step_for(model, simulate::kSampleTime_s);
  if (double* start_m = model.value("initial.y_m")) {
    *start_m = monitor::control::make_reference(motion.reference)->at(0.0);
  }
  scenario.model = std::move(model);
  config::record::Record record;
  record.name = motion.words;
  record.sample_time_s = simulate::kSampleTime_s;
  const auto samples = std::lround(motion.duration_s / simulate::kSampleTime_s);
  long saturated = 0;
  try {
    simulate::ClosedLoop loop(scenario, seed);
    for (long k = 0; k < samples; ++k) {
      const simulate::LoopRow row = loop.step();
      if (!std::isfinite(row.y_m)) return std::nullopt;
      record.t_s.push_back(row.t_s);
      record.u_V.push_back(row.u_applied_V);
      record.y_m.push_back(row.y_m);
      saturated += row.saturated ? 1 : 0;
    }
  } catch (const config::schema::Error&) {
    return std::nullopt;  // a model whose values cannot be simulated shows nothing
  }
  if (static_cast<double>(saturated) > kMostSaturated * static_cast<double>(samples)) {
    return std::nullopt;
  }
  return greybox::dataset_of(record);
}

}  // namespace workbench::diagnose
