#include "estimator/fdi/fault_trajectory.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace estimator::fdi {
namespace {

using Eigen::VectorXd;

constexpr int kPieces = 16;
constexpr int kSteps = 256;  ///< steps of the search for the edge of the healthy region
constexpr double kCurvatureError = 0.25;  ///< standard deviation, as a share of the curvature

std::span<const double> span_of(const VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

}  // namespace

HotellingT2 hotelling_t2(const ClassDistribution& distribution, const std::string& where) {
  return {
      span_of(distribution.mean),
      {distribution.covariance.data(), static_cast<std::size_t>(distribution.covariance.size())},
      distribution.blocks,
      where};
}

VectorXd curvature_of(const VectorXd& a, const VectorXd& b, const VectorXd& c, double ab, double bc,
                      double h) {
  return h * h / (ab + bc) * ((c - b) / bc - (b - a) / ab);
}

FaultTrajectory::FaultTrajectory(const ClassDistribution& from, const ClassDistribution& to,
                                 const Curvature& curvature, double rejection, HotellingT2* healthy,
                                 double healthy_limit, const std::string& where)
    : moved_(static_cast<std::size_t>(from.mean.size())) {
  const auto off_chord = [&](double s) -> VectorXd {
    return s * (1.0 - s) * ((1.0 - s) * curvature.from + s * curvature.to);
  };
  const auto at = [&](double s) -> VectorXd {
    return (1.0 - s) * from.mean + s * to.mean - off_chord(s);
  };
  double begin = 0.0;
  for (int i = 0; healthy != nullptr && i <= kSteps; ++i) {
    const double s = static_cast<double>(i) / kSteps;
    if (healthy->statistic(span_of(at(s))) <= healthy_limit) begin = s + 1.0 / kSteps;
  }
  if (begin >= 1.0) return;
  for (int i = 0; i < kPieces; ++i) {
    const double s0 = begin + (1.0 - begin) * i / kPieces;
    const double s1 = begin + (1.0 - begin) * (i + 1) / kPieces;
    const double middle = 0.5 * (s0 + s1);
    const VectorXd g = kCurvatureError * off_chord(middle);
    const VectorXd first = at(s0);
    const VectorXd last = at(s1);
    HotellingT2 region = hotelling_t2(
        {first, (1.0 - middle) * from.covariance + middle * to.covariance + g * g.transpose(),
         std::min(from.blocks, to.blocks)},
        where);
    const double length_t2 = region.statistic(span_of(last));
    if (i == 0) limit_ = region.limit(rejection);  // equal for all pieces: equal numbers of blocks
    const VectorXd along = last - first;
    pieces_.push_back({std::move(region), {along.data(), along.data() + along.size()}, length_t2});
  }
}

FaultTrajectory::Nearest FaultTrajectory::nearest(std::span<const double> x) noexcept {
  Nearest best{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
               false};
  for (Piece& piece : pieces_) {
    const auto statistic_at = [&](double share) {
      for (std::size_t j = 0; j < moved_.size(); ++j) moved_[j] = x[j] - share * piece.along[j];
      return piece.region.statistic(moved_);
    };
    // T^2 along the piece is a parabola, given by its ends and its curvature, length_t2.
    const double share = piece.length_t2 > 0.0
                             ? 0.5 + 0.5 * (statistic_at(0.0) - statistic_at(1.0)) / piece.length_t2
                             : 0.0;
    const double t2 = statistic_at(std::clamp(share, 0.0, 1.0));
    if (!(t2 < best.t2)) continue;
    best = {t2, piece.region.log_density(), t2 <= limit_};
  }
  return best;
}

namespace {

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
