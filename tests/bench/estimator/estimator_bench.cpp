// Cost per sample of the on-line estimators and of a batch fit. The record is read from a CSV file
// (u,y per line) named by SPOOLWATCH_BENCH_RECORD, so that peers work on the same numbers, or made
// here: ARX(4,4,1) driven by uniform noise.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "estimator/batch.h"
#include "estimator/recursive.h"
#include "estimator/sliding_window.h"

namespace {

using namespace estimator;

struct Data {
  std::vector<double> u_V, y_m;
};

Data generate() {
  Data out;
  std::uint64_t seed = 1;
  const auto uniform = [&seed] {
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(seed >> 11) / 9007199254740992.0 - 0.5;
  };
  constexpr std::size_t kSamples = 12000;
  for (std::size_t t = 0; t < kSamples; ++t) {
    out.u_V.push_back(uniform());
    double y = 1e-6 * uniform();
    if (t >= 4) {
      y +=
          1.8 * out.y_m[t - 1] - 1.2 * out.y_m[t - 2] + 0.4 * out.y_m[t - 3] - 0.1 * out.y_m[t - 4];
      for (std::size_t i = 1; i <= 4; ++i) y += 2e-4 / static_cast<double>(i) * out.u_V[t - i];
    }
    out.y_m.push_back(y);
  }
  return out;
}

const Data& record() {
  static const Data data = [] {
    const char* path = std::getenv("SPOOLWATCH_BENCH_RECORD");
    if (path == nullptr) return generate();
    Data out;
    std::ifstream file(path);
    double u = 0.0;
    double y = 0.0;
    char comma = 0;
    while (file >> u >> comma >> y) {
      out.u_V.push_back(u);
      out.y_m.push_back(y);
    }
    return out;
  }();
  return data;
}

const Structure kArx441{4, 4, 1, false};

void per_sample(benchmark::State& state, std::size_t samples) {
  state.counters["per_sample"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(samples),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void recursive(benchmark::State& state) {
  const Data& data = record();
  Recursive filter({.structure = kArx441,
                    .forgetting = static_cast<double>(state.range(0)) / 1000.0,
                    .limits = {}});
  for (auto _ : state) {
    for (std::size_t t = 0; t < data.u_V.size(); ++t) {
      benchmark::DoNotOptimize(filter.push(data.u_V[t], data.y_m[t]));
    }
  }
  per_sample(state, data.u_V.size());
}
BENCHMARK(recursive)
    ->Name("recursive_arx441/forgetting_permille")
    ->Arg(1000)
    ->Arg(995)
    ->UseRealTime();

void sliding(benchmark::State& state, bool estimate) {
  const Data& data = record();
  SlidingWindow window({.structure = kArx441,
                        .window = 400,
                        .stride = static_cast<int>(state.range(0)),
                        .limits = {}});
  for (auto _ : state) {
    for (std::size_t t = 0; t < data.u_V.size(); ++t) {
      if (!window.push(data.u_V[t], data.y_m[t])) continue;
      if (estimate) benchmark::DoNotOptimize(window.estimate());
    }
  }
  per_sample(state, data.u_V.size());
}
BENCHMARK_CAPTURE(sliding, update, false)->Arg(1)->Arg(10)->Arg(40)->UseRealTime();
BENCHMARK_CAPTURE(sliding, update_and_estimate, true)->Arg(1)->Arg(10)->Arg(40)->UseRealTime();

void batch(benchmark::State& state) {
  const Data& data = record();
  for (auto _ : state) benchmark::DoNotOptimize(fit_batch(kArx441, data.u_V, data.y_m));
  per_sample(state, data.u_V.size());
  const Estimate fit = fit_batch(kArx441, data.u_V, data.y_m);
  const auto names = kArx441.names();
  for (std::size_t i = 0; i < names.size(); ++i) state.counters[names[i]] = fit.value[i];
}
BENCHMARK(batch)->Name("batch_arx441")->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
