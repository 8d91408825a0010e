// Variables that a residual may depend on, each split into overlapping pieces.
//
//   h_i(x) = 1 at knot i, 0 at its neighbours, straight lines between, constant beyond the ends
//
// sum b_i h_i(x(t)) is any function of the variable that is straight from knot to knot. The knots
// lie half way between equal steps of the variable and equal shares of the samples: a rod that
// mostly rests still leaves knots for its speeds.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

inline constexpr int kKnots = 8;

/// One row per sample of the data, at most kKnots columns.
struct Variable {
  std::string name;        ///< "y", "v", "u", "speed", "acceleration", "time", "direction"
  Eigen::MatrixXd pieces;  ///< add up to 1
  Eigen::MatrixXd
      signed_pieces;  ///< for a magnitude: with the sign of the signed variable; else empty
};

struct ResidualVariables {
  std::vector<Variable> all;  ///< "u" twice: by its size, the same either way, and as it is
  Eigen::VectorXd command_V;
  Eigen::VectorXd position_m;  ///< modelled, about its mean over the counted samples
  Eigen::VectorXd speed_mps;   ///< modelled
};

/// Command as measured; position, speed and acceleration of the stage's model, because a measured
/// position carries the noise it would then explain; time since each record's start.
[[nodiscard]] ResidualVariables variables(const SearchContext& context, const ModelStage& stage);

/// h_i of one variable over the samples with `counts` 1 (0: ignored). Two columns or more; none
/// where the variable does not vary.
[[nodiscard]] Eigen::MatrixXd pieces_of(const Eigen::VectorXd& values,
                                        const Eigen::VectorXd& counts);

}  // namespace estimator::greybox::selection
