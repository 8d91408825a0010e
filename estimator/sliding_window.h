// Least squares over the last `window` samples, renewed every `stride` samples, updated instead of
// recomputed and without ever subtracting old rows (downdating loses digits for good).
//
// The window is a queue of blocks, gcd(window, stride) samples each. Every block is a triangular
// factor; factors merge by orthogonal rotations, an associative operation, so the queue is kept as
// two stacks: the old side holds the merged factor of each block with all that follow it on that
// side, the new side one running factor. When the old side is empty the new side is turned over
// once. Each sample is so absorbed twice on average, whatever the window; memory is fixed: about
// 8 (p + 2)^2 bytes for each block, p coefficients (300 kB for ARX(4,4,1), window 400, stride 1).
// Source: the two-stack queue of sliding-window aggregation (Tangwongsan et al., VLDB 2015) with
// Gentleman's square-root-free rotations.
#pragma once

#include <memory>

#include "estimator/estimate.h"
#include "estimator/state_archive.h"

namespace estimator {

struct SlidingConfig {
  Structure structure;
  int window = 400;  ///< samples
  int stride = 1;    ///< samples between estimates, 1 to window
  Limits limits;
};

class SlidingWindow {
 public:
  /// Allocates all memory. Throws config::schema::UsageError for window or stride out of range.
  explicit SlidingWindow(const SlidingConfig& config);
  ~SlidingWindow();
  SlidingWindow(SlidingWindow&&) noexcept;
  SlidingWindow& operator=(SlidingWindow&&) noexcept;

  /// Takes the next sample; true when an estimate is due (every stride samples, also before the
  /// window is full: then it is invalid with too_short). NaN = missing. Never allocates.
  bool push(double u_V, double y_m) noexcept;
  /// `samples` periods without data: the window moves on, rows across the gap are dropped.
  /// True when an estimate became due in between.
  bool gap(long long samples) noexcept;
  /// Forgets everything.
  void reset() noexcept;
  void serialize(StateArchive& archive);

  /// Over the window at the last due moment, computed on each call. Never allocates.
  [[nodiscard]] Estimate estimate() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace estimator
