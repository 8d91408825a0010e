// Where edges come from: lines of a GPIO chip, or a test's own.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "hal/encoder/edge.h"

namespace hal::encoder {

/// The kernel keeps this many edges of each line, and silently drops those that come then.
inline constexpr std::size_t kFifo = 16;
/// Enough for one drain: three lines.
inline constexpr std::size_t kBatch = 3 * kFifo;

enum class Wake : std::uint8_t { edges, timeout, failed };

struct Drained {
  std::size_t count = 0;
  bool full = false;  ///< a line had as many as the kernel keeps: some may be missing
};

/// One thread at a time.
class EdgeSource {
 public:
  virtual ~EdgeSource() = default;
  /// Returns at the first edge, or after `timeout_ns` (0: at once).
  virtual Wake wait(std::int64_t timeout_ns) noexcept = 0;
  /// Takes what the last wait() announced, in any order between lines; never blocks.
  virtual Drained drain(std::span<Edge, kBatch> into) noexcept = 0;
  /// The present levels; empty when they cannot be read.
  virtual std::optional<Levels> levels() noexcept = 0;
};

}  // namespace hal::encoder
