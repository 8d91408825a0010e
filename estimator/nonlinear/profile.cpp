#include "estimator/nonlinear/profile.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "estimator/nonlinear/linear_model.h"

namespace estimator::nonlinear {
namespace {

constexpr double kCloseEnough = 0.02;  // share of the root of the threshold
constexpr double kFurthest = 4.0;      // growth of the distance from one point to the next
constexpr double kNearest = 1.3;

class Walker {
 public:
  Walker(const Problem& problem, const Solution& solution, Eigen::Index unknown,
         const ProfileOptions& options)
      : problem_(problem), solution_(solution), j_(unknown), options_(options), held_(problem) {
    out_.points.push_back({solution.x[j_], 0.0});
    out_.least_cost = solution.cost;
    out_.least_x = solution.x;
  }

  Profile run() {
    out_.low_found = walk(-1.0, out_.low);
    out_.high_found = walk(1.0, out_.high);
    std::sort(out_.points.begin(), out_.points.end(),
              [](const ProfilePoint& a, const ProfilePoint& b) { return a.value < b.value; });
    return out_;
  }

 private:
  /// Square root of the rise at `value`, negative below the solution's cost.
  double root(double value, Eigen::VectorXd& warm) {
    Unknown& unknown = held_.unknowns[static_cast<std::size_t>(j_)];
    unknown.lower = unknown.upper = value;
    Eigen::VectorXd start = warm;
    start[j_] = value;
    MinimizeOptions minimizing = options_.minimize;
    minimizing.final_jacobian = false;
    const Solution s = minimize(held_, start, minimizing);
    out_.evaluations += s.evaluations;
    if (s.reason == StopReason::cancelled) out_.cancelled = true;
    if (s.cost < out_.least_cost) {
      out_.least_cost = s.cost;
      out_.least_x = s.x;
    }
    if (std::isfinite(s.cost)) warm = s.x;
    const double rise = (s.cost - solution_.cost) / options_.inflation;
    out_.points.push_back({value, rise});
    return rise < 0.0 ? -std::sqrt(-rise) : std::sqrt(rise);
  }

  double first_step() const {
    if (options_.first_step > 0.0) return options_.first_step;
    // Bound on the first step: assumes all other unknowns known.
    const LinearModel model =
        compress(problem_, solution_.x, solution_.residual, solution_.jacobian);
    const double curvature = model.R.col(j_).norm();
    const double step = std::sqrt(options_.threshold * options_.inflation) / curvature;
    const Unknown& unknown = problem_.unknowns[static_cast<std::size_t>(j_)];
    const double range = unknown.upper - unknown.lower;
    if (std::isfinite(step) && !(step > range)) return step;
    return std::isfinite(range) ? 0.25 * range : 1.0;
  }

  bool walk(double side, double& end) {
    const Unknown& unknown = problem_.unknowns[static_cast<std::size_t>(j_)];
    const double centre = solution_.x[j_];
    const double room = side > 0.0 ? unknown.upper - centre : centre - unknown.lower;
    const double goal = std::sqrt(options_.threshold);
    end = centre + side * room;
    if (!(room > 0.0)) return false;
    double inside = 0.0;
    double inside_root = 0.0;
    double outside = -1.0;
    double outside_root = 0.0;
    int last = 0;
    double distance = std::min(first_step(), room);
    Eigen::VectorXd warm = solution_.x;
    for (int k = 0; k < options_.max_points && !out_.cancelled; ++k) {
      const double z = root(centre + side * distance, warm);
      if (std::abs(z - goal) < kCloseEnough * goal) {
        end = centre + side * distance;
        return true;
      }
      const int now = z < goal ? -1 : 1;
      const bool same = now == last;  // the same end moved twice: halve the step
      last = now;
      if (z < goal) {
        inside = distance;
        inside_root = z;
        if (outside < 0.0) {
          if (distance >= room) return false;
          const double growth = z > 0.0 ? 1.1 * goal / z : kFurthest;
          distance = std::min(room, distance * std::clamp(growth, kNearest, kFurthest));
          continue;
        }
      } else {
        outside = distance;
        outside_root = z;
      }
      const double part = std::isfinite(outside_root) && !same
                              ? (goal - inside_root) / (outside_root - inside_root)
                              : 0.5;
      distance = inside + std::clamp(part, 0.1, 0.9) * (outside - inside);
    }
    if (outside > 0.0) {
      end = centre + side * distance;
      return true;
    }
    end = centre + side * inside;
    return false;
  }

  const Problem& problem_;
  const Solution& solution_;
  Eigen::Index j_;
  const ProfileOptions& options_;
  Problem held_;
  Profile out_;
};

}  // namespace

Profile profile(const Problem& problem, const Solution& solution, Eigen::Index unknown,
                const ProfileOptions& options) {
  assert(unknown >= 0 && unknown < problem.size() && options.inflation > 0.0);
  return Walker(problem, solution, unknown, options).run();
}

}  // namespace estimator::nonlinear
