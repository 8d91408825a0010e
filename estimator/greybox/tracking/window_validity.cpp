#include "estimator/greybox/tracking/window_validity.h"

#include <algorithm>
#include <cmath>

namespace estimator::greybox::tracking {
namespace {

using Eigen::Index;

/// Cosine above which another parameter is named as the one that hides an estimate.
constexpr double kAlike = 0.98;

/// Index of the parameter whose effect resembles that of `at` most; -1: there is no other.
Index most_alike(const Eigen::MatrixXd& likeness, Index at) {
  Index best = -1;
  for (Index j = 0; j < likeness.cols(); ++j) {
    if (j == at) continue;
    if (best < 0 || std::abs(likeness(at, j)) > std::abs(likeness(at, best))) best = j;
  }
  return best;
}

/// Error and offset of one chamber, as ratios to their limits.
struct Excess {
  double error = 0.0;
  double offset = 0.0;

  [[nodiscard]] double most() const { return std::max(error, offset); }
};

Excess excess(const ChamberFit& found, const ChamberError& baseline, double offset_sd_Pa,
              double most_ratio) {
  return {found.rms_Pa / (most_ratio * baseline.rms_Pa),
          std::abs(found.mean_Pa) / (kMostOffset * offset_sd_Pa)};
}

Misfit chamber_misfit(bool inlet, const Excess& by, const ChamberFit& found,
                      const ChamberError& baseline, double offset_sd_Pa, double most_ratio) {
  if (by.error >= by.offset) {
    return {Misfit::Cause::pressure_error, inlet, found.rms_Pa, baseline.rms_Pa, most_ratio};
  }
  return {Misfit::Cause::pressure_offset, inlet, found.mean_Pa, 0.0, kMostOffset * offset_sd_Pa};
}

}  // namespace

Misfit misfit_of(const WindowFitSummary& found, const ErrorScales& baseline, double most_ratio) {
  if (found.rms_m > most_ratio * baseline.rms_m) {
    return {Misfit::Cause::position, false, found.rms_m, baseline.rms_m, most_ratio};
  }
  if (!found.with_chambers()) return {};
  const ChamberErrors& chambers = baseline.chambers;
  const double sd_Pa = chambers.offset_sd_Pa;
  const Excess in = excess(found.in, chambers.in, sd_Pa, most_ratio);
  const Excess out = excess(found.out, chambers.out, sd_Pa, most_ratio);
  if (in.most() <= 1.0 && out.most() <= 1.0) return {};
  return in.most() >= out.most()
             ? chamber_misfit(true, in, found.in, chambers.in, sd_Pa, most_ratio)
             : chamber_misfit(false, out, found.out, chambers.out, sd_Pa, most_ratio);
}

InvalidReason imprecision_of(const WindowFitSummary& found, std::size_t i, double std_error,
                             double most) {
  InvalidReason out;
  out.parameter = i;
  out.std_error = std_error;
  if (found.at_bound[i] != 0) {
    out.cause = InvalidReason::Cause::at_bound;
    return out;
  }
  if (std_error <= most) return {};
  const auto at = static_cast<Index>(i);
  const Index partner = most_alike(found.likeness, at);
  if (partner < 0 || !(std::abs(found.likeness(at, partner)) > kAlike)) {
    out.cause = InvalidReason::Cause::not_excited;
    return out;
  }
  out.cause = InvalidReason::Cause::not_separable;
  out.partner = static_cast<std::size_t>(partner);
  out.likeness = std::abs(found.likeness(at, partner));
  return out;
}

}  // namespace estimator::greybox::tracking
