// The moving parts: equations that all plants of this folder share, integrated by Heun's method.
//
//   friction (LuGre, or smooth: F = g(v) tanh(v/vt)): z' = v - s0 |v| z / g(v),
//                     F = s0 z + s1 exp(-(v/vd)^2) z',
//                     g = Fc (1 +- r) + (Fs - Fc)+ exp(-(v/vs)^2)
//   load:             F = f + k (y - rest) + (c + c') v |v| + d' v + a sin w + s sin 2w + c cos 2w,
//                     w = 2 pi y/wavelength + phase
//
// Source of LuGre: Canudas de Wit, Olsson, Astrom, Lischinsky (1995).
#pragma once

#include <array>
#include <limits>

#include "tests/truth/hidden.h"
#include "tests/truth/left_out.h"

namespace truth {

/// y, v, four of the plant's own (Pi, Po, spool, spool speed where there is oil), bristle
/// deflection.
using State = std::array<double, 7>;

/// LuGre's sliding level g(v), N.
double sliding_level_N(const Hidden& hidden, double v_mps);

class Machine {
 public:
  Machine(const Hidden& hidden_, const LeftOut& left_out_) : hidden(hidden_), left_out(left_out_) {}
  virtual ~Machine() = default;

  /// At y_m, at rest.
  [[nodiscard]] virtual State rest(double y_m) const = 0;
  /// The time derivative of the state; u_V is what passes the command chain.
  [[nodiscard]] virtual State rate(const State& x, double u_V, double t_s) const = 0;
  /// Integration steps in 5 ms.
  [[nodiscard]] virtual int steps() const = 0;
  /// 0: there is no oil.
  [[nodiscard]] virtual double supply_Pa() const { return 0.0; }
  /// Supply pressure at the valve: what the flow drawn leaves of it.
  [[nodiscard]] virtual double inlet_Pa(const State&, double) const { return 0.0; }

  /// One step of Heun's method.
  void step(State& x, double u_V, double t_s, double step_s) const;
  /// Force of bristles that give at `bristle_mps`.
  [[nodiscard]] double friction_N(double z_m, double v_mps, double bristle_mps) const;

  Hidden hidden;
  LeftOut left_out;
  /// From outside, as they are now.
  double outside_N = 0.0;
  double outside_Pa = 0.0;

 private:
  /// Bends bristles that follow the speed within less than a step as far as they then do.
  void settle_bristles(State& x, double step_s) const;

 protected:
  /// Keeps the state where it can be after a step.
  virtual void bound(State&) const {}
  [[nodiscard]] double bristle_rate_mps(double z_m, double v_mps) const;
  /// Everything that resists but the bristles and the plant's own damping.
  [[nodiscard]] double resisting_N(double y_m, double v_mps, double t_s) const;
  /// Opening behind overlap and asymmetry; per volt: opening per volt of command.
  [[nodiscard]] double uneven(double spool, double per_volt) const;
  /// Magnitude of the flow drawn from the supply against port_Pa through k: the droop's quadratic.
  [[nodiscard]] double drawn_m3ps(double k, double supply_Pa, double port_Pa) const;
};

double signed_root(double x);

}  // namespace truth
