// The shares of its limits by which commissioning works. Not for others.
#pragma once

namespace monitor::control::shares {

// Shares of max_travel.
inline constexpr double kTravelOfPulse = 0.35;  ///< at the target speed
inline constexpr double kEndOfPulse = 0.45;
inline constexpr double kEndOfStage = 0.8;
inline constexpr double kNear = 0.15;    ///< of the start: a pulse may lead away from it
inline constexpr double kSeen = 0.04;    ///< a motion
inline constexpr double kNoisy = 0.2;    ///< what a motion must stand out from
inline constexpr double kAgainst = 0.2;  ///< a motion against the command
inline constexpr double kBackOff = 0.4;  ///< from a stop
// Shares of the target speed.
inline constexpr double kFastLow = 0.5;
inline constexpr double kMoves = 0.1;
inline constexpr double kDrift = 0.05;  ///< between pulses, worth a correction
// Shares of the speed that the faster pulse gave.
inline constexpr double kSlowLow = 0.2;
inline constexpr double kSlowHigh = 0.65;

inline constexpr double kFirstLevel = 1.0 / 32.0;  ///< share of the authority
inline constexpr double kSettle = 0.4;             ///< share of a pulse
/// Share of the settling time: what is later has not settled when the line begins.
inline constexpr double kLatest = 0.6;
inline constexpr double kRest_s = 0.4;
inline constexpr double kNoises = 10.0;  ///< a motion is that many standard deviations
/// Share of the authority by which what a device says it gives may differ from the command: coarser
/// than any converter, finer than any mistake in its scale.
inline constexpr double kSameCommand = 0.05;
inline constexpr double kStart_s = 0.3;  ///< a drive is under way
inline constexpr double kStill_s = 0.1;

}  // namespace monitor::control::shares
