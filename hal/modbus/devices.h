// The loop's view of a Modbus device: one object for each channel of the map, over one poll thread.
#pragma once

#include <memory>
#include <string>

#include "hal/backend.h"
#include "hal/modbus/poll_thread.h"

namespace hal::modbus {

/// When a reading is stale, then bad.
struct Freshness {
  double stale_after_s = 0.0125;  ///< age
  double bad_after_s = 0.025;     ///< age
  double jitter_s = 5e-4;         ///< stale when it was measured further from its usual moment
};

/// `label` opens the summary: "modbus 127.0.0.1:502".
[[nodiscard]] BackendDevices make_devices(const std::shared_ptr<PollThread>& poll_thread,
                                          const Freshness& freshness, const std::string& label);

}  // namespace hal::modbus
