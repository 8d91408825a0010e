// A command that acts at another time than the one it is logged at.
//
// A model holds each command until the next sample. A log that keeps every m-th sample of a faster
// loop, or the samples of a continuous command, shows the command at the start of an interval in
// which it goes on to change; a model moves as far with the mean of the interval, about
//
//   (1 - L) u(k) + L u(k+1),   L = (m - 1) / (2 m);   1/2 for a continuous command
//
// Whole samples are a shift between two clocks.
#pragma once

#include <span>

#include "config/record/record.h"

namespace config::record {

/// Shifts the command of consecutive samples earlier, later below 0; where the number of samples is
/// not whole, by the mean over an interval of the cubic through u(k-1) ... u(k+2). Values at the
/// ends are held.
void advance_command(std::span<double> u_V, double lead_samples);

/// True where a shift by that many samples interpolates.
[[nodiscard]] bool interpolates(double lead_samples) noexcept;

/// Turns and shifts the command of a record as the options ask for, each with a note; samples whose
/// command is not in the record are left out. Throws schema::UsageError where none remain.
void take_command(Record& record, const ReadOptions& options);

}  // namespace config::record
