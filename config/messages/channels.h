// LCM address used when nothing else is given.
#pragma once

namespace config::messages {

/// LCM's own default group and port; ttl=0 keeps messages on this machine.
inline constexpr const char* kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0";
/// Channels are PREFIX_SAMPLE, PREFIX_RODS, PREFIX_PRESSURES, PREFIX_ESTIMATE, PREFIX_ALARM,
/// PREFIX_HEALTH.
inline constexpr const char* kDefaultPrefix = "SPOOLWATCH";

}  // namespace config::messages
