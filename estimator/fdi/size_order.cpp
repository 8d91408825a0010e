#include "estimator/fdi/size_order.h"

#include <algorithm>
#include <cmath>

namespace estimator::fdi {
namespace {

using Eigen::VectorXd;

constexpr double kSameWay = 0.5;  ///< cosine

/// The classes' places, measured in one covariance.
class Order {
 public:
  Order(const std::vector<TrainedClass>& classes, const std::vector<SizeLaw>& laws,
        const Eigen::MatrixXd& pooled, std::size_t healthy, const std::string& where)
      : classes_(classes), laws_(laws), healthy_(healthy) {
    const std::size_t count = classes.size();
    apart_.setZero(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(count));
    for (std::size_t i = 0; i < count; ++i) {
      Region region = region_of({laws[i].mean, pooled, laws[i].blocks}, where);
      for (std::size_t j = 0; j < count; ++j) {
        const VectorXd& other = laws[j].mean;
        apart_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            std::sqrt(region.distance2({other.data(), static_cast<std::size_t>(other.size())}));
      }
    }
    for (std::size_t i = 0; i < count; ++i) before_.push_back(size_before(i));
  }

  /// Of a class that is not healthy.
  [[nodiscard]] std::size_t before(std::size_t i) const { return before_[i]; }
  /// The bend of the curve from before(i) to i.
  [[nodiscard]] Bend bend(std::size_t i) const {
    const std::size_t from = before_[i];
    const VectorXd none = VectorXd::Zero(laws_[i].mean.size());
    const bool has_before = from != healthy_;
    const std::optional<std::size_t> next = size_after(i);
    Bend bend{none, none};
    if (has_before) bend.from = through(before_[from], from, i, apart(from, i));
    if (next) bend.to = through(from, i, *next, apart(from, i));
    if (!has_before) bend.from = bend.to;
    if (!next) bend.to = bend.from;
    return bend;
  }

 private:
  [[nodiscard]] double apart(std::size_t i, std::size_t j) const {
    return apart_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  [[nodiscard]] VectorXd through(std::size_t a, std::size_t b, std::size_t c, double h) const {
    return bend_of(laws_[a].mean, laws_[b].mean, laws_[c].mean, apart(a, b), apart(b, c), h);
  }
  [[nodiscard]] bool smaller(std::size_t j, std::size_t i) const {
    if (i == healthy_ || j == healthy_ || classes_[i].name != classes_[j].name ||
        classes_[i].direction != classes_[j].direction) {
      return false;
    }
    const double own = apart(healthy_, i);
    const double its = apart(healthy_, j);
    const double cosine = (own * own + its * its - apart(i, j) * apart(i, j)) / (2.0 * own * its);
    return its > 0.0 && its < own && cosine > kSameWay;
  }
  [[nodiscard]] std::size_t size_before(std::size_t i) const {
    std::size_t best = healthy_;
    for (std::size_t j = 0; j < classes_.size(); ++j) {
      if (smaller(j, i) && (best == healthy_ || apart(healthy_, j) > apart(healthy_, best))) {
        best = j;
      }
    }
    return best;
  }
  [[nodiscard]] std::optional<std::size_t> size_after(std::size_t i) const {
    std::optional<std::size_t> best;
    for (std::size_t j = 0; j < classes_.size(); ++j) {
      if (j == healthy_ || before_[j] != i) continue;
      if (!best || apart(healthy_, j) < apart(healthy_, *best)) best = j;
    }
    return best;
  }

  const std::vector<TrainedClass>& classes_;
  const std::vector<SizeLaw>& laws_;
  std::size_t healthy_;
  Eigen::MatrixXd apart_;
  std::vector<std::size_t> before_;  ///< of each: the size before it, or healthy
};

}  // namespace

std::vector<std::optional<SizePath>> join_sizes(const std::vector<TrainedClass>& classes,
                                                const std::vector<SizeLaw>& laws,
                                                const Eigen::MatrixXd& pooled, std::size_t healthy,
                                                double rejection, const std::string& where) {
  const Order order(classes, laws, pooled, healthy, where);
  Region region = region_of(laws[healthy], where);
  const double edge2 = region.limit(rejection);
  std::vector<std::optional<SizePath>> paths(classes.size());
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (i == healthy) continue;
    const std::size_t from = order.before(i);
    SizePath path(laws[from], laws[i], order.bend(i), rejection,
                  from == healthy ? &region : nullptr, edge2, where + ": class " + classes[i].name);
    if (!path.nowhere()) paths[i].emplace(std::move(path));
  }
  return paths;
}

}  // namespace estimator::fdi
