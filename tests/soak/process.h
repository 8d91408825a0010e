// What /proc and the kernel say of a child.
#pragma once

#include <sys/types.h>
#include <sys/wait.h>

#include <cstdint>
#include <fstream>
#include <string>

namespace soak {

/// Memory of a process in RAM.
inline std::int64_t resident_KiB(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/status");
  for (std::string word; in >> word;) {
    if (word != "VmRSS:") continue;
    std::int64_t size_KiB = 0;
    in >> size_KiB;
    return size_KiB;
  }
  return 0;
}

/// Whether the child has not ended; leaves it to be waited for.
inline bool runs(pid_t pid) {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == 0;
}

}  // namespace soak
