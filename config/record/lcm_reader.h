// The LCM event log form of a record.
#pragma once

#include <string>
#include <string_view>

#include "config/record/record.h"

namespace config::record {

/// True for the first bytes of an LCM event log.
[[nodiscard]] bool is_lcm_log(std::string_view head) noexcept;

/// Reads the sample_t events of `channel`, or of the one channel that carries that type when there
/// is no such channel. Throws schema::DataError.
[[nodiscard]] Record read_lcm_log(const std::string& file, std::string_view channel);

}  // namespace config::record
