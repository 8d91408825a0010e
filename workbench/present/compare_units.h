// Units in which figures are printed: the one that reads well, three digits.
#pragma once

#include <string>

#include "estimator/greybox/validation/significant_regions.h"

namespace workbench::present {

namespace validation = estimator::greybox::validation;

struct DisplayUnit {
  const char* name = "";  ///< "position"
  std::string text;       ///< "mm", "mrad"
  double factor = 1.0;    ///< shown value = factor * SI value
};

/// Unit of a variable that errors are sorted by: y, v, speed, u, acceleration, direction, time.
[[nodiscard]] DisplayUnit unit_of(const std::string& variable);

/// "62 %", "under 1 %".
[[nodiscard]] std::string percent(double share);
/// "0.2 to 0.5" in the variable's unit, or the direction's name.
[[nodiscard]] std::string bin_text(const std::string& variable, const validation::Bin& bin);
/// "below 5 mm/s", "while reversing", "at positions above 330 mm".
[[nodiscard]] std::string where(const validation::RegionRange& range);
/// All ranges of a region: "below 5 mm/s while reversing".
[[nodiscard]] std::string where(const validation::SignificantRegion& failing);

}  // namespace workbench::present
