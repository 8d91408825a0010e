#include "workbench/diagnose/selection.h"

namespace workbench::diagnose {

void append(Selection& to, const Selection& more) {
  Eigen::VectorXd start(to.start.size() + more.start.size());
  start << to.start, more.start;
  to.start = std::move(start);
  to.searched.insert(to.searched.end(), more.searched.begin(), more.searched.end());
}

matching::Fitted refit(const Workshop& shop, const Selection& selection,
                       const Eigen::VectorXd& weights, double observer_per_s) {
  matching::FitOptions options;
  options.tolerance = 1e-5;
  options.observer_per_s = observer_per_s;
  options.cancel = shop.cancel;
  return matching::fit(shop.model, shop.evidence, weights, selection.searched, selection.start,
                       options);
}

}  // namespace workbench::diagnose
