// A GPIO chip that behaves like the kernel's: 16 edges a line, the newest dropped when it is full.
#pragma once

#include <deque>
#include <vector>

#include "hal/encoder/edge_source.h"
#include "tests/hal/encoder/motion.h"

namespace hal::encoder::testing {

class FakeSource final : public EdgeSource {
 public:
  /// The lines move; the edge is queued, or dropped where the queue is full.
  void move(const Edge& edge) {
    if (edge.line == EncoderLine::a) levels_.a = edge.level;
    if (edge.line == EncoderLine::b) levels_.b = edge.level;
    std::deque<Edge>& queue = queues_[static_cast<std::size_t>(edge.line)];
    if (queue.size() < kFifo) queue.push_back(edge);
  }
  /// The levels move, and no edge tells of it.
  void jump(Levels levels) { levels_ = levels; }
  /// An edge that is known already, but not yet in its queue.
  void hold_back(const Edge& edge) { held_.push_back(edge); }
  void release() {
    for (const Edge& edge : held_) move(edge);
    held_.clear();
  }
  void fail(bool failing) { failing_ = failing; }

  Wake wait(std::int64_t) noexcept override {
    if (failing_) return Wake::failed;
    for (const auto& queue : queues_) {
      if (!queue.empty()) return Wake::edges;
    }
    return Wake::timeout;
  }
  Drained drain(std::span<Edge, kBatch> into) noexcept override {
    Drained drained;
    for (auto& queue : queues_) {
      drained.full = drained.full || queue.size() == kFifo;
      for (const Edge& edge : queue) into[drained.count++] = edge;
      queue.clear();
    }
    return drained;
  }
  std::optional<Levels> levels() noexcept override {
    if (failing_) return std::nullopt;
    return levels_;
  }

 private:
  Levels levels_ = levels_in(0);
  std::deque<Edge> queues_[3];
  std::vector<Edge> held_;
  bool failing_ = false;
};

}  // namespace hal::encoder::testing
