// Tracks an encoder despite the kernel's edge queue: edges arrive in batches, line by line,
// sometimes late, and the newest are dropped silently when the queue is not read in time.
//
// Late edges are inserted by time. Missing ones show as an edge to the present level, as a batch as
// long as the kernel's queue, or as levels that stay different from the decoder's while nothing
// arrives; edges faster than the permitted rate may be lost without a trace. Then the count is
// uncertain until the next index pulse or refer().
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "hal/encoder/edge_source.h"
#include "hal/encoder/quadrature.h"

namespace hal::encoder {

/// Snapshot for the loop.
struct EncoderSnapshot {
  std::int64_t counts = 0;    ///< from the origin
  std::int64_t edge_ns = 0;   ///< time of the newest edge, 0 before the first
  std::int64_t alive_ns = 0;  ///< time at which this view was complete
  bool lost = false;          ///< edges are missing
  bool homed = false;         ///< the index has been passed, or there is none
  bool too_fast = false;      ///< above 80 % of the permitted edge rate
  bool failed = false;        ///< the lines cannot be read
  double edges_per_s = 0.0;   ///< over the last window
  // Counters since the start.
  std::int64_t edges = 0;
  std::int64_t illegal = 0;        ///< edges to the present level
  std::int64_t overflows = 0;      ///< batches as long as the kernel's queue
  std::int64_t disagreements = 0;  ///< levels that contradicted the decoder
  std::int64_t bursts = 0;         ///< runs of eight edges faster than permitted
  std::int64_t late = 0;           ///< edges inserted afterwards
  std::int64_t slips = 0;          ///< index pulses at another position than before
  std::int64_t times_lost = 0;     ///< transitions to an uncertain count
  std::int64_t times_too_fast = 0;
};

struct TrackerOptions {
  int per_cycle = 4;  ///< counts: 1, 2 or 4
  double max_edges_per_s = 0.0;
  bool has_index = false;
};

/// Share of the permitted rate from which the reading is called uncertain.
inline constexpr double kWarnRatio = 0.8;

/// Initial levels, free of edges that are still queued or arrive meanwhile. Empty when they cannot
/// be read or change too fast.
[[nodiscard]] std::optional<Levels> still_levels(EdgeSource& source) noexcept;

class Tracker {
 public:
  /// Without levels the count is uncertain from the start.
  Tracker(const TrackerOptions& options, std::optional<Levels> levels) noexcept;

  /// Waits once for at most `timeout_ns`, processes the queued edges, compares levels now and then.
  /// `clock`: CLOCK_MONOTONIC in ns.
  void step(EdgeSource& source, std::int64_t timeout_ns, std::int64_t (*clock)()) noexcept;
  /// Makes the present position the origin, and certain.
  void refer() noexcept;

  [[nodiscard]] const EncoderSnapshot& snapshot() const noexcept { return snapshot_; }

 private:
  struct Step {
    Edge edge;
    QuadratureDecoder before;
  };
  static constexpr std::size_t kHistory = 32;
  static constexpr std::size_t kBurst = 8;  ///< edges
  static constexpr std::int64_t kWindow_ns = 10'000'000;
  static constexpr std::int64_t kCompareEvery_ns = 1'000'000;

  void take(std::span<Edge> batch) noexcept;
  void put(const Edge& edge) noexcept;
  void apply(const Edge& edge) noexcept;
  void watch_burst() noexcept;
  void lose() noexcept;
  void compare(EdgeSource& source) noexcept;
  void watch_rate(std::int64_t now_ns) noexcept;
  void publish(std::int64_t now_ns) noexcept;

  TrackerOptions options_;
  std::int64_t burst_ns_ = 0;  ///< shortest permitted time of kBurst edges
  QuadratureDecoder decoder_;
  EncoderSnapshot snapshot_;
  std::array<Step, kHistory> history_;  ///< the newest edges, a ring
  std::uint64_t steps_ = 0;             ///< total number inserted
  std::uint64_t oldest_ = 0;            ///< oldest step that can still be undone
  bool referred_ = false;
  int disagreeing_ = 0;  ///< comparisons in a row
  std::int64_t compared_ns_ = 0;
  std::int64_t window_ns_ = 0;  ///< start of the rate's window
  std::int64_t window_edges_ = 0;
};

}  // namespace hal::encoder
