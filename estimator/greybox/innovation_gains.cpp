#include "estimator/greybox/innovation_gains.h"

#include "estimator/linear_algebra/decompositions.h"

namespace estimator::greybox {

InnovationGains InnovationGains::part(Eigen::Index from, Eigen::Index to) const {
  InnovationGains result{
      states,     gain.middleCols(from, to - from), decay, scale.segment(from, to - from), {}, {},
      force_place};
  if (line_m.size() > 0) result.line_m = line_m.segment(from, to - from);
  if (lines.cols() > 0) {
    result.lines = linear_algebra::orthonormal_basis(lines.middleRows(from, to - from), 1e-9);
  }
  return result;
}

}  // namespace estimator::greybox
