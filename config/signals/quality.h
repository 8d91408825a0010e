// Trustworthiness of a reading. The values equal those in sample_t and rods_t.
#pragma once

#include <cstdint>

namespace config::signals {

enum class Quality : std::uint8_t { good = 0, uncertain = 1, stale = 2, bad = 3 };

/// True for the quality in a message where the reading is no new one: stale or bad.
constexpr bool is_stale(std::int8_t quality) noexcept {
  return quality >= static_cast<std::int8_t>(Quality::stale);
}

}  // namespace config::signals
