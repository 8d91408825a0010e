// Regions in which a model fails: regions whose error exceeds the rest by more than chance.
//
// Regions are found in the speed error, because a position error persists where it did not arise. A
// region splits the samples in two; G rates two variances against one:
//
//   G = (n ln s^2 - n_in ln s_in^2 - n_out ln s_out^2) / 2,   n s^2 = n_in s_in^2 + n_out s_out^2
//
// s RMS speed errors; n effective samples, at least a correlation length apart. G is the logarithm
// of a likelihood ratio; s_out^2 counts as at least 5 % of s^2, otherwise leakage over a region's
// edge would widen the region. Regions are ranges of neighbouring bins, or such a range of one
// variable together with one of another.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/validation/regions.h"

namespace estimator::greybox::validation {

struct RegionRange {
  std::string variable;
  double from = 0.0;  ///< SI; NaN for direction
  double to = 0.0;
  std::string name;      ///< for direction: "reversing"
  bool lowest = false;   ///< begins with the variable's lowest bin
  bool highest = false;  ///< ends with its highest
};

struct SignificantRegion {
  std::vector<RegionRange> ranges;  ///< one or two
  Bin figures;
  double gain = 0.0;         ///< G
  bool significant = false;  ///< beyond chance and large enough to report
};

/// Best range of each variable, most significant first. Empty without comparable samples.
[[nodiscard]] std::vector<SignificantRegion> significant_regions(
    const SortedErrors& sorted, const std::vector<Region>& regions);

/// The most significant region, narrowed by a second variable where that raises G.
[[nodiscard]] SignificantRegion narrowed(const SortedErrors& sorted,
                                         const std::vector<Region>& regions,
                                         const std::vector<SignificantRegion>& singles);

}  // namespace estimator::greybox::validation
