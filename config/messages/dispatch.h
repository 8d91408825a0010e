// Bytes to a message by its kind: the only list of the message types.
#pragma once

#include <cstdint>

#include "config/messages/decode.h"
#include "config/messages/handler.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/pressures_t.hpp"
#include "spoolwatch/rods_t.hpp"
#include "spoolwatch/sample_t.hpp"

namespace config::messages {

/// Calls `take` with an empty message of this kind.
template <class Take>
auto with_type(MessageKind kind, const Take& take) {
  switch (kind) {
    case MessageKind::sample:
      return take(spoolwatch::sample_t{});
    case MessageKind::rods:
      return take(spoolwatch::rods_t{});
    case MessageKind::pressures:
      return take(spoolwatch::pressures_t{});
    case MessageKind::estimate:
      return take(spoolwatch::estimate_t{});
    case MessageKind::alarm:
      return take(spoolwatch::alarm_t{});
    case MessageKind::health:
      break;
  }
  return take(spoolwatch::health_t{});
}

/// True when the bytes begin with the type hash of this kind.
[[nodiscard]] inline bool is_of(MessageKind kind, const void* data, int size) {
  std::int64_t hash = 0;
  return __int64_t_decode_array(data, 0, size, &hash, 1) > 0 &&
         hash == with_type(kind, [](const auto& message) { return message.getHash(); });
}

/// Calls `take` with the decoded message. False, without a call, when the bytes are no message of
/// this kind.
template <class Take>
[[nodiscard]] bool dispatch(MessageKind kind, const void* data, int size, const Take& take) {
  return with_type(kind, [&](auto message) {
    if (!decode(message, data, size)) return false;
    take(message);
    return true;
  });
}

}  // namespace config::messages
