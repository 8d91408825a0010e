#include "hal/encoder/tracker.h"

#include <algorithm>

namespace hal::encoder {
namespace {

/// An edge may be on its way from interrupt to queue: levels must contradict this often.
constexpr int kDisagreements = 3;

}  // namespace

std::optional<Levels> still_levels(EdgeSource& source) noexcept {
  constexpr int kAttempts = 1000;
  for (int i = 0; i < kAttempts; ++i) {
    std::array<Edge, kBatch> older;
    while (source.wait(0) == Wake::edges && i++ < kAttempts) (void)source.drain(older);
    const std::optional<Levels> levels = source.levels();
    if (!levels || source.wait(0) == Wake::timeout) return levels;
  }
  return std::nullopt;
}

Tracker::Tracker(const TrackerOptions& options, std::optional<Levels> levels) noexcept
    : options_(options), decoder_(levels.value_or(Levels{})) {
  snapshot_.homed = !options.has_index;
  burst_ns_ = static_cast<std::int64_t>(kBurst * 1e9 / options.max_edges_per_s);
  if (!levels) decoder_.mark_lost();
}

void Tracker::step(EdgeSource& source, std::int64_t timeout_ns, std::int64_t (*clock)()) noexcept {
  const Wake wake =
      source.wait(disagreeing_ > 0 ? std::min(timeout_ns, kCompareEvery_ns) : timeout_ns);
  snapshot_.failed = wake == Wake::failed;
  if (wake == Wake::edges) {
    std::array<Edge, kBatch> batch;
    const Drained drained = source.drain(batch);
    take(std::span(batch).first(drained.count));
    if (drained.full) {
      ++snapshot_.overflows;
      lose();
    }
    disagreeing_ = 0;
  }
  const std::int64_t now_ns = clock();
  if (!snapshot_.failed && now_ns - compared_ns_ >= kCompareEvery_ns) {
    compared_ns_ = now_ns;
    compare(source);
  }
  watch_rate(now_ns);
  publish(now_ns);
}

void Tracker::take(std::span<Edge> batch) noexcept {
  // Each line's edges are in order already: almost sorted.
  for (std::size_t i = 1; i < batch.size(); ++i) {
    const Edge edge = batch[i];
    std::size_t place = i;
    for (; place > 0 && batch[place - 1].t_ns > edge.t_ns; --place) batch[place] = batch[place - 1];
    batch[place] = edge;
  }
  for (const Edge& edge : batch) put(edge);
  snapshot_.edges += static_cast<std::int64_t>(batch.size());
  window_edges_ += static_cast<std::int64_t>(batch.size());
}

void Tracker::put(const Edge& edge) noexcept {
  std::uint64_t place = steps_;
  while (place > oldest_ && history_[(place - 1) % kHistory].edge.t_ns > edge.t_ns) --place;
  if (place == steps_) {
    apply(edge);
    snapshot_.edge_ns = std::max(snapshot_.edge_ns, edge.t_ns);
    if (steps_ - oldest_ > kHistory) oldest_ = steps_ - kHistory;
    watch_burst();
    return;
  }
  ++snapshot_.late;
  const bool too_late = place == oldest_ && oldest_ > 0;  // older than all that can be undone
  std::array<Edge, kHistory> again;
  const std::size_t count = steps_ - place;
  for (std::size_t i = 0; i < count; ++i) again[i] = history_[(place + i) % kHistory].edge;
  decoder_ = history_[place % kHistory].before;
  steps_ = place;
  apply(edge);
  for (std::size_t i = 0; i < count; ++i) apply(again[i]);
  if (steps_ - oldest_ > kHistory) oldest_ = steps_ - kHistory;
  if (too_late) lose();
}

void Tracker::watch_burst() noexcept {
  if (steps_ - oldest_ <= kBurst) return;
  const std::int64_t first_ns = history_[(steps_ - 1 - kBurst) % kHistory].edge.t_ns;
  if (history_[(steps_ - 1) % kHistory].edge.t_ns - first_ns >= burst_ns_) return;
  ++snapshot_.bursts;
  lose();
}

void Tracker::lose() noexcept {
  decoder_.mark_lost();
  oldest_ = steps_;
}

void Tracker::apply(const Edge& edge) noexcept {
  history_[steps_ % kHistory] = {edge, decoder_};
  ++steps_;
  decoder_.edge(edge);
}

void Tracker::compare(EdgeSource& source) noexcept {
  const std::optional<Levels> levels = source.levels();
  if (!levels) {
    snapshot_.failed = true;
    return;
  }
  if (source.wait(0) != Wake::timeout) return;  // they may be newer than what was taken
  if (*levels == decoder_.levels()) {
    disagreeing_ = 0;
    return;
  }
  if (++disagreeing_ < kDisagreements) return;
  disagreeing_ = 0;
  ++snapshot_.disagreements;
  decoder_.resync(*levels);
  oldest_ = steps_;
}

void Tracker::refer() noexcept {
  decoder_.refer();
  oldest_ = steps_;
  referred_ = true;
}

void Tracker::watch_rate(std::int64_t now_ns) noexcept {
  if (window_ns_ == 0) window_ns_ = now_ns;
  const std::int64_t elapsed_ns = now_ns - window_ns_;
  if (elapsed_ns < kWindow_ns) return;
  snapshot_.edges_per_s =
      static_cast<double>(window_edges_) / (static_cast<double>(elapsed_ns) * 1e-9);
  const bool fast = snapshot_.edges_per_s > kWarnRatio * options_.max_edges_per_s;
  if (fast && !snapshot_.too_fast) ++snapshot_.times_too_fast;
  snapshot_.too_fast = fast;
  window_ns_ = now_ns;
  window_edges_ = 0;
}

void Tracker::publish(std::int64_t now_ns) noexcept {
  if (decoder_.lost() && !snapshot_.lost) ++snapshot_.times_lost;
  snapshot_.lost = decoder_.lost();
  snapshot_.counts = decoder_.counts(options_.per_cycle);
  snapshot_.homed = !options_.has_index || referred_ || decoder_.captures() > 0;
  snapshot_.illegal = decoder_.illegal();
  snapshot_.slips = decoder_.slips();
  snapshot_.alive_ns = now_ns;
}

}  // namespace hal::encoder
