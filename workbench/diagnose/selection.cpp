#include "workbench/diagnose/selection.h"

namespace workbench::diagnose {

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

matching::Fitted finished(const Workshop& shop, const matching::Fitted& fitted) {
  return refit(shop, select(fitted, [](const auto&) { return true; }), shop.evidence.fits,
               shop.threads);
}

}  // namespace workbench::diagnose
