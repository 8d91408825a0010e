// A diagnosis as JSON, SI throughout; missing numbers are null.
#pragma once

#include <string>

#include "workbench/diagnose/outcome.h"

namespace workbench::diagnose {

[[nodiscard]] std::string to_json(const Outcome& outcome);

}  // namespace workbench::diagnose
