// Quadrature: edges of lines A and B in, position in quarters of a cycle out.
//
// With A leading B when the position grows, (A, B) runs through (0,0) (1,0) (1,1) (0,1): phases 0
// to 3. Each edge moves to a neighbouring phase, one quarter up or down. An edge to the level that
// the line already has is illegal: at least one edge of that line is missing. x1, x2 and x4 divide
// the same quarters by 4, 2 and 1 rounding down, so that a rod that dithers on an edge does not
// make the count creep.
//
// The index pulse sets the origin at its edge on the retracted side: rising on the way up, falling
// on the way down. That edge may coincide with one of A or B: one quarter apart is no difference.
#pragma once

#include <cstdint>

#include "hal/encoder/edge_source.h"

namespace hal::encoder {

/// Cheap to copy: a few words.
class QuadratureDecoder {
 public:
  explicit QuadratureDecoder(Levels levels = {}) noexcept;

  /// Edges in order of time.
  void edge(const Edge& edge) noexcept;
  /// Adopts levels that contradict the decoder's; moves one quarter where that is unambiguous.
  void resync(Levels levels) noexcept;
  /// Marks edges as missing: the count is uncertain until the next index or refer().
  void mark_lost() noexcept { lost_ = true; }
  /// Makes the present position the origin, and certain.
  void refer() noexcept;

  /// Counts from the origin; `per_cycle`: 1, 2 or 4.
  [[nodiscard]] std::int64_t counts(int per_cycle) const noexcept;
  [[nodiscard]] Levels levels() const noexcept { return levels_; }
  [[nodiscard]] int direction() const noexcept { return direction_; }  ///< sign of the last move
  [[nodiscard]] bool lost() const noexcept { return lost_; }
  [[nodiscard]] std::int64_t illegal() const noexcept { return illegal_; }
  [[nodiscard]] std::int64_t captures() const noexcept { return captures_; }  ///< index pulses
  /// Index pulses at another position than the first: edges were missed in between.
  [[nodiscard]] std::int64_t slips() const noexcept { return slips_; }

 private:
  void move_to(Levels levels) noexcept;
  void capture() noexcept;

  Levels levels_;
  bool lost_ = false;
  int direction_ = 0;
  std::int64_t quarters_;  ///< the lowest two bits are the phase
  std::int64_t origin_;
  std::int64_t illegal_ = 0;
  std::int64_t captures_ = 0;
  std::int64_t slips_ = 0;
};

}  // namespace hal::encoder
