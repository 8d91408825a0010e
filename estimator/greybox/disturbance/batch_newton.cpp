#include "estimator/greybox/disturbance/batch_newton.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstddef>
#include <span>

namespace estimator::greybox::disturbance {
namespace {

using Eigen::Index;
using Matrix = Eigen::Matrix4d;

constexpr Index kSize = SearchPoint::RowsAtCompileTime;
constexpr int kMostSteps = 12;
constexpr double kLongestStep = 1.5;
/// Added to the curvatures, over the greatest of them.
constexpr double kDampings[] = {0.0, 1e-3, 1e-2, 0.05, 0.2, 1.0, 10.0, 100.0};

struct Quadratic {
  SearchPoint slope;
  Matrix curvature;
};

using Points = std::vector<SearchPoint>;
using Values = std::span<const double>;

Points along(const SearchPoint& centre) {
  Points points;
  for (Index i = 0; i < kSize; ++i) {
    points.push_back(centre + kDifference * SearchPoint::Unit(i));
    points.push_back(centre - kDifference * SearchPoint::Unit(i));
  }
  return points;
}

Points between(const SearchPoint& centre) {
  Points points;
  for (Index i = 0; i < kSize; ++i) {
    for (Index j = 0; j < i; ++j) {
      points.push_back(centre + kDifference * (SearchPoint::Unit(i) + SearchPoint::Unit(j)));
    }
  }
  return points;
}

/// Slopes, and curvatures along the coordinates; those between two of them are kept.
void set_along(Values values, double centre, Quadratic& local) {
  for (Index i = 0; i < kSize; ++i) {
    const double above = values[static_cast<std::size_t>(2 * i)];
    const double below = values[static_cast<std::size_t>(2 * i + 1)];
    local.slope[i] = (above - below) / (2.0 * kDifference);
    local.curvature(i, i) = (above - 2.0 * centre + below) / (kDifference * kDifference);
  }
}

/// Curvatures between two coordinates, from those along them.
void set_between(Values values, double centre, Quadratic& local) {
  const auto on_axis = [&](Index i) {
    return kDifference * (local.slope[i] + 0.5 * kDifference * local.curvature(i, i));
  };
  std::size_t next = 0;
  for (Index i = 0; i < kSize; ++i) {
    for (Index j = 0; j < i; ++j) {
      local.curvature(i, j) = local.curvature(j, i) =
          (values[next++] - centre - on_axis(i) - on_axis(j)) / (kDifference * kDifference);
    }
  }
}

void append_to(Points& points, const Points& more) {
  points.insert(points.end(), more.begin(), more.end());
}

/// Without the coordinates that a bound keeps from descending.
Quadratic free_of_bounds(const SearchPoint& at, const SearchBounds& bounds, Quadratic local) {
  for (Index i = 0; i < kSize; ++i) {
    const bool held = (at[i] <= bounds.lower[i] && local.slope[i] > 0.0) ||
                      (at[i] >= bounds.upper[i] && local.slope[i] < 0.0);
    if (!held) continue;
    local.slope[i] = 0.0;
    local.curvature.row(i).setZero();
    local.curvature.col(i).setZero();
  }
  return local;
}

/// Steps downhill, one per damping; curvatures count by their size.
std::vector<SearchPoint> damped_steps(const Quadratic& local) {
  const Eigen::SelfAdjointEigenSolver<Matrix> axes(local.curvature);
  const SearchPoint sizes = axes.eigenvalues().cwiseAbs();
  const SearchPoint along = axes.eigenvectors().transpose() * local.slope;
  std::vector<SearchPoint> steps;
  for (const double damping : kDampings) {
    const SearchPoint stiffness = sizes.array() + damping * sizes.maxCoeff() + 1e-12;
    SearchPoint step = -axes.eigenvectors() * along.cwiseQuotient(stiffness);
    const double longest = step.cwiseAbs().maxCoeff();
    if (longest > kLongestStep) step *= kLongestStep / longest;
    steps.push_back(step);
  }
  return steps;
}

}  // namespace

Minimum minimise(const BatchFunction& function, const Minimum& start, const SearchBounds& bounds,
                 double enough, Lookahead lookahead) {
  constexpr std::size_t kAlong = 2 * kSize;
  Minimum best = start;
  Quadratic local;
  int known = -1;             ///< step for which the curvatures between coordinates were found
  std::vector<double> ahead;  ///< values along the coordinates about `best`; empty: not known
  for (int i = 0; i < kMostSteps; ++i) {
    Points about = along(best.at);
    if (known < 0) append_to(about, between(best.at));
    if (known < 0 || ahead.empty()) ahead = function(about);
    set_along(Values(ahead).first(kAlong), best.value, local);
    if (known < 0) set_between(Values(ahead).subspan(kAlong), best.value, local);
    if (known < 0) known = i;
    ahead.clear();
    const Quadratic free = free_of_bounds(best.at, bounds, local);
    Points points = damped_steps(free);
    const std::size_t steps = points.size();
    if (known == i && !(-free.slope.dot(points.front()) > enough)) break;
    for (SearchPoint& point : points) {
      point = (best.at + point).cwiseMax(bounds.lower).cwiseMin(bounds.upper);
    }
    // the step without damping is the likeliest to be taken
    if (lookahead == Lookahead::yes) append_to(points, along(points.front()));
    const std::vector<double> values = function(points);
    const auto least =
        std::min_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(steps));
    const double gained = best.value - *least;
    if (gained > 0.0) {
      best = {points[static_cast<std::size_t>(least - values.begin())], *least};
      if (least == values.begin()) {
        ahead.assign(values.begin() + static_cast<std::ptrdiff_t>(steps), values.end());
      }
    }
    if (gained > enough) continue;
    if (known == i) break;
    known = -1;  // curvatures of another place may have misled it
  }
  return best;
}

}  // namespace estimator::greybox::disturbance
