// How far a reading can be trusted. The numbers are those of sample_t and rods_t.
#pragma once

#include <cstdint>

namespace config::signals {

enum class Quality : std::uint8_t { good = 0, uncertain = 1, stale = 2, bad = 3 };

}  // namespace config::signals
