// Finite differences by groups: which perturbed points a Jacobian needs, and the Jacobian from
// their residuals.
//
//   forward  (r(x + h e_j) - r(x)) / h         central  (r(x + h e_j) - r(x - h' e_j)) / (h + h')
//
// A perturbed point stays inside the bounds: at the upper one h turns round.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/nonlinear/problem.h"

namespace estimator::nonlinear {

struct DifferenceStep {
  Eigen::Index column = 0;
  double offset = 0.0;  ///< signed
};

/// Calls the model a group at a time and counts.
class Groups {
 public:
  explicit Groups(const Problem& problem) : problem_(&problem) {}

  /// Residuals of all columns of `points`, in as many groups as it takes.
  [[nodiscard]] Eigen::MatrixXd run(const Eigen::MatrixXd& points);

  [[nodiscard]] int groups() const { return groups_; }
  [[nodiscard]] int points() const { return points_; }

 private:
  const Problem* problem_;
  int groups_ = 0;
  int points_ = 0;
};

/// The points to evaluate around x for `columns`: one or two per column.
[[nodiscard]] std::vector<DifferenceStep> probes_at(const Problem& problem,
                                                    const Eigen::VectorXd& x,
                                                    const std::vector<Eigen::Index>& columns,
                                                    bool central);

/// One column per probe.
[[nodiscard]] Eigen::MatrixXd points_at(const Eigen::VectorXd& x,
                                        const std::vector<DifferenceStep>& probes,
                                        std::size_t first, std::size_t count);

/// Fills the columns that `probes` belong to from their residuals (one column each, same order).
/// A probe that could not be evaluated is tried again on the other side, nearer; failing that the
/// column becomes 0.
void fill_columns(const Problem& problem, const Eigen::VectorXd& x, const Eigen::VectorXd& residual,
                  const std::vector<DifferenceStep>& probes, const Eigen::MatrixXd& results,
                  Groups& groups, Eigen::MatrixXd& jacobian);

/// True when every residual that counts is finite.
[[nodiscard]] bool is_finite(const Problem& problem,
                             const Eigen::Ref<const Eigen::VectorXd>& residual);

}  // namespace estimator::nonlinear
