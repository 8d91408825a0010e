#include "estimator/greybox/selection/parameter_subset.h"

#include <limits>

namespace estimator::greybox::selection {
namespace {

/// Looked at every so many iterations.
constexpr int kStride = 8;
/// What then is still that much worse will not come near; the first time, that much.
constexpr double kHopeless = 3.0;
constexpr double kHopelessAtFirst = 10.0;
/// This much worse is near.
constexpr double kNear = 1.1;
/// The way that is left must not be longer than so many strides like the last one.
constexpr double kPatience = 4.0;
constexpr int kMostStrides = 8;

}  // namespace

void append(Selection& to, const Selection& more) {
  Eigen::VectorXd start(to.start.size() + more.start.size());
  start << to.start, more.start;
  to.start = std::move(start);
  to.searched.insert(to.searched.end(), more.searched.begin(), more.searched.end());
}

Fitted refit(const Workshop& shop, const Selection& selection, const Eigen::VectorXd& weights,
             unsigned threads, double observer_per_s) {
  FitOptions options;
  options.threads = threads;
  options.tolerance = 1e-5;
  options.observer_per_s = observer_per_s;
  options.cancel = shop.cancel;
  return fit(shop.model, shop.evidence, weights, selection.searched, selection.start, options);
}

Fitted refit_if_hopeful(const Workshop& shop, const Selection& selection, double than_m,
                        unsigned threads) {
  FitOptions stride;
  stride.threads = threads;
  stride.max_iterations = kStride;
  stride.passes = 1;
  stride.final_jacobian = false;
  stride.cancel = shop.cancel;
  Fitted at;
  at.x = selection.start;
  double before_m = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kMostStrides; ++k) {
    at = fit(shop.model, shop.evidence, shop.evidence.fits, selection.searched, at.x, stride);
    const double left_m = at.score_rms_m - kNear * than_m;
    if (left_m <= 0.0) break;
    const double hopeless = k == 0 ? kHopelessAtFirst : kHopeless;
    if (at.score_rms_m > hopeless * than_m || left_m > kPatience * (before_m - at.score_rms_m)) {
      return at;
    }
    before_m = at.score_rms_m;
    stride.start_residual_m = at.residual_m;
    stride.start_jacobian = at.jacobian;
  }
  return refit(shop, {selection.searched, at.x}, shop.evidence.fits, threads);
}

Fitted finished(const Workshop& shop, const Fitted& fitted) {
  return refit(shop, select(fitted, [](const auto&) { return true; }), shop.evidence.fits,
               shop.threads);
}

}  // namespace estimator::greybox::selection
