// Events of encoder lines: edges with their time, and levels.
#pragma once

#include <cstdint>

namespace hal::encoder {

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

}  // namespace hal::encoder
