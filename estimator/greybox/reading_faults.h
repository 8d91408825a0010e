// Faults of a record's position that no model explains: a reading that leaps out of the motion, and
// one that stays at the end of its range while the command goes on.
#pragma once

#include <vector>

#include "estimator/greybox/dataset.h"
#include "estimator/greybox/kinematics.h"

namespace estimator::greybox {

struct StuckReading {
  double value_m = 0.0;
  std::vector<SampleRange> spans;  ///< samples
};

struct ReadingFaults {
  std::vector<SampleRange> leaps;   ///< one or two samples each
  std::vector<StuckReading> stuck;  ///< at the least value, at the greatest
};

/// A leap comes back to where it left, or where the motion before it leads, within two samples,
/// without a step of the command before it; the two outermost samples of a segment are not looked
/// at. A reading counts as stuck where the command would move it by more than its resolution and a
/// fiftieth of its range; none where speed and command hardly correlate.
[[nodiscard]] ReadingFaults reading_faults(const Dataset& record);

}  // namespace estimator::greybox
