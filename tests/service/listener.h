// The service's alarms as another process hears them.
#pragma once

#include <cstdio>
#include <string>

#include "tests/service/bench.h"

namespace service {

/// Alarms as another process hears them; ends by itself.
class Listener {
 public:
  Listener()
      : lines_(popen((std::string(SPOOLWATCH_BIN_DIR "/spoolwatch listen --json --alarms "
                                                     "--duration 40 --lcm-url '") +
                      kLcm + "'")
                         .c_str(),
                     "r")) {}
  ~Listener() { pclose(lines_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Waits until a line with that comes; "" when none does.
  std::string hears(const std::string& wanted) {
    char line[4096];
    while (std::fgets(line, sizeof line, lines_) != nullptr) {
      if (std::string(line).find(wanted) != std::string::npos) return line;
    }
    return "";
  }

 private:
  FILE* lines_;
};

}  // namespace service
