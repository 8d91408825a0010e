// A servo-hydraulic stand in a page, written from the printed equations alone, so that the fault
// detection is not judged on data from the project's own simulator.
//
//   m v' = A (Pi - Po) - d v           Pi' = beta/(V0 + A y) (Qi - A v)
//   xv'' = -2 zeta wv xv' - wv^2 xv + Kv wv^2 u     Po' = beta/(V0 + A (L - y)) (A v - Qo)
//   Q = Cd w xv sqrt(2/rho dP), each through the orifice that the spool opens
//
// Loop at 200 Hz: u = Kp (r - y_measured), 12-bit D/A over +-10 V. Source: Song 2002, chapter 4.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "config/signals/sample.h"

namespace small_rig {

inline constexpr double kSampleTime_s = 0.005;
inline constexpr double kPsi_Pa = 6894.757293168361;
inline constexpr double kTwoPi = 6.283185307179586;

struct Setup {
  double supply_Pa = 6.89e6;
  double damping_N_s_per_m = 1000.0;
  double valve_gain_m_per_V = 2.23939e-5;
  double kp_V_per_m = 250.0;
  double phase_s = 0.0;     ///< the reference starts this far into its period
  bool instruments = true;  ///< 5 um encoder, 12-bit D/A, 2 um noise
  unsigned seed = 1;
};

class Rig {
 public:
  explicit Rig(const Setup& setup)
      : supply_Pa(setup.supply_Pa),
        damping_N_s_per_m(setup.damping_N_s_per_m),
        setup_(setup),
        random_(setup.seed) {
    x_ = {0.305, 0.0, setup.supply_Pa / 2, setup.supply_Pa / 2, 0.0, 0.0};
  }

  double supply_Pa;  ///< may change between steps
  double damping_N_s_per_m;

  config::signals::Sample step() {
    config::signals::Sample s;
    s.tick = tick_;
    s.reference_m = 0.0254 * std::sin(kTwoPi * 0.5 * (time_s() + setup_.phase_s)) + 0.305;
    s.y_m = measured_m();
    s.u_requested_V = setup_.kp_V_per_m * (s.reference_m - s.y_m);
    s.u_applied_V = applied_V(s.u_requested_V);
    s.saturated = std::abs(s.u_requested_V) > 10.0;
    constexpr int kSteps = 5;
    for (int i = 0; i < kSteps; ++i) runge_kutta(s.u_applied_V, kSampleTime_s / kSteps);
    ++tick_;
    return s;
  }
  [[nodiscard]] double time_s() const { return static_cast<double>(tick_) * kSampleTime_s; }

 private:
  using State = std::array<double, 6>;

  double measured_m() {
    if (!setup_.instruments) return x_[0];
    constexpr double kStep_m = 5e-6;
    constexpr double kNoise_m = 2e-6;
    return kStep_m * std::round((x_[0] + kNoise_m * normal_(random_)) / kStep_m);
  }
  [[nodiscard]] double applied_V(double u_V) const {
    const double limited_V = std::fmax(-10.0, std::fmin(10.0, u_V));
    if (!setup_.instruments) return limited_V;
    constexpr double kCode_V = 20.0 / 4096.0;
    return std::fmin(10.0 - kCode_V, kCode_V * std::round(limited_V / kCode_V));
  }
  static double root(double x) { return std::copysign(std::sqrt(std::abs(x)), x); }

  [[nodiscard]] State slope(const State& x, double u_V) const {
    constexpr double kArea = 6.33e-4, kMass = 50.0, kBeta = 6.89e8, kDead = 1e-5, kStroke = 0.61;
    constexpr double kWv = 628.0, kZeta = 0.7, kOrifice = 0.6 * 2.07e-2;
    const double flow = kOrifice * x[4] * std::sqrt(2.0 / 847.0);
    const bool out = x[4] >= 0.0;
    const double q_i = flow * root(out ? supply_Pa - x[2] : x[2]);
    const double q_o = flow * root(out ? x[3] : supply_Pa - x[3]);
    return {x[1],
            (kArea * (x[2] - x[3]) - damping_N_s_per_m * x[1]) / kMass,
            kBeta / (kDead + kArea * x[0]) * (q_i - kArea * x[1]),
            kBeta / (kDead + kArea * (kStroke - x[0])) * (kArea * x[1] - q_o),
            x[5],
            kWv * kWv * (setup_.valve_gain_m_per_V * u_V - x[4]) - 2.0 * kZeta * kWv * x[5]};
  }
  void runge_kutta(double u_V, double h) {
    const auto moved = [this](const State& k, double by) {
      State x = x_;
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += by * k[i];
      return x;
    };
    const State k1 = slope(x_, u_V);
    const State k2 = slope(moved(k1, h / 2), u_V);
    const State k3 = slope(moved(k2, h / 2), u_V);
    const State k4 = slope(moved(k3, h), u_V);
    for (std::size_t i = 0; i < x_.size(); ++i) {
      x_[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    }
  }

  Setup setup_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  State x_;
  std::int64_t tick_ = 0;
};

}  // namespace small_rig
