// Trustworthiness of a reading. The values equal those in sample_t and rods_t.
#pragma once

#include <cstdint>

namespace config::signals {

enum class Quality : std::uint8_t { good = 0, uncertain = 1, stale = 2, bad = 3 };

}  // namespace config::signals
