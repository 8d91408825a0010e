// Whether a record moves enough for anything to be learnt from it.
#pragma once

#include <string>

#include "workbench/matching/evidence.h"

namespace workbench::diagnose {

struct Excitation {
  bool enough = true;
  std::string why;  ///< in words, when it is not
};

[[nodiscard]] Excitation excitation_of(const matching::Evidence& evidence);

}  // namespace workbench::diagnose
