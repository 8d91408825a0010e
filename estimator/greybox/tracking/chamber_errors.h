// What is known of the rig's chamber pressures when it is healthy: how far a window's readings are
// from the model.
//
//   p(k) = ph(k) + b + c + e(k)
//
// p ph  measured and modelled pressure of one chamber
// b     learnt offset of the transducer (and of the model): the median of healthy windows' means
// c     what is left of it in one window, unknown but small: its standard deviation is s
// e     the rest; its RMS is the chamber's error, beyond which a window is not the healthy rig's
//
// In the fit a chamber has the weight of its error where the position alone is fitted. Where the
// model is right that is the same; where it lacks something, pressures do not draw the parameters
// away from what the position says, and they count in every window as they did when it was learnt.
#pragma once

#include "config/schema/visitor.h"
#include "estimator/state_archive.h"

namespace estimator::greybox::tracking {

/// Of one chamber.
struct ChamberError {
  double rms_Pa = 0.0;     ///< of e; 0: not known
  double offset_Pa = 0.0;  ///< b
  double weight_Pa = 0.0;  ///< sigma of the fit where the position's is its healthy error
};

struct ChamberErrors {
  ChamberError in;
  ChamberError out;
  double offset_sd_Pa = 0.0;  ///< s, of either

  /// Otherwise pressures are not used.
  [[nodiscard]] bool known() const noexcept {
    return in.rms_Pa > 0.0 && out.rms_Pa > 0.0 && in.weight_Pa > 0.0 && out.weight_Pa > 0.0;
  }
  /// Keys of what is healthy, all optional.
  void visit(config::schema::Visitor& v);
  /// Bit for bit (state_archive.h).
  void serialize(estimator::StateArchive& archive);
};

/// How far a window is from the model, and by what its residuals are weighed.
struct ErrorScales {
  double rms_m = 0.0;        ///< of the position
  ChamberErrors chambers{};  ///< not known: the position alone counts
};

// Of the model's supply pressure:
/// How far an offset may be off what was learnt, at the least.
inline constexpr double kDrift_ratio = 0.002;
/// The least error that a chamber pressure is taken to have: better than any transducer.
inline constexpr double kLeastError_ratio = 1e-4;
/// Standard deviations s of c: beyond, the readings do not belong to the model.
inline constexpr double kMostOffset = 5.0;

}  // namespace estimator::greybox::tracking
