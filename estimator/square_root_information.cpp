#include "estimator/square_root_information.h"

namespace estimator {

bool SquareRootInformation::solve(double* value) const noexcept {
  const int p = columns_ - 1;
  for (int i = p - 1; i >= 0; --i) {
    if (!(memory_[i] > 0.0)) return false;
    const double* u = memory_ + padded(columns_) * (i + 1);
    double sum = u[p];
    for (int j = i + 1; j < p; ++j) sum -= u[j] * value[j];
    value[i] = sum;
  }
  return true;
}

}  // namespace estimator
