// Chamber pressure errors of the healthy rig.
//
//   p(k) = ph(k) + b + c + e(k)
//
// p ph  measured and modelled pressure of one chamber
// b     learned offset of transducer and model: median of the healthy windows' means
// c     remaining offset of one window, unknown but small: standard deviation S
// e     remainder; its RMS is the chamber's error, above which a window is not healthy
//
// In the fit a chamber has the weight of its error where only the position is fitted. For a right
// model that makes no difference; for an incomplete model pressures do not bias the parameters, and
// they count in every window as they did during learning.
#pragma once

#include "config/schema/visitor.h"
#include "estimator/state_archive.h"

namespace estimator::greybox::tracking {

/// Errors of one chamber.
struct ChamberError {
  double rms_Pa = 0.0;     ///< RMS of e; 0: unknown
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
  /// Keys of the baseline file, all optional.
  void visit(config::schema::Visitor& v);
  /// Bit for bit (state_archive.h).
  void serialize(estimator::StateArchive& archive);
};

/// How far a window is from the model, and by what its residuals are weighed.
struct ErrorScales {
  double rms_m = 0.0;        ///< position
  ChamberErrors chambers{};  ///< not known: the position alone counts
};

// Ratios to the model's supply pressure:
/// Smallest allowed drift of an offset, as a ratio to the model's supply pressure.
inline constexpr double kDrift_ratio = 0.002;
/// The least error that a chamber pressure is taken to have: better than any transducer.
inline constexpr double kLeastError_ratio = 1e-4;
/// Standard deviations s of c: beyond, the readings do not belong to the model.
inline constexpr double kMostOffset = 5.0;

}  // namespace estimator::greybox::tracking
