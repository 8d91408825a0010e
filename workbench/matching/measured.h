// A record as a model is held against it: command and position on an even grid, in segments between
// which samples are missing.
#pragma once

#include "config/record/record.h"
#include "tracking/measured.h"

namespace workbench::matching {

using tracking::kLeading_per_s;
using tracking::kLed;
using tracking::kLedWhereObserved;
using tracking::kNotLed;
using tracking::kSettling_s;
using tracking::Led;
using tracking::Measured;

/// Segments shorter than this are left out.
inline constexpr double kShortest_s = 1.0;

/// Throws config::schema::Error (exit 65) when what remains is shorter than 2 s,
/// and for rates below 4 Hz. No sample is
/// invented: segments between gaps start anew, short ones are left out and noted.
[[nodiscard]] Measured measured(const config::record::Record& record);

/// Samples [from, to) as a record of their own.
[[nodiscard]] Measured part(const Measured& whole, std::size_t from, std::size_t to);

}  // namespace workbench::matching
