// Tail probabilities against printed tables and exact expressions.
#include "estimator/residual/distributions.h"

#include <gtest/gtest.h>

#include <cmath>

namespace estimator::residual {
namespace {

TEST(Distributions, ChiSquareTailIsTheExactOneForEvenDegreesOfFreedom) {
  // P(X > x) = exp(-x/2) sum_{k < dof/2} (x/2)^k / k!
  for (const int dof : {2, 4, 10, 40, 200}) {
    for (const double ratio : {0.1, 0.5, 0.9, 1.0, 1.1, 1.5, 3.0}) {
      const double x = ratio * dof;
      double term = std::exp(-x / 2);
      double sum = 0.0;
      for (int k = 0; k < dof / 2; ++k) {
        sum += term;
        term *= x / 2 / (k + 1);
      }
      EXPECT_NEAR(chi_square_upper(x, dof), sum, 1e-11) << dof << ' ' << x;
    }
  }
}

TEST(Distributions, ChiSquareTailAgreesWithTheTables) {
  // Abramowitz and Stegun, table 26.8
  EXPECT_NEAR(chi_square_upper(3.84146, 1), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_upper(11.0705, 5), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_upper(31.4104, 20), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_upper(37.5662, 20), 0.01, 1e-6);
  EXPECT_NEAR(chi_square_upper(124.342, 100), 0.05, 1e-5);
  EXPECT_NEAR(chi_square_quantile_upper(0.05, 20), 31.4104, 1e-4);
  EXPECT_EQ(chi_square_upper(0.0, 3), 1.0);
  EXPECT_TRUE(std::isnan(chi_square_upper(std::nan(""), 3)));
}

TEST(Distributions, StudentTailAgreesWithTheTablesAndTheCauchyLaw) {
  EXPECT_NEAR(student_two_sided(2.228139, 10), 0.05, 1e-7);
  EXPECT_NEAR(student_two_sided(-2.776445, 4), 0.05, 1e-7);
  EXPECT_NEAR(student_two_sided(3.0, 1), 1.0 - 2.0 / M_PI * std::atan(3.0), 1e-12);
  EXPECT_NEAR(student_two_sided(1.959964, 1e7), 0.05, 1e-6);
}

TEST(Distributions, FisherQuantilesAreThoseOfTheIncompleteBetaFunction) {
  // Octave: z = betaincinv(p, dof2/2, dof1/2); (1/z - 1)*dof2/dof1
  EXPECT_NEAR(f_quantile_upper(0.01, 2, 50), 5.056610865, 1e-8);
  EXPECT_NEAR(f_quantile_upper(1e-5, 3, 200), 9.193747768, 1e-8);
  EXPECT_NEAR(f_quantile_upper(0.05, 4, 12), 3.259166727, 1e-8);
}

}  // namespace
}  // namespace estimator::residual
