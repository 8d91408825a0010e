// The kinds of rigs by what drives them: one function for each file of kinds.
#pragma once

#include <vector>

#include "workbench/model/kinds.h"

namespace workbench::model {

[[nodiscard]] std::vector<Kind> cylinder_kinds();
[[nodiscard]] std::vector<Kind> motor_kinds();
[[nodiscard]] std::vector<Kind> servo_kinds();

}  // namespace workbench::model
