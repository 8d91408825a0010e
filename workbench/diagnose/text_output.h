// A diagnosis as text for a terminal: words first, then the figures.
#pragma once

#include <iosfwd>

#include "workbench/diagnose/outcome.h"

namespace workbench::diagnose {

void print(const Outcome& outcome, std::ostream& out);

}  // namespace workbench::diagnose
