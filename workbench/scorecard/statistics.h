// Confidence limits from few trials and few events.
//
//   Poisson          the least rate at which n or fewer events in T would come with probability
//                    1 - c:  chi2(c; 2 n + 2) / (2 T), chi2 the quantile. No event in 72 h: the
//                    95 % upper limit is 2.996 / 72 h = 1 / 24.03 h
//   Clopper-Pearson  the least share p for which k or more of n come with probability 1 - c:
//                    the quantile 1 - c of beta(k, n - k + 1)
//
// Both are exact, one-sided, and cover c or more.
// Sources: F. Garwood, Biometrika 28 (1936) 437; C. J. Clopper, E. S. Pearson, Biometrika 26 (1934)
// 404.
#pragma once

#include <cstdint>
#include <vector>

namespace workbench::scorecard {

inline constexpr double kConfidence = 0.95;

/// Upper limit of a rate, 1/unit of `time`; infinite when there was no time.
[[nodiscard]] double poisson_upper(std::int64_t events, double time,
                                   double confidence = kConfidence);

/// Lower limit of a share; 0 for k = 0.
[[nodiscard]] double clopper_pearson_lower(std::int64_t k, std::int64_t n,
                                           double confidence = kConfidence);

/// The least value that a share of all values does not exceed; infinities count as never. NaN of
/// none.
[[nodiscard]] double quantile(std::vector<double> values, double share);

/// True when k out of n reach the share.
[[nodiscard]] bool enough(std::int64_t k, std::int64_t n, double share);

}  // namespace workbench::scorecard
