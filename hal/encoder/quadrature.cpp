#include "hal/encoder/quadrature.h"

namespace hal::encoder {
namespace {

int phase_of(Levels levels) noexcept {
  if (levels.b) return levels.a ? 2 : 3;
  return levels.a ? 1 : 0;
}

std::int64_t floor_div(std::int64_t value, std::int64_t divisor) noexcept {
  const std::int64_t rest = ((value % divisor) + divisor) % divisor;
  return (value - rest) / divisor;
}

}  // namespace

QuadratureDecoder::QuadratureDecoder(Levels levels) noexcept
    : levels_(levels), quarters_(phase_of(levels)), origin_(quarters_) {}

void QuadratureDecoder::edge(const Edge& edge) noexcept {
  if (edge.line == EncoderLine::index) {
    const bool lower_flank = direction_ < 0 ? !edge.level : edge.level;
    if (lower_flank) capture();
    return;
  }
  Levels next = levels_;
  (edge.line == EncoderLine::a ? next.a : next.b) = edge.level;
  if (next == levels_) {
    ++illegal_;
    lost_ = true;
    return;
  }
  move_to(next);
}

void QuadratureDecoder::move_to(Levels levels) noexcept {
  const int step = (phase_of(levels) - phase_of(levels_)) & 3;
  levels_ = levels;
  direction_ = step == 1 ? 1 : -1;
  quarters_ += direction_;
}

void QuadratureDecoder::resync(Levels levels) noexcept {
  lost_ = true;
  if (levels.a != levels_.a && levels.b != levels_.b) {
    levels_ = levels;
    quarters_ += 2;  // direction unknown; the phase stays right
  } else if (!(levels == levels_)) {
    move_to(levels);
  }
}

void QuadratureDecoder::refer() noexcept {
  origin_ = quarters_;
  lost_ = false;
}

void QuadratureDecoder::capture() noexcept {
  const std::int64_t slip = quarters_ - origin_;
  const bool first = captures_ == 0;
  if (first || slip > 1 || slip < -1) origin_ = quarters_;
  if (!first && (slip > 1 || slip < -1)) ++slips_;
  ++captures_;
  lost_ = false;
}

std::int64_t QuadratureDecoder::counts(int per_cycle) const noexcept {
  const std::int64_t divisor = 4 / per_cycle;
  return floor_div(quarters_, divisor) - floor_div(origin_, divisor);
}

}  // namespace hal::encoder
