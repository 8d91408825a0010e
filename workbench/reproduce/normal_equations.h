// Least squares as the thesis does it, theta = (Psi' Psi)^-1 Psi' y: squares the condition number.
// Here only to show what comes of it; the product factorises Psi itself.
#pragma once

#include <span>
#include <vector>

#include "estimator/structure.h"

namespace workbench::reproduce {

[[nodiscard]] std::vector<double> solve_normal_equations(const estimator::Structure& structure,
                                                         std::span<const double> u_V,
                                                         std::span<const double> y_m);

}  // namespace workbench::reproduce
