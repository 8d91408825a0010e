#include "tests/truth/machine.h"

#include <cmath>
#include <cstddef>

namespace truth {
namespace {

constexpr double kTwoPi = 6.283185307179586;
/// Steps times rate of decay up to which Heun's method is stable.
constexpr double kStable = 2.0;

double sign(double x) { return x > 0.0 ? 1.0 : (x < 0.0 ? -1.0 : 0.0); }

}  // namespace

double signed_root(double x) { return x < 0.0 ? -std::sqrt(-x) : std::sqrt(x); }

double sliding_level_N(const Hidden& hidden, double v_mps) {
  double level_N = hidden.coulomb_N;
  if (hidden.static_N > level_N) {
    const double ratio = v_mps / hidden.stribeck_mps;
    level_N += (hidden.static_N - level_N) * std::exp(-ratio * ratio);
  }
  return level_N * (1.0 + hidden.direction_ratio * sign(v_mps));
}

double Machine::bristle_rate_mps(double z_m, double v_mps) const {
  if (hidden.transition_mps > 0.0) return 0.0;
  const double level_N = sliding_level_N(hidden, v_mps);
  return v_mps - hidden.presliding_N_per_m * std::abs(v_mps) * z_m / level_N;
}

double Machine::friction_N(double z_m, double v_mps, double bristle_mps) const {
  const double fast = v_mps / hidden.damping_speed_mps;
  return hidden.presliding_N_per_m * z_m +
         hidden.bristle_N_s_per_m * std::exp(-fast * fast) * bristle_mps;
}

double Machine::resisting_N(double y_m, double v_mps, double t_s) const {
  double force_N = hidden.force_N + hidden.spring_N_per_m * (y_m - hidden.rest_m);
  force_N += (hidden.quadratic_N_s2_per_m2 + hidden.needle_N_s2_per_m2) * v_mps * std::abs(v_mps);
  force_N += hidden.slaves_N_s_per_m * v_mps;
  if (hidden.coulomb_N > 0.0 && hidden.transition_mps > 0.0) {
    force_N += sliding_level_N(hidden, v_mps) * std::tanh(v_mps / hidden.transition_mps);
  }
  if (hidden.ripple_N != 0.0) {
    const double w = kTwoPi * y_m / hidden.ripple_wavelength_m + hidden.ripple_phase_rad;
    force_N += hidden.ripple_N * std::sin(w) + hidden.ripple_second_sin_N * std::sin(2.0 * w) +
               hidden.ripple_second_cos_N * std::cos(2.0 * w);
  }
  return force_N + outside_N + left_out.force_N(y_m, v_mps, t_s);
}

double Machine::uneven(double spool, double per_volt) const {
  const double overlap = (1.0 - hidden.ahead_ratio) * hidden.deadband_V * per_volt;
  double open = spool;
  if (overlap > 0.0) open = std::abs(spool) <= overlap ? 0.0 : spool - overlap * sign(spool);
  if (const double corner = hidden.corner_V * per_volt; corner > 0.0) {
    // the mean of edges at every place within the corner, by the antiderivative of one
    const auto area = [&](double x) {
      const double beyond = std::max(std::abs(x) - overlap, 0.0);
      return 0.5 * beyond * beyond;
    };
    open = (area(spool + corner) - area(spool - corner)) / (2.0 * corner);
  }
  if (const double clearance = hidden.clearance_V * per_volt; clearance > 0.0) {
    const auto edge = [&](double ahead) { return 0.5 * (ahead + std::hypot(ahead, clearance)); };
    open = edge(spool - overlap) - edge(-spool - overlap);
  }
  return open * (1.0 + hidden.asymmetry_ratio * sign(open));
}

double Machine::drawn_m3ps(double k, double supply_Pa, double port_Pa) const {
  const double drop_Pa = supply_Pa - port_Pa;
  if (hidden.droop_Pa_per_m3ps <= 0.0 || drop_Pa <= 0.0) return k * signed_root(drop_Pa);
  const double half = 0.5 * k * k * hidden.droop_Pa_per_m3ps;  // q^2 + 2 half q = k^2 drop
  return std::sqrt(half * half + k * k * drop_Pa) - half;
}

void Machine::settle_bristles(State& x, double step_s) const {
  if (hidden.coulomb_N <= 0.0 || hidden.transition_mps > 0.0) return;
  const double v_mps = x[1];
  const double level_N = sliding_level_N(hidden, v_mps);
  const double rate_per_s = hidden.presliding_N_per_m * std::abs(v_mps) / level_N;
  if (rate_per_s * step_s > kStable) x[6] = sign(v_mps) * level_N / hidden.presliding_N_per_m;
}

void Machine::step(State& x, double u_V, double t_s, double step_s) const {
  settle_bristles(x, step_s);
  const State first = rate(x, u_V, t_s);
  State ahead{};
  for (std::size_t i = 0; i < x.size(); ++i) ahead[i] = x[i] + step_s * first[i];
  const State second = rate(ahead, u_V, t_s + step_s);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += 0.5 * step_s * (first[i] + second[i]);
  bound(x);
}

}  // namespace truth
