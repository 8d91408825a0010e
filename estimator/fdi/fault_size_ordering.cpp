#include "estimator/fdi/fault_size_ordering.h"

#include <algorithm>
#include <cmath>

namespace estimator::fdi {
namespace {

using Eigen::VectorXd;

constexpr double kSameDirection = 0.5;  ///< cosine

/// Distances between the classes, in the metric of one covariance.
class FaultSizeOrdering {
 public:
  FaultSizeOrdering(const std::vector<TrainedClass>& classes,
                    const std::vector<ClassDistribution>& distributions,
                    const Eigen::MatrixXd& pooled, std::size_t healthy, const std::string& where)
      : classes_(classes), distributions_(distributions), healthy_(healthy) {
    const std::size_t count = classes.size();
    separation_.setZero(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(count));
    for (std::size_t i = 0; i < count; ++i) {
      HotellingT2 region =
          hotelling_t2({distributions[i].mean, pooled, distributions[i].blocks}, where);
      for (std::size_t j = 0; j < count; ++j) {
        const VectorXd& other = distributions[j].mean;
        separation_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            std::sqrt(region.statistic({other.data(), static_cast<std::size_t>(other.size())}));
      }
    }
    for (std::size_t i = 0; i < count; ++i) smaller_size_.push_back(find_smaller_size(i));
  }

  /// Next smaller size of a faulty class, or healthy.
  [[nodiscard]] std::size_t smaller_size(std::size_t i) const { return smaller_size_[i]; }
  /// Curvature of the trajectory from before(i) to i.
  [[nodiscard]] Curvature curvature_to(std::size_t i) const {
    const std::size_t from = smaller_size_[i];
    const VectorXd none = VectorXd::Zero(distributions_[i].mean.size());
    const bool has_smaller = from != healthy_;
    const std::optional<std::size_t> larger = find_larger_size(i);
    Curvature curvature{none, none};
    if (has_smaller)
      curvature.from = curvature_through(smaller_size_[from], from, i, separation(from, i));
    if (larger) curvature.to = curvature_through(from, i, *larger, separation(from, i));
    if (!has_smaller) curvature.from = curvature.to;
    if (!larger) curvature.to = curvature.from;
    return curvature;
  }

 private:
  [[nodiscard]] double separation(std::size_t i, std::size_t j) const {
    return separation_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  [[nodiscard]] VectorXd curvature_through(std::size_t a, std::size_t b, std::size_t c,
                                           double h) const {
    return curvature_of(distributions_[a].mean, distributions_[b].mean, distributions_[c].mean,
                        separation(a, b), separation(b, c), h);
  }
  [[nodiscard]] bool is_smaller(std::size_t j, std::size_t i) const {
    if (i == healthy_ || j == healthy_ || classes_[i].name != classes_[j].name ||
        classes_[i].direction != classes_[j].direction) {
      return false;
    }
    const double own = separation(healthy_, i);
    const double its = separation(healthy_, j);
    const double cosine =
        (own * own + its * its - separation(i, j) * separation(i, j)) / (2.0 * own * its);
    return its > 0.0 && its < own && cosine > kSameDirection;
  }
  [[nodiscard]] std::size_t find_smaller_size(std::size_t i) const {
    std::size_t best = healthy_;
    for (std::size_t j = 0; j < classes_.size(); ++j) {
      if (is_smaller(j, i) &&
          (best == healthy_ || separation(healthy_, j) > separation(healthy_, best))) {
        best = j;
      }
    }
    return best;
  }
  [[nodiscard]] std::optional<std::size_t> find_larger_size(std::size_t i) const {
    std::optional<std::size_t> best;
    for (std::size_t j = 0; j < classes_.size(); ++j) {
      if (j == healthy_ || smaller_size_[j] != i) continue;
      if (!best || separation(healthy_, j) < separation(healthy_, *best)) best = j;
    }
    return best;
  }

  const std::vector<TrainedClass>& classes_;
  const std::vector<ClassDistribution>& distributions_;
  std::size_t healthy_;
  Eigen::MatrixXd separation_;
  std::vector<std::size_t> smaller_size_;  ///< for each class, or healthy
};

}  // namespace

std::vector<std::optional<FaultTrajectory>> fault_trajectories(
    const std::vector<TrainedClass>& classes, const std::vector<ClassDistribution>& distributions,
    const Eigen::MatrixXd& pooled, std::size_t healthy, double rejection,
    const std::string& where) {
  const FaultSizeOrdering order(classes, distributions, pooled, healthy, where);
  HotellingT2 region = hotelling_t2(distributions[healthy], where);
  const double healthy_limit = region.limit(rejection);
  std::vector<std::optional<FaultTrajectory>> trajectories(classes.size());
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (i == healthy) continue;
    const std::size_t from = order.smaller_size(i);
    FaultTrajectory trajectory(distributions[from], distributions[i], order.curvature_to(i),
                               rejection, from == healthy ? &region : nullptr, healthy_limit,
                               where + ": class " + classes[i].name);
    if (!trajectory.empty()) trajectories[i].emplace(std::move(trajectory));
  }
  return trajectories;
}

}  // namespace estimator::fdi
