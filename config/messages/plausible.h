// Checks a decoded message for values that no daemon sends: one flipped bit makes a sample time of
// 1e-300 s or a tick of 2^62.
#pragma once

namespace spoolwatch {
class sample_t;
}

namespace config::messages {

/// Sample time and tick in their ranges; every quantity missing or within 1e9 of its unit.
[[nodiscard]] bool plausible(const spoolwatch::sample_t& sample) noexcept;
/// Other messages carry no numbers that a receiver counts on.
template <class Message>
[[nodiscard]] bool plausible(const Message& /*message*/) noexcept {
  return true;
}

}  // namespace config::messages
