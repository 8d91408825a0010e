// Source of encoder edges: lines of a GPIO chip, or a test double.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace hal::encoder {

/// Events of encoder lines: edges with their time, and levels.
enum class EncoderLine : std::uint8_t { a, b, index };

struct Edge {
  std::int64_t t_ns = 0;  ///< CLOCK_MONOTONIC
  EncoderLine line = EncoderLine::a;
  bool level = false;  ///< after the edge
};

struct Levels {
  bool a = false;
  bool b = false;
};

inline bool operator==(Levels x, Levels y) noexcept { return x.a == y.a && x.b == y.b; }

/// Capacity of the kernel's queue per line; further edges are dropped silently.
inline constexpr std::size_t kFifo = 16;
/// Enough for one drain: three lines.
inline constexpr std::size_t kBatch = 3 * kFifo;

enum class Wake : std::uint8_t { edges, timeout, failed };

struct Drained {
  std::size_t count = 0;
  bool full = false;  ///< a line's queue was full: edges may be missing
};

/// For one thread at a time.
class EdgeSource {
 public:
  virtual ~EdgeSource() = default;
  /// Returns at the first edge, or after `timeout_ns` (0: at once).
  virtual Wake wait(std::int64_t timeout_ns) noexcept = 0;
  /// Reads the edges that the last wait() announced, in any order between lines; never blocks.
  virtual Drained drain(std::span<Edge, kBatch> into) noexcept = 0;
  /// The present levels; empty when they cannot be read.
  virtual std::optional<Levels> levels() noexcept = 0;
};

}  // namespace hal::encoder
