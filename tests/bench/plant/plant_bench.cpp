// One RK4 step of the actuator: ours whole (limits watched), Boost.odeint on the same right-hand
// side, and eight lanes. The record is the same closed loop: 0.5 Hz sine, 200 Hz control, 1 ms
// steps.
#include <benchmark/benchmark.h>

#include <array>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <cmath>
#include <memory>

#include "plant_sim/hydraulic_actuator.h"

namespace {

using plant_sim::HydraulicActuator;
using plant_sim::Simd;
using Actuator = HydraulicActuator<double>;

constexpr int kSteps = 10000;  // ten seconds
constexpr int kStepsPerSample = 5;

double reference_m(int step) { return 0.0254 * std::sin(M_PI * step * 1e-3) + 0.305; }

template <class S, bool kEveryEffect = false>
void ours(benchmark::State& bench) {
  auto plant = std::make_unique<HydraulicActuator<S>>();
  plant->effects.each([](auto, auto& parameters) {
    parameters.visit([](const plant_sim::ParameterInfo& info, S& value) {
      if (kEveryEffect) value = info.typical;
    });
  });
  for (auto _ : bench) {
    plant->prepare(1e-3);
    plant->reset();
    S u_V = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      if (i % kStepsPerSample == 0) {
        plant->prepare(1e-3);
        u_V = S(100.0) * (S(reference_m(i)) - plant->state.y_m);
      }
      plant->step(u_V);
    }
    benchmark::DoNotOptimize(plant->state);
  }
  bench.counters["step"] =
      benchmark::Counter(static_cast<double>(bench.iterations()) * kSteps,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(ours<double>)->Name("plant_sim")->Unit(benchmark::kMicrosecond);
BENCHMARK(ours<Simd>)->Name("plant_sim_eight_lanes")->Unit(benchmark::kMicrosecond);
BENCHMARK(ours<double, true>)->Name("plant_sim_every_effect")->Unit(benchmark::kMicrosecond);
BENCHMARK(ours<Simd, true>)->Name("plant_sim_every_effect_lanes")->Unit(benchmark::kMicrosecond);

void odeint(benchmark::State& bench) {
  using State = std::array<double, 6>;
  auto plant = std::make_unique<Actuator>();
  plant->prepare(1e-3);
  plant->reset();
  double u_V = 0.0;
  const auto rate = [&](const State& x, State& dxdt, double) {
    const Actuator::State r =
        plant->rate<false, false>({x[0], x[1], x[2], x[3], x[4], x[5]}, u_V, x[0]);
    dxdt = {r.y_m, r.v_mps, r.in_Pa, r.out_Pa, r.spool_m, r.spool_mps};
  };
  for (auto _ : bench) {
    boost::numeric::odeint::runge_kutta4<State> stepper;
    State x = {0.305, 0.0, 3.445e6, 3.445e6, 0.0, 0.0};
    for (int i = 0; i < kSteps; ++i) {
      if (i % kStepsPerSample == 0) u_V = 100.0 * (reference_m(i) - x[0]);
      stepper.do_step(rate, x, i * 1e-3, 1e-3);
    }
    benchmark::DoNotOptimize(x);
  }
  bench.counters["step"] =
      benchmark::Counter(static_cast<double>(bench.iterations()) * kSteps,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(odeint)->Name("odeint_runge_kutta4")->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
