// One step of the classical fourth-order Runge-Kutta method.
//
//   x(t + h) = x + h/6 (k1 + 2 k2 + 2 k3 + k4)
#pragma once

namespace plant_sim {

/// State needs `State moved(State rate, S by)` (x + by rate) and operator+ between rates.
template <class State, class S, class Rate>
State runge_kutta_step(const State& x, const S& step_s, Rate&& rate) {
  const S half_s = step_s * S(0.5);
  const State k1 = rate(x);
  const State k2 = rate(x.moved(k1, half_s));
  const State k3 = rate(x.moved(k2, half_s));
  const State k4 = rate(x.moved(k3, step_s));
  const State middle = k2 + k3;
  return x.moved(k1 + middle + middle + k4, step_s * S(1.0 / 6.0));
}

}  // namespace plant_sim
