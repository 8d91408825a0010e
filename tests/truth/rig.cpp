#include "tests/truth/rig.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace truth {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr std::size_t kPressures = 0x9e3779b9;  ///< apart from any seed in use

double play(double output, double input, double half_width) {
  return std::min(std::max(output, input - half_width), input + half_width);
}

}  // namespace

Rig::Rig(const Plant& plant, const Hidden& hidden, const LeftOut& left_out, int steps,
         const Outside& outside, std::size_t seed)
    : actuator_(plant, hidden, left_out),
      steps_(steps > 0 ? steps : (hidden.coulomb_N > 0.0 ? 400 : 200)),
      disturber_(outside, seed),
      played_m_(kCentre_m) {
  x = actuator_.rest(kCentre_m);
  least_Pa = x[2];
  greatest_ratio = 0.5;
  past_V_.assign(static_cast<std::size_t>(std::floor(hidden.delay_s / kSample_s)) + 2, 0.0);
}

void Rig::hold(double u_V) {
  spool_speed_mps.push_back(0.0);
  past_V_.push_front(u_V);
  past_V_.pop_back();
  // With a delay of n whole samples and a rest, the older command acts for the rest's duration.
  const double delay_s = actuator_.hidden.delay_s;
  const auto whole = static_cast<std::size_t>(std::floor(delay_s / kSample_s));
  const double rest_s = delay_s - static_cast<double>(whole) * kSample_s;
  if (rest_s > 0.0) advance(past_V_[whole + 1], rest_s);
  advance(past_V_[whole], kSample_s - rest_s);
}

void Rig::change(const Plant& plant, const Hidden& hidden) {
  const LeftOut left_out = actuator_.left_out;
  actuator_ = Actuator(plant, hidden, left_out);
}

void Rig::advance(double u_V, double span_s) {
  const Hidden& h = actuator_.hidden;
  const int count = std::max(1, static_cast<int>(std::ceil(steps_ * span_s / kSample_s - 1e-9)));
  const double step_s = span_s / count;
  for (int i = 0; i < count; ++i) {
    const double biased_V = actuator_.left_out.command_V(u_V, t_s_) + h.null_bias_V;
    played_V_ = play(played_V_, biased_V, h.hysteresis_V);
    actuator_.outside_N = disturber_.force_N(t_s_);
    actuator_.outside_Pa = disturber_.pulsation_Pa(t_s_);
    actuator_.step(x, played_V_, t_s_, step_s);
    t_s_ += step_s;
    spool_speed_mps.back() = std::max(spool_speed_mps.back(), std::abs(x[5]));
    played_m_ = play(played_m_, x[0], 0.5 * h.backlash_m);
  }
  reached_V_ = played_V_;
  least_Pa = std::min({least_Pa, x[2], x[3]});
  greatest_ratio =
      std::max(greatest_ratio, std::max(x[2], x[3]) / actuator_.plant.supply_pressure_Pa);
  fastest_mps = std::max(fastest_mps, std::abs(x[1]));
}

double Rig::reading_m() const {
  const Hidden& h = actuator_.hidden;
  double reading = played_m_;
  if (h.eccentricity_m != 0.0) {
    reading += h.eccentricity_m * std::sin(kTwoPi * played_m_ / h.eccentricity_wavelength_m +
                                           h.eccentricity_phase_rad);
  }
  const double acceleration_mps2 = actuator_.rate(x, reached_V_, t_s_)[1];
  return actuator_.left_out.reading_m(reading, acceleration_mps2, t_s_) + disturber_.shake_m(t_s_);
}

Record simulate(const Case& of, int steps) {
  const auto samples = static_cast<std::size_t>(std::lround(of.length_s / kSample_s));
  Random random(of.seed);
  const std::vector<double> r_m = reference_m(of.motion, samples, random);
  Rig rig(of.plant, of.hidden, of.left_out, steps, of.outside, of.seed);
  Plant plant = of.plant;
  Hidden hidden = of.hidden;
  Record record;
  Random chance(of.seed + kPressures);  // the position's noise is the same with and without
  double sum_m2 = 0.0;
  for (std::size_t k = 0; k < samples; ++k) {
    for (const Change& change : of.changes) {
      if (static_cast<std::size_t>(std::lround(change.at_s / kSample_s)) != k) continue;
      if (change.plant != nullptr) plant.*change.plant = change.value;
      if (change.hidden != nullptr) hidden.*change.hidden = change.value;
      rig.change(plant, hidden);
    }
    const double reading_m = rig.reading_m();
    double y_m = reading_m + of.noise_m * random.normal();
    if (of.encoder_m > 0.0) y_m = of.encoder_m * std::round(y_m / of.encoder_m);
    double u_V = std::max(-10.0, std::min(10.0, of.kp_V_per_m * (r_m[k] - y_m)));
    if (of.converter_V > 0.0) {
      u_V = of.converter_V * std::round(u_V / of.converter_V);
      u_V = std::min(u_V, 10.0 - of.converter_V);
    }
    record.t_s.push_back(static_cast<double>(k) * kSample_s);
    record.u_V.push_back(u_V);
    record.y_m.push_back(y_m);
    record.reading_m.push_back(reading_m);
    sum_m2 += (y_m - reading_m) * (y_m - reading_m);
    if (of.pressure_noise_Pa >= 0.0) {
      record.supply_Pa.push_back(rig.inlet_Pa() + of.pressure_noise_Pa * chance.normal());
      record.in_Pa.push_back(rig.x[2] + of.pressure_noise_Pa * chance.normal());
      record.out_Pa.push_back(rig.x[3] + of.pressure_noise_Pa * chance.normal());
    }
    rig.hold(u_V);
  }
  record.floor_m = std::sqrt(sum_m2 / static_cast<double>(samples));
  record.least_Pa = rig.least_Pa;
  record.greatest_ratio = rig.greatest_ratio;
  record.fastest_mps = rig.fastest_mps;
  std::vector<double>& speeds = rig.spool_speed_mps;
  std::sort(speeds.begin(), speeds.end());
  record.quick_spool_mps = speeds[speeds.size() * 99 / 100];
  return record;
}

std::vector<double> replay(const Case& of, const std::vector<double>& u_V, int steps) {
  Rig rig(of.plant, of.hidden, of.left_out, steps, of.outside, of.seed);
  std::vector<double> reading_m;
  for (const double u : u_V) {
    reading_m.push_back(rig.reading_m());
    rig.hold(u);
  }
  return reading_m;
}

void write_csv(const Record& record, const std::string& file) {
  std::FILE* out = std::fopen(file.c_str(), "w");
  if (out == nullptr) throw std::runtime_error("cannot write " + file);
  const bool pressures = !record.supply_Pa.empty();
  std::fputs("t_s,u_V,y_m", out);
  if (pressures) std::fputs(",supply_pressure_Pa,pressure_in_Pa,pressure_out_Pa", out);
  std::fputs("\n", out);
  for (std::size_t k = 0; k < record.t_s.size(); ++k) {
    std::fprintf(out, "%.3f,%.6f,%.6f", record.t_s[k], record.u_V[k], record.y_m[k]);
    if (pressures) {
      std::fprintf(out, ",%.1f,%.1f,%.1f", record.supply_Pa[k], record.in_Pa[k], record.out_Pa[k]);
    }
    std::fputs("\n", out);
  }
  if (std::fclose(out) != 0) throw std::runtime_error("cannot write " + file);
}

}  // namespace truth
