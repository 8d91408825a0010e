// Edges a second that the encoder's decoder, tracker and hand-over sustain, fed by a chip in memory
// that keeps 16 edges a line as the kernel does: what is left of a core for the kernel's own part.
#include <benchmark/benchmark.h>

#include "hal/encoder/encoder.h"
#include "tests/hal/encoder/motion.h"

namespace {

using namespace hal::encoder;  // NOLINT: a benchmark

/// Gives the next `batch` edges of a motion without end, up and down over 1000 quarters.
class Endless final : public EdgeSource {
 public:
  explicit Endless(std::size_t batch) : batch_(batch) {
    std::int64_t t_ns = 0;
    for (int quarter = 0; quarter < 1000; ++quarter) {
      cycle_.push_back(testing::edge_between(quarter, quarter + 1, t_ns += 100));
    }
    for (int quarter = 1000; quarter > 0; --quarter) {
      cycle_.push_back(testing::edge_between(quarter, quarter - 1, t_ns += 100));
    }
    length_ns_ = t_ns;
  }
  Wake wait(std::int64_t) noexcept override { return Wake::edges; }
  /// Line by line, as a kernel's queues are drained.
  Drained drain(std::span<Edge, kBatch> into) noexcept override {
    Drained drained;
    for (const Line line : {Line::a, Line::b}) {
      for (std::size_t i = next_; i < next_ + batch_; ++i) {
        Edge edge = cycle_[i % cycle_.size()];
        if (edge.line != line) continue;
        edge.t_ns += static_cast<std::int64_t>(i / cycle_.size()) * length_ns_;
        into[drained.count++] = edge;
      }
    }
    next_ += batch_;
    return drained;
  }
  std::optional<Levels> levels() noexcept override { return Levels{}; }

 private:
  std::size_t batch_;
  std::vector<Edge> cycle_;
  std::int64_t length_ns_ = 0;
  std::size_t next_ = 0;
};

void decode(benchmark::State& state) {
  QuadratureDecoder decoder;
  std::vector<Edge> edges;
  for (int quarter = 0; quarter < 1000; ++quarter) {
    edges.push_back(testing::edge_between(quarter, quarter + 1, 0));
  }
  for (auto _ : state) {
    for (const Edge& edge : edges) decoder.edge(edge);
    benchmark::DoNotOptimize(decoder);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(edges.size()));
  if (decoder.illegal() > 0) state.SkipWithError("illegal edges");
}
BENCHMARK(decode);

/// One pass of the encoder's thread: fetch a batch, merge, decode, hand over.
void track_and_hand_over(benchmark::State& state) {
  Endless source(static_cast<std::size_t>(state.range(0)));
  Tracker tracker({4, 1e12, false}, Levels{});
  hal::Latest<Watch::View> latest;
  Watch::View view;
  for (auto _ : state) {
    tracker.step(source, 0, hal::monotonic_ns);
    view.rod = tracker.snapshot();
    latest.put(view);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
  if (tracker.snapshot().lost) state.SkipWithError("edges were lost");
}
BENCHMARK(track_and_hand_over)->Arg(1)->Arg(4)->Arg(16)->Arg(30);

}  // namespace

BENCHMARK_MAIN();
