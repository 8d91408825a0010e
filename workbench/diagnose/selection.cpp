#include "workbench/diagnose/selection.h"

namespace workbench::diagnose {
namespace {

/// What after so many iterations is still that much worse will not come near.
constexpr int kFirstIterations = 8;
constexpr double kHopeless = 3.0;

}  // namespace

void append(Selection& to, const Selection& more) {
  Eigen::VectorXd start(to.start.size() + more.start.size());
  start << to.start, more.start;
  to.start = std::move(start);
  to.searched.insert(to.searched.end(), more.searched.begin(), more.searched.end());
}

matching::Fitted refit(const Workshop& shop, const Selection& selection,
                       const Eigen::VectorXd& weights, unsigned threads, double observer_per_s) {
  matching::FitOptions options;
  options.threads = threads;
  options.tolerance = 1e-5;
  options.observer_per_s = observer_per_s;
  options.cancel = shop.cancel;
  return matching::fit(shop.model, shop.evidence, weights, selection.searched, selection.start,
                       options);
}

matching::Fitted refit_if_hopeful(const Workshop& shop, const Selection& selection, double than_m,
                                  unsigned threads) {
  matching::FitOptions begin;
  begin.threads = threads;
  begin.max_iterations = kFirstIterations;
  begin.final_jacobian = false;
  begin.cancel = shop.cancel;
  matching::Fitted begun = matching::fit(shop.model, shop.evidence, shop.evidence.fits,
                                         selection.searched, selection.start, begin);
  if (begun.score_rms_m > kHopeless * than_m) return begun;
  return refit(shop, {selection.searched, begun.x}, shop.evidence.fits, threads);
}

matching::Fitted finished(const Workshop& shop, const matching::Fitted& fitted) {
  return refit(shop, select(fitted, [](const auto&) { return true; }), shop.evidence.fits,
               shop.threads);
}

}  // namespace workbench::diagnose
