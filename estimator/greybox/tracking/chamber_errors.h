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
  double weight_Pa = 0.0;  ///< sigma of the fit when the position has its healthy error
};

struct ChamberErrors {
  ChamberError in;
  ChamberError out;
  double offset_sd_Pa = 0.0;  ///< S, of both chambers

  /// False: pressures are not used.
  [[nodiscard]] bool known() const noexcept {
    return in.rms_Pa > 0.0 && out.rms_Pa > 0.0 && in.weight_Pa > 0.0 && out.weight_Pa > 0.0;
  }
  /// Keys of the baseline file, all optional.
  void visit(config::schema::Visitor& v);
  /// Bit-exact (state_archive.h).
  void serialize(estimator::StateArchive& archive);
};

/// Healthy errors that weight a window's residuals.
struct ErrorScales {
  double rms_m = 0.0;        ///< position
  ChamberErrors chambers{};  ///< unknown: the position alone counts
};

// Ratios to the model's supply pressure:
/// Smallest allowed drift of an offset, as a ratio to the model's supply pressure.
inline constexpr double kDrift_ratio = 0.002;
/// Least assumed error of a chamber pressure: below any transducer's.
inline constexpr double kLeastError_ratio = 1e-4;
/// Limit of c in standard deviations S, above which the readings do not fit the model.
inline constexpr double kMostOffset = 5.0;

}  // namespace estimator::greybox::tracking
