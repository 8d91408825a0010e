#include "daemon/io/service_manager.h"

#include <systemd/sd-daemon.h>

namespace monitor::io {

ServiceManager::ServiceManager() {
  std::uint64_t watchdog_us = 0;
  if (sd_watchdog_enabled(0, &watchdog_us) > 0) {
    watchdog_ns_ = static_cast<std::int64_t>(watchdog_us) * 1000;
  }
}

void ServiceManager::ready() const { sd_notify(0, "READY=1"); }

void ServiceManager::alive() const { sd_notify(0, "WATCHDOG=1"); }

void ServiceManager::stopping() const { sd_notify(0, "STOPPING=1\nSTATUS=stopping"); }

void ServiceManager::status(const std::string& line) const {
  sd_notify(0, ("STATUS=" + line).c_str());
}

}  // namespace monitor::io
