// A record as a model is held against it: command and position on an even grid, in segments between
// which samples are missing.
#pragma once

#include "config/record/record.h"
#include "daemon/tracking/measured.h"

namespace workbench::matching {

using monitor::tracking::kLeading_per_s;
using monitor::tracking::kLed;
using monitor::tracking::kLedWhereObserved;
using monitor::tracking::kNotLed;
using monitor::tracking::kSettling_s;
using monitor::tracking::Led;
using monitor::tracking::Measured;

/// Segments shorter than this are left out.
inline constexpr double kShortest_s = 1.0;

/// Throws config::schema::Error (exit 65) when what remains is shorter than 2 s,
/// and for rates below 4 Hz. No sample is
/// invented: segments between gaps start anew, short ones are left out and noted.
[[nodiscard]] Measured measured(const config::record::Record& record);

/// Samples [from, to) as a record of their own.
[[nodiscard]] Measured part(const Measured& whole, std::size_t from, std::size_t to);

}  // namespace workbench::matching
