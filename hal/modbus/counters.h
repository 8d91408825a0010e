// Traffic counters of a device. The polling thread writes, any thread reads.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "hal/histogram.h"

namespace hal::modbus {

struct Counters {
  using Count = std::atomic<std::uint64_t>;
  Count transactions{0};           ///< requests that were answered, exceptions included
  Count timeouts{0};               ///< replies missing at the time-out
  Count bad_replies{0};            ///< corrupted, or not matching the request
  Count link_errors{0};            ///< connection refused, closed or reset
  Count exceptions{0};             ///< exception replies of the device
  Count reconnects{0};             ///< connections made again after a loss
  Count expired_commands{0};       ///< too old when due: null was written instead
  Count silences{0};               ///< no command from the loop for too long: null was written
  std::atomic<int> last_error{0};  ///< errno of the last loss or exception, libmodbus's included
  Histogram round_trips;
  Histogram reactions;  ///< from the measurement of a position to the command it led to, taken
};

/// One line for people: "24000 transactions, round trip p50 ...".
[[nodiscard]] std::string summary(const Counters& counters);

}  // namespace hal::modbus
