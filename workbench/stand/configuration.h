// The daemon's configuration of a stand, and what is left to do before the stand moves.
#pragma once

#include <string>
#include <vector>

#include "workbench/stand/answers.h"

namespace workbench::stand {

struct StandFile {
  std::string name;     ///< the rig's, in health messages
  std::string file;     ///< where it will stand: relative paths in it start there
  std::string command;  ///< how to make it again
};

/// The commented file. Requires checked answers.
[[nodiscard]] std::string configuration_text(const Answers& answers, const StandFile& file);

/// Steps of commissioning still to be done, in their order. `file`: the configuration.
[[nodiscard]] std::vector<std::string> to_commission(const Answers& answers,
                                                     const std::string& file);

}  // namespace workbench::stand
