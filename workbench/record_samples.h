// A record as the samples that the fault detection takes.
#pragma once

#include <vector>

#include "config/record/record.h"
#include "estimator/fdi/sample.h"

namespace workbench {

/// Ticks from the record's times; columns reference_m, u_requested_V, quality, state, saturated,
/// and those of rod sensors and pressures (config/record/sample_columns.h), are used where the
/// record has them.
[[nodiscard]] std::vector<estimator::fdi::Sample> to_samples(const config::record::Record& record);

}  // namespace workbench
