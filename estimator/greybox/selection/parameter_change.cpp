#include "estimator/greybox/selection/parameter_change.h"

#include <cmath>

namespace estimator::greybox::selection {
namespace {

constexpr double kClearErrors = 2.0;

}  // namespace

const char* to_string(ChangeKind kind) {
  switch (kind) {
    case ChangeKind::ramp:
      return "ramp";
    case ChangeKind::exponential:
      return "exponential";
    case ChangeKind::record:
      return "record";
    case ChangeKind::step:
      break;
  }
  return "step";
}

bool is_clear_of_errors(const ParameterChange& change) {
  if (!std::isfinite(change.to_error)) return change.to == 0.0;
  // a held gain has no error before the change
  const double before = std::isfinite(change.from_error) ? change.from_error : 0.0;
  const bool scales = std::abs(change.from) > kClearErrors * before;
  const double shared = scales ? before * std::abs(change.to / change.from) : 0.0;
  const double own = scales ? std::sqrt(std::abs(std::pow(change.to_error, 2) - shared * shared))
                            : std::hypot(before, change.to_error);
  return std::abs(change.to - change.from) > kClearErrors * own;
}

}  // namespace estimator::greybox::selection
