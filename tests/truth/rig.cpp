#include "tests/truth/rig.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace truth {
namespace {

constexpr double kTwoPi = 6.283185307179586;

double play(double output, double input, double half_width) {
  return std::min(std::max(output, input - half_width), input + half_width);
}

}  // namespace

Rig::Rig(std::unique_ptr<Machine> machine, int steps, const Outside& outside, std::size_t seed,
         double sample_s)
    : machine_(std::move(machine)),
      steps_(steps > 0 ? steps : machine_->steps()),
      disturber_(outside, seed),
      sample_s_(sample_s),
      played_m_(kCentre_m) {
  x = machine_->rest(kCentre_m);
  const bool oil = machine_->supply_Pa() > 0.0;
  least_Pa = oil ? std::min(x[2], x[3]) : Hidden::kNone;
  greatest_ratio = oil ? std::max(x[2], x[3]) / machine_->supply_Pa() : 0.0;
  const double delay_s = machine_->hidden.delay_s;
  past_V_.assign(static_cast<std::size_t>(std::floor(delay_s / sample_s)) + 2, 0.0);
}

void Rig::hold(double u_V) {
  spool_speed_mps.push_back(0.0);
  past_V_.push_front(u_V);
  past_V_.pop_back();
  // With a delay of n whole samples and a rest, the older command acts for the rest's duration.
  const double delay_s = machine_->hidden.delay_s;
  const auto whole = static_cast<std::size_t>(std::floor(delay_s / sample_s_));
  const double rest_s = delay_s - static_cast<double>(whole) * sample_s_;
  if (rest_s > 0.0) advance(past_V_[whole + 1], rest_s);
  advance(past_V_[whole], sample_s_ - rest_s);
}

void Rig::advance(double u_V, double span_s) {
  const Hidden& h = machine_->hidden;
  const int count = std::max(1, static_cast<int>(std::ceil(steps_ * span_s / kSample_s - 1e-9)));
  const double step_s = span_s / count;
  for (int i = 0; i < count; ++i) {
    const double biased_V = machine_->left_out.command_V(u_V, t_s_) + h.null_bias_V;
    played_V_ = play(played_V_, biased_V, h.hysteresis_V);
    reached_V_ = std::clamp(played_V_, -h.drive_limit_V, h.drive_limit_V);
    const double band_V = h.ahead_ratio * h.deadband_V;
    reached_V_ -= std::clamp(reached_V_, -band_V, band_V);
    machine_->outside_N = disturber_.force_N(t_s_);
    machine_->outside_Pa = disturber_.pulsation_Pa(t_s_);
    machine_->step(x, reached_V_, t_s_, step_s);
    t_s_ += step_s;
    spool_speed_mps.back() = std::max(spool_speed_mps.back(), std::abs(x[5]));
    played_m_ = play(played_m_, x[0], 0.5 * h.backlash_m);
  }
  if (machine_->supply_Pa() > 0.0) {
    least_Pa = std::min({least_Pa, x[2], x[3]});
    greatest_ratio = std::max(greatest_ratio, std::max(x[2], x[3]) / machine_->supply_Pa());
  }
  fastest_mps = std::max(fastest_mps, std::abs(x[1]));
}

double Rig::reading_m() const {
  const Hidden& h = machine_->hidden;
  double reading = played_m_;
  if (h.eccentricity_m != 0.0) {
    reading += h.eccentricity_m * std::sin(kTwoPi * played_m_ / h.eccentricity_wavelength_m +
                                           h.eccentricity_phase_rad);
  }
  const double acceleration_mps2 = machine_->rate(x, reached_V_, t_s_)[1];
  return machine_->left_out.reading_m(reading, acceleration_mps2, t_s_) + disturber_.shake_m(t_s_);
}

}  // namespace truth
