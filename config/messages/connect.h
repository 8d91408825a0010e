// Starts LCM on a URL, or says in one line why not. LCM itself answers a wrong URL with several
// lines on stderr; they are held back here, and the first of them becomes the reason.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#include <array>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>

#include "config/schema/error.h"

namespace config::messages {

/// Catches what the process writes to stderr while it lives. Only for the start of a program,
/// before other threads write.
class CaughtStderr {
 public:
  CaughtStderr() : saved_(::dup(STDERR_FILENO)), caught_(::memfd_create("stderr", MFD_CLOEXEC)) {
    ::dup2(caught_, STDERR_FILENO);
  }
  ~CaughtStderr() {
    ::dup2(saved_, STDERR_FILENO);
    ::close(saved_);
    ::close(caught_);
  }
  CaughtStderr(const CaughtStderr&) = delete;
  CaughtStderr& operator=(const CaughtStderr&) = delete;

  [[nodiscard]] std::string first_line() const {
    std::array<char, 256> text{};
    const ssize_t size = ::pread(caught_, text.data(), text.size(), 0);
    const std::string all(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
    return all.substr(0, all.find('\n'));
  }

 private:
  int saved_;
  int caught_;
};

/// Throws schema::ConfigError. Who only sends says so: asking UDP for its descriptor starts a
/// thread of LCM's that receives every message, our own too.
inline std::unique_ptr<lcm::LCM> connect(const std::string& url, bool receives = true) {
  std::unique_ptr<lcm::LCM> lcm;
  std::string reason;
  {
    const CaughtStderr caught;
    lcm = std::make_unique<lcm::LCM>(url);
    reason = caught.first_line();
  }
  // A tcpq client without its server counts as good but has no descriptor.
  const bool writes_log = url.starts_with("file:") && url.find("mode=w") != std::string::npos;
  const bool only_sends = !receives && url.starts_with("udpm:");
  if (!lcm->good() || (!writes_log && !only_sends && lcm->getFileno() < 0)) {
    throw schema::bad_config("LCM URL \"" + url + "\"",
                             "LCM cannot start" + (reason.empty() ? "" : " (" + reason + ")"),
                             "udpm://GROUP:PORT?ttl=N with a multicast route to GROUP, "
                             "file:///LOG?mode=r of a readable log, tcpq://HOST:PORT of a server");
  }
  return lcm;
}

}  // namespace config::messages
