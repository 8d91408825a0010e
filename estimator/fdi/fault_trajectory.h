// Experimental, part of [[classifier]]: block means under a fault of any size between two trained
// sizes, as a curve from one mean to the other with a normal distribution about each point.
//
//   m(s) = (1 - s) m0 + s m1 - g(s),   g(s) = s (1 - s) ((1 - s) b0 + s b1),   0 <= s <= 1
//   S(s) = (1 - s) S0 + s S1 + g g' / 16
//   T^2(x) = min over s of (x - m(s))' S(s)^-1 (x - m(s))
//
// m0 S0 m1 S1  mean and covariance at the two sizes; size 0 is healthy
// b0 b1        curvature: h^2 m[0', 0, 1] and h^2 m[0, 1, 1'], second divided differences with the
//              next smaller and the next larger size, h the chord's length; where there is no such
//              size, each equals the other; without both the curve is the chord
// g g'/16      uncertainty of the curvature: one standard deviation is a quarter of it
//
// Two parabolas through three points each, blended: A. W. Overhauser, Analytic definition of curves
// and surfaces by parabolic blending, Ford Motor Company SL 68-40, 1968. The curve is
// approximated by straight pieces, each with one covariance.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "estimator/fdi/hotelling_t2.h"
#include "estimator/fdi/trained.h"

namespace estimator::fdi {

/// Distribution of the block means of one class.
struct ClassDistribution {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
  double blocks = 0.0;
};

[[nodiscard]] HotellingT2 hotelling_t2(const ClassDistribution& distribution,
                                       const std::string& where);

/// Curvature of a trajectory between two sizes: b0 and b1.
struct Curvature {
  Eigen::VectorXd from, to;
};

/// h^2 times the second divided difference of a, b, c, at distances `ab` and `bc` along the curve.
[[nodiscard]] Eigen::VectorXd curvature_of(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                                           const Eigen::VectorXd& c, double ab, double bc,
                                           double h);

class FaultTrajectory {
 public:
  struct Nearest {
    double t2;           ///< T^2
    double log_density;  ///< up to a constant that depends on the number of values alone
    bool inside;         ///< T^2 is within its limit
  };

  /// `rejection`: probability of its limit. `healthy`: of a curve that begins there; it counts from
  /// where it has left that region for good, as far as `healthy_limit` (T^2), and may be empty().
  /// Throws schema::ConfigError at `where`.
  FaultTrajectory(const ClassDistribution& from, const ClassDistribution& to,
                  const Curvature& curvature, double rejection, HotellingT2* healthy,
                  double healthy_limit, const std::string& where);

  [[nodiscard]] bool empty() const noexcept { return pieces_.empty(); }
  /// No allocation.
  [[nodiscard]] Nearest nearest(std::span<const double> x) noexcept;

 private:
  struct Piece {
    HotellingT2 region;         ///< about the begin
    std::vector<double> along;  ///< from begin to end
    double length_t2;           ///< T^2 of the end from the begin
  };
  std::vector<Piece> pieces_;
  double limit_ = 0.0;  ///< limit of T^2
  std::vector<double> moved_;
};

/// Experimental, part of [[classifier]]: which trained classes are sizes of one fault, in which
/// order, and the trajectories that join them.
///
/// Two classes of one name and direction are sizes of one fault when their means, seen from
/// healthy, are within 60 degrees of each other in the metric of the pooled covariance; the nearer
/// to healthy is the smaller. The trajectory to a size begins at the next smaller size, or at
/// healthy. Returns the trajectory to each class; none for `healthy` and for a class within its
/// region. `distributions` are those of `classes`, `pooled` the covariance in which lengths are
/// measured. Throws schema::ConfigError at `where`.
[[nodiscard]] std::vector<std::optional<FaultTrajectory>> fault_trajectories(
    const std::vector<TrainedClass>& classes, const std::vector<ClassDistribution>& distributions,
    const Eigen::MatrixXd& pooled, std::size_t healthy, double rejection, const std::string& where);

}  // namespace estimator::fdi
