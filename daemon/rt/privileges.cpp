#include "daemon/rt/privileges.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "config/schema/error.h"

namespace monitor::rt {
namespace {

/// Memory that must remain mappable after locking; a limit on locked memory could prevent it.
constexpr std::size_t kRoomAfterLock_bytes = 32U << 20U;
constexpr std::size_t kStackTouched_bytes = 64 * 1024;

class PrivilegeReport {
 public:
  explicit PrivilegeReport(bool required) : required_(required) {}
  void got(const std::string& what) { text_ += (text_.empty() ? "" : "; ") + what; }
  void refused(const std::string& what, int error, const std::string& allowed) {
    const std::string line = "no " + what + " (" + std::strerror(error) + ")";
    if (required_) {
      throw config::schema::RunError("[loop] privileges = \"require\": " + line +
                                     "; allowed: " + allowed + ", or \"try\"");
    }
    got(line);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  bool required_;
  std::string text_;
};

constexpr const char* kRights = "run as root or with CAP_SYS_NICE and CAP_IPC_LOCK";

/// 0, or errno.
int lock_memory() noexcept {
  if (mlockall(MCL_CURRENT) != 0) return errno;
  if (mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) != 0) {
    const int error = errno;
    munlockall();
    return error;
  }
  void* room = mmap(nullptr, kRoomAfterLock_bytes, PROT_READ | PROT_WRITE,
                    MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (room == MAP_FAILED) {
    const int error = errno;
    munlockall();
    return error;
  }
  munmap(room, kRoomAfterLock_bytes);
  return 0;
}

int try_thread(const hal::ThreadOptions& options) {
  hal::Thread probe;
  return probe.start("probe", options, [] {});
}

/// Requests a wake-up latency of 0 us from the power management while the file stays open.
int keep_awake() noexcept {
  const int file = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  if (file < 0) return errno;
  const std::int32_t latency_us = 0;
  return write(file, &latency_us, sizeof latency_us) == sizeof latency_us ? 0 : errno;
}

}  // namespace

void keep_memory_small() noexcept {
  mallopt(M_ARENA_MAX, 1);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, hal::kThreadStack_bytes);
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
}

Grant request_privileges(const LoopConfig& config) {
  Grant grant;
  if (config.privileges == "off") {
    grant.text = "off";
    return grant;
  }
  PrivilegeReport report(config.privileges == "require");
  const hal::ThreadOptions fifo{static_cast<int>(config.priority), -1};
  if (const int error = try_thread(fifo)) {
    report.refused("SCHED_FIFO", error, kRights);
  } else {
    grant.loop_thread.priority = fifo.priority;
    report.got("SCHED_FIFO " + std::to_string(fifo.priority));
  }
  if (config.cpu >= 0) {
    const hal::ThreadOptions pinned{0, static_cast<int>(config.cpu)};
    const std::string core = "cpu " + std::to_string(config.cpu);
    if (const int error = try_thread(pinned)) {
      report.refused(core, error, "cpu = the number of a core that this process may use");
    } else {
      grant.loop_thread.cpu = pinned.cpu;
      report.got(core);
    }
  }
  if (const int error = lock_memory()) {
    report.refused("locked memory", error, kRights);
  } else {
    report.got("memory locked");
  }
  if (keep_awake() == 0) report.got("deep idle off");  // many machines have no such control
  grant.text = report.text();
  return grant;
}

void prepare_loop_thread() noexcept {
  prctl(PR_SET_TIMERSLACK, 1UL);
  volatile unsigned char stack[kStackTouched_bytes];
  for (std::size_t i = 0; i < sizeof stack; i += 1024) stack[i] = 0;
}

}  // namespace monitor::rt
