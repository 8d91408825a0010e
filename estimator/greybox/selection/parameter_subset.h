// Some of a fitted model's parameters, to be fitted again without the others.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "estimator/greybox/fit.h"
#include "estimator/greybox/selection/problem.h"

namespace estimator::greybox::selection {

struct Selection {
  std::vector<SearchParameter> searched;
  Eigen::VectorXd start;
};

[[nodiscard]] inline bool belongs(const SearchParameter& parameter, const std::string& effect) {
  return parameter.name.rfind(effect + ".", 0) == 0;
}

/// The parameters for which keep(parameter) holds, starting where they are.
template <class Keep>
[[nodiscard]] Selection select(const Fitted& fitted, const Keep& keep) {
  Selection result;
  std::vector<double> values;
  for (std::size_t i = 0; i < fitted.searched.size(); ++i) {
    if (!keep(fitted.searched[i])) continue;
    result.searched.push_back(fitted.searched[i]);
    values.push_back(fitted.x[static_cast<Eigen::Index>(i)]);
  }
  result.start =
      Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  return result;
}

void append(Selection& to, const Selection& more);

/// Fitted to the end on the samples that `weights` counts. `threads` is 1 within in_parallel.
[[nodiscard]] Fitted refit(const Workshop& shop, const Selection& selection,
                           const Eigen::VectorXd& weights, unsigned threads = 1,
                           double observer_per_s = kObserver_per_s);
/// On the samples that fit, but given up, as far as it came, when after a few iterations it is
/// still several times `than_m`, with which it is to be compared, or comes too slowly to get there.
[[nodiscard]] Fitted refit_if_hopeful(const Workshop& shop, const Selection& selection,
                                      double than_m, unsigned threads = 1);
/// A stage's fit, to the end, on all of the workshop's threads.
[[nodiscard]] Fitted finished(const Workshop& shop, const Fitted& fitted);

}  // namespace estimator::greybox::selection
