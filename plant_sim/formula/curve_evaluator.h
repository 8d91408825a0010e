// A curve effect evaluated from its table, for double and for SIMD lanes: of a formula with a term
// for each piece, only the pieces in which a lane is are found.
#pragma once

#include <cstddef>
#include <vector>

#include "plant_sim/formula/signals.h"
#include "plant_sim/scalar.h"

namespace plant_sim::formula {

/// A curve (curve_effect.h) as plain pointers: code that is compiled once per instruction set
/// shares no function with the rest of the program (lane_ensemble.h).
struct CurveView {
  const double* x = nullptr;  ///< ascending
  std::size_t points = 0;     ///< 0: the effect is a formula
  Signal over = kSignals;
  Signal times = kSignals;  ///< kSignals: none
  Signal plus = kSignals;   ///< that of a chained site; kSignals: none
};

/// Weights of the differences of f before and after a point in the slope of the curve there, for
/// the code of S.
struct SlopeWeights {
  double before = 0.0;
  double after = 0.0;
};
template <class S>
[[nodiscard]] SlopeWeights slope_weights(const double* x, std::size_t points, std::size_t i) {
  if (i == 0) return {0.0, 1.0 / (x[1] - x[0])};
  const double before = x[i] - x[i - 1];
  if (i + 1 == points) return {1.0 / before, 0.0};
  const double after = x[i + 1] - x[i];
  const double both = before + after;
  return {after / (before * both), before / (after * both)};
}

/// Evaluates a curve; owns its coefficients. The table must outlive it. No allocation after
/// construction.
template <class S>
class CurveEvaluator {
 public:
  explicit CurveEvaluator(const CurveView& curve)
      : curve_(curve), pieces_(curve.points < 2 ? 0 : curve.points - 1) {}

  /// `f`: the values at the points.
  void set_values(const S* f) {
    const double* const x = curve_.x;
    const auto slope = [&](std::size_t i) {
      const SlopeWeights weights = slope_weights<S>(x, curve_.points, i);
      S sum = 0.0;
      if (i > 0) sum += S(weights.before) * (f[i] - f[i - 1]);
      if (i + 1 < curve_.points) sum += S(weights.after) * (f[i + 1] - f[i]);
      return sum;
    };
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const double way = x[i + 1] - x[i];
      const S d = f[i + 1] - f[i];
      const S g = S(way) * slope(i);
      const S e = S(way) * slope(i + 1);
      pieces_[i] = {f[i], g, S(3.0) * d - S(2.0) * g - e, g + e - S(2.0) * d};
    }
  }

  [[nodiscard]] S operator()(const Signals<S>& at) const {
    const double* const x = curve_.x;
    const S place = clamp(at[curve_.over], S(x[0]), S(x[curve_.points - 1]));
    const double last = reduce_max(place);
    std::size_t i = 0;
    for (const double first = -reduce_max(-place); i + 1 < pieces_.size() && x[i + 1] <= first;)
      ++i;
    S value = piece(i, place);
    while (++i < pieces_.size() && x[i] <= last)
      value = select(place >= S(x[i]), piece(i, place), value);
    if (curve_.times != kSignals) value = at[curve_.times] * value;
    return curve_.plus == kSignals ? value : at[curve_.plus] + value;
  }

 private:
  struct Piece {
    S value, slope, square, cube;
  };

  [[nodiscard]] S piece(std::size_t i, const S& place) const {
    const Piece& p = pieces_[i];
    const S t = (place - S(curve_.x[i])) * S(1.0 / (curve_.x[i + 1] - curve_.x[i]));
    return p.value + t * (p.slope + t * (p.square + t * p.cube));
  }

  CurveView curve_;
  std::vector<Piece> pieces_;
};

}  // namespace plant_sim::formula
