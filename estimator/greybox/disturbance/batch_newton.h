// Minimum of a smooth function whose values at eight points cost hardly more than one: Newton's
// method with curvatures from differences, its steps tried with eight dampings side by side.
// Source: J. Nocedal and S. Wright, Numerical Optimization (2006), chapters 3, 4 and 8.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace estimator::greybox::disturbance {

/// A point of the search, its coordinates alike in scale: a step of one changes much.
using SearchPoint = Eigen::Vector4d;

struct SearchBounds {
  SearchPoint lower, upper;
};

struct Minimum {
  SearchPoint at;
  double value = 0.0;
};

/// Values at points, of which eight at a time cost hardly more than one; also outside the bounds by
/// kDifference.
using BatchFunction = std::function<std::vector<double>(const std::vector<SearchPoint>&)>;

/// Half the distance over which differences are taken.
inline constexpr double kDifference = 0.1;

/// A search that looks ahead asks for the values about the likeliest step together with the step's:
/// it comes to the same minimum in fewer calls with more points, some of which it may not need.
enum class Lookahead { no, yes };

/// From `start`, within the bounds; ends where a step gains less than `enough`.
[[nodiscard]] Minimum minimise(const BatchFunction& function, const Minimum& start,
                               const SearchBounds& bounds, double enough,
                               Lookahead lookahead = Lookahead::no);

}  // namespace estimator::greybox::disturbance
