// A record as the samples that the fault detection takes.
#pragma once

#include <vector>

#include "config/record/record.h"
#include "config/signals/sample.h"

namespace workbench::train {

/// Ticks from the record's times; columns reference_m, u_requested_V, quality, state, saturated,
/// and those of rod sensors and pressures (config/record/sample_columns.h), are used where the
/// record has them.
[[nodiscard]] std::vector<config::signals::Sample> to_samples(const config::record::Record& record);

}  // namespace workbench::train
