// Experimental, part of [[classifier]]: which trained classes are sizes of one fault, in which
// order, and the trajectories that join them.
//
// Two classes of one name and direction are sizes of one fault when their means, seen from healthy,
// are within 60 degrees of each other in the metric of the pooled covariance; the nearer to healthy
// is the smaller. The trajectory to a size begins at the next smaller size, or at healthy.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimator/fdi/fault_trajectory.h"
#include "estimator/fdi/trained.h"

namespace estimator::fdi {

/// Trajectory to each class; none for `healthy` and for a class within its region. `laws` are those
/// of
/// `classes`, `pooled` the covariance in which lengths are measured. Throws schema::ConfigError at
/// `where`.
[[nodiscard]] std::vector<std::optional<FaultTrajectory>> fault_trajectories(
    const std::vector<TrainedClass>& classes, const std::vector<ClassDistribution>& distributions,
    const Eigen::MatrixXd& pooled, std::size_t healthy, double rejection, const std::string& where);

}  // namespace estimator::fdi
