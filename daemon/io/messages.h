// Converts samples, estimates and alarms to the LCM types; the publisher sets run_id, seq and
// stamp. Strings and arrays of the target are reused to avoid allocation.
#pragma once

#include "config/signals/sample.h"
#include "estimator/fdi/alarm_book.h"
#include "estimator/fdi/pipeline.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/pressures_t.hpp"
#include "spoolwatch/rods_t.hpp"
#include "spoolwatch/sample_t.hpp"

namespace monitor::io {

void fill(spoolwatch::sample_t& message, const config::signals::Sample& sample,
          double sample_time_s);
/// Fills everything except the ids, which may be fewer than the rods.
void fill(spoolwatch::rods_t& message, const config::signals::Sample& sample);
void fill(spoolwatch::pressures_t& message, const config::signals::Sample& sample);
void fill(spoolwatch::estimate_t& message, const estimator::fdi::EstimateEvent& event);
void fill(spoolwatch::alarm_t& message, const estimator::fdi::Alarm& alarm, bool repeat);

}  // namespace monitor::io
