// Where block means lie under a fault of any size between two that were taught: a curve from one
// mean to the other, with a normal law about each of its points.
//
//   m(s) = (1 - s) m0 + s m1 - g(s),   g(s) = s (1 - s) ((1 - s) b0 + s b1),   0 <= s <= 1
//   S(s) = (1 - s) S0 + s S1 + g g' / 16
//   T^2(x) = min over s of (x - m(s))' S(s)^-1 (x - m(s))
//
// m0 S0 m1 S1  mean and covariance at the two sizes; size nought is healthy
// b0 b1        how the curve bends: h^2 m[0', 0, 1] and h^2 m[0, 1, 1'], second divided differences
//              that take in the size before and the one after, h the chord's length; each takes the
//              other's value where there is no such size, and without both the curve is the chord
// g g'/16      how far the bend may be off: one standard deviation is a quarter of it
//
// Two parabolas through three points each, blended: A. W. Overhauser, Analytic definition of curves
// and surfaces by parabolic blending, Ford Motor Company SL 68-40, 1968. The curve is laid in
// straight pieces, each with one covariance.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <string>
#include <vector>

#include "estimator/fdi/region.h"

namespace estimator::fdi {

/// Of the block means at one size.
struct SizeLaw {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
  double blocks = 0.0;
};

[[nodiscard]] Region region_of(const SizeLaw& law, const std::string& where);

/// Of a curve between two sizes: b0 and b1.
struct Bend {
  Eigen::VectorXd from, to;
};

/// h^2 times the second divided difference of a, b, c, which lie `ab` and `bc` apart along the
/// curve.
[[nodiscard]] Eigen::VectorXd bend_of(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                                      const Eigen::VectorXd& c, double ab, double bc, double h);

class SizePath {
 public:
  struct Nearest {
    double distance2;    ///< T^2
    double log_density;  ///< there, but for a constant that depends on the number of values alone
    bool inside;         ///< T^2 is within its limit
  };

  /// `rejection`: probability of its limit. `healthy`: of a curve that begins there; it counts from
  /// where it has left that region for good, as far as `edge2` (T^2), and may be nowhere(). Throws
  /// schema::ConfigError at `where`.
  SizePath(const SizeLaw& from, const SizeLaw& to, const Bend& bend, double rejection,
           Region* healthy, double edge2, const std::string& where);

  [[nodiscard]] bool nowhere() const noexcept { return pieces_.empty(); }
  /// No allocation.
  [[nodiscard]] Nearest nearest(std::span<const double> x) noexcept;

 private:
  struct Piece {
    Region region;              ///< about its begin
    std::vector<double> along;  ///< from its begin to its end
    double length2;             ///< T^2 of its end from its begin
  };
  std::vector<Piece> pieces_;
  double limit_ = 0.0;  ///< of T^2
  std::vector<double> moved_;
};

}  // namespace estimator::fdi
