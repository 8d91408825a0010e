#include "estimator/greybox/parallel_simulation.h"

#include <algorithm>
#include <thread>

namespace estimator::greybox {

WideRun::WideRun(const plant_sim::ModelFile& model, const Evidence& evidence,
                 const std::vector<SearchParameter>& searched, double observer_per_s,
                 unsigned threads) {
  for (unsigned i = 0; i < std::max(1U, threads); ++i) {
    runs_.emplace_back(model, evidence, searched, observer_per_s);
  }
}

Eigen::Index WideRun::lanes() const {
  return ModelRun::kLanes * static_cast<Eigen::Index>(runs_.size());
}

void WideRun::residuals(const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m) {
  if (points.cols() <= ModelRun::kLanes) {
    runs_.front().residuals(points, residuals_m);
    return;
  }
  const auto groups = static_cast<std::size_t>((points.cols() - 1) / ModelRun::kLanes + 1);
  std::vector<Eigen::MatrixXd> parts(groups);
  const auto group = [&](std::size_t g) {
    const Eigen::Index first = static_cast<Eigen::Index>(g) * ModelRun::kLanes;
    const Eigen::Index count = std::min(ModelRun::kLanes, points.cols() - first);
    runs_[g].residuals(points.middleCols(first, count), parts[g]);
  };
  {
    std::vector<std::jthread> helpers;
    for (std::size_t g = 1; g < groups; ++g) helpers.emplace_back(group, g);
    group(0);
  }
  residuals_m.resize(parts.front().rows(), points.cols());
  Eigen::Index at = 0;
  for (const Eigen::MatrixXd& part : parts) {
    residuals_m.middleCols(at, part.cols()) = part;
    at += part.cols();
  }
}

estimator::nonlinear::Evaluate WideRun::evaluate() {
  return [this](const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m) {
    residuals(points, residuals_m);
  };
}

}  // namespace estimator::greybox
