// The two errors of a model, in the words that every report explains them with.
#pragma once

namespace workbench::present {

inline constexpr const char* kFreeRunMeaning =
    "Free run: the measured command alone drives the model from the first "
    "sample on; it never sees the measured position again, so that errors add up.";

inline constexpr const char* kDriftCorrectedMeaning =
    "Drift-corrected: the same simulation, but its position is slowly corrected towards the "
    "measured one, so that an error shows where it arises and then decays.";

inline constexpr const char* kNoiseFloorMeaning =
    "Noise floor: what the sensor's steps and noise leave even with a perfect model; about 95 % of "
    "its samples lie within twice that.";

}  // namespace workbench::present
