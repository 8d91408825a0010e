#include "estimator/fdi/fault_trajectory.h"

#include <algorithm>
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

}  // namespace estimator::fdi
