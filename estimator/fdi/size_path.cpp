#include "estimator/fdi/size_path.h"

#include <algorithm>
#include <limits>

namespace estimator::fdi {
namespace {

using Eigen::VectorXd;

constexpr int kPieces = 16;
constexpr int kSteps = 256;       ///< in which the edge of the healthy region is looked for
constexpr double kOfBend = 0.25;  ///< of the bend: its standard deviation

std::span<const double> span_of(const VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

}  // namespace

Region region_of(const SizeLaw& law, const std::string& where) {
  return {span_of(law.mean),
          {law.covariance.data(), static_cast<std::size_t>(law.covariance.size())},
          law.blocks,
          where};
}

VectorXd bend_of(const VectorXd& a, const VectorXd& b, const VectorXd& c, double ab, double bc,
                 double h) {
  return h * h / (ab + bc) * ((c - b) / bc - (b - a) / ab);
}

SizePath::SizePath(const SizeLaw& from, const SizeLaw& to, const Bend& bend, double rejection,
                   Region* healthy, double edge2, const std::string& where)
    : moved_(static_cast<std::size_t>(from.mean.size())) {
  const auto off_chord = [&](double s) -> VectorXd {
    return s * (1.0 - s) * ((1.0 - s) * bend.from + s * bend.to);
  };
  const auto at = [&](double s) -> VectorXd {
    return (1.0 - s) * from.mean + s * to.mean - off_chord(s);
  };
  double begin = 0.0;
  for (int i = 0; healthy != nullptr && i <= kSteps; ++i) {
    const double s = static_cast<double>(i) / kSteps;
    if (healthy->distance2(span_of(at(s))) <= edge2) begin = s + 1.0 / kSteps;
  }
  if (begin >= 1.0) return;
  for (int i = 0; i < kPieces; ++i) {
    const double s0 = begin + (1.0 - begin) * i / kPieces;
    const double s1 = begin + (1.0 - begin) * (i + 1) / kPieces;
    const double middle = 0.5 * (s0 + s1);
    const VectorXd g = kOfBend * off_chord(middle);
    const VectorXd first = at(s0);
    const VectorXd last = at(s1);
    Region region = region_of(
        {first, (1.0 - middle) * from.covariance + middle * to.covariance + g * g.transpose(),
         std::min(from.blocks, to.blocks)},
        where);
    const double length2 = region.distance2(span_of(last));
    if (i == 0) limit_ = region.limit(rejection);  // all are of as many blocks
    const VectorXd along = last - first;
    pieces_.push_back({std::move(region), {along.data(), along.data() + along.size()}, length2});
  }
}

SizePath::Nearest SizePath::nearest(std::span<const double> x) noexcept {
  Nearest best{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
               false};
  for (Piece& piece : pieces_) {
    const auto distance2_from = [&](double share) {
      for (std::size_t j = 0; j < moved_.size(); ++j) moved_[j] = x[j] - share * piece.along[j];
      return piece.region.distance2(moved_);
    };
    // T^2 along the piece is a parabola: known by its ends and its curvature, length2.
    const double share =
        piece.length2 > 0.0
            ? 0.5 + 0.5 * (distance2_from(0.0) - distance2_from(1.0)) / piece.length2
            : 0.0;
    const double distance2 = distance2_from(std::clamp(share, 0.0, 1.0));
    if (!(distance2 < best.distance2)) continue;
    best = {distance2, piece.region.log_density(), distance2 <= limit_};
  }
  return best;
}

}  // namespace estimator::fdi
