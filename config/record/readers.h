// The forms of a record: CSV, MAT and LCM event log.
#pragma once

#include <string>
#include <string_view>

#include "config/record/record.h"

namespace config::record {

/// CSV; `text` is the file's content, `name` its name in messages. Throws schema::DataError.
[[nodiscard]] Record read_csv(std::string_view text, const std::string& name);

/// Recognises MATLAB's and Octave's other formats from the beginning of a file; returns the end of
/// an error's line, null for anything else.
[[nodiscard]] const char* other_mat_format(std::string_view head) noexcept;

/// The MAT form of a record: vectors t_s, u_V, y_m, ... with units in their names as in CSV, or one
/// structure that has them as fields. `content` is that of a MAT file of version 5, `name` the
/// file's in messages. Rows and columns are alike; variables that are no vectors of the time's
/// length are left out and noted. Throws schema::DataError.
[[nodiscard]] Record read_mat(std::string_view content, const std::string& name);

/// True for the first bytes of an LCM event log.
[[nodiscard]] bool is_lcm_log(std::string_view head) noexcept;

/// Reads the sample_t events of `channel`, or of the one channel that carries that type when there
/// is no such channel. Throws schema::DataError.
[[nodiscard]] Record read_lcm_log(const std::string& file, std::string_view channel);

}  // namespace config::record
