// Questions that several kinds of rigs share, and the numbers that follow from their answers.
#pragma once

#include <numbers>
#include <string>

#include "workbench/model/kinds.h"
#include "workbench/model/model_writer.h"

namespace workbench::model {

inline constexpr double kPi = std::numbers::pi;

[[nodiscard]] Question mass_question(double usual);
[[nodiscard]] Question valve_step_question();

/// -3 dB frequency of the valve. A lag of second order, damped by 0.6 to 1, passes 90 % of a step
/// after 0.31 to 0.40 of that frequency's period.
[[nodiscard]] double valve_Hz(const Answers& a);
[[nodiscard]] std::string valve_words(const Answers& a);
/// Natural frequency of the valve's lag of second order.
[[nodiscard]] double spool_rad_per_s(const Answers& a);

void add_notes(ModelWriter& w, const char* plant, const char* limits);

}  // namespace workbench::model
