// Starts LCM on a URL, or says in one line why not. LCM itself answers a wrong URL with several
// lines on stderr; they are held back here.
#pragma once

#include <fcntl.h>
#include <unistd.h>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>

#include "config/schema/error.h"

namespace config::messages {

/// Sends what the process writes to stderr to nowhere while it lives. Only for the start of a
/// program, before other threads write.
class QuietStderr {
 public:
  QuietStderr() : saved_(::dup(STDERR_FILENO)) {
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    ::dup2(nowhere, STDERR_FILENO);
    ::close(nowhere);
  }
  ~QuietStderr() {
    ::dup2(saved_, STDERR_FILENO);
    ::close(saved_);
  }
  QuietStderr(const QuietStderr&) = delete;
  QuietStderr& operator=(const QuietStderr&) = delete;

 private:
  int saved_;
};

/// Throws schema::Error (exit 78).
inline std::unique_ptr<lcm::LCM> connect(const std::string& url) {
  std::unique_ptr<lcm::LCM> lcm;
  {
    const QuietStderr quiet;
    lcm = std::make_unique<lcm::LCM>(url);
  }
  if (!lcm->good()) {
    throw schema::bad_config("LCM URL \"" + url + "\"", "LCM cannot start on it",
                             "udpm://GROUP:PORT?ttl=N on a reachable multicast network, "
                             "file:///LOG?mode=r of a readable log, tcpq://HOST:PORT of a server");
  }
  return lcm;
}

}  // namespace config::messages
