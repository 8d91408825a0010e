// The forms of a record: CSV, MAT and LCM event log.
#pragma once

#include <string>
#include <string_view>

#include "config/record/mat_variables.h"
#include "config/record/record.h"

namespace config::record {

class TextWindow;

/// CSV and its relatives; `window` begins with the file's content, `name` is the file's name in
/// messages. Throws schema::DataError.
[[nodiscard]] Record read_csv(TextWindow& window, const std::string& name,
                              const ReadOptions& options = {});

/// Recognises MATLAB's and Octave's other formats from the beginning of a file; returns the end of
/// an error's line, null for anything else.
[[nodiscard]] const char* other_mat_format(std::string_view head) noexcept;

/// The MAT form of a record: vectors t_s, u_V, y_m, ... with units in their names as in CSV, or one
/// structure that has them as fields. `content` is that of a MAT file of version 5, `name` the
/// file's in messages. Rows and columns are alike; variables that are no vectors of the time's
/// length are left out and noted. Throws schema::DataError.
[[nodiscard]] Record read_mat(std::string_view content, const std::string& name,
                              const ReadOptions& options = {});

/// The same of variables that are read already; `form` as in Record.
[[nodiscard]] Record read_variables(std::vector<MatVariable> variables, const std::string& name,
                                    const ReadOptions& options, const std::string& form);

/// True for the first bytes of an HDF5 file, MATLAB's version 7.3 among them.
[[nodiscard]] bool is_hdf5(std::string_view head) noexcept;

/// True for the byte order mark of text in UTF-16, which the unicode text of a spreadsheet has.
[[nodiscard]] constexpr bool is_utf16(std::string_view head) noexcept {
  return head.starts_with("\xFF\xFE") || head.starts_with("\xFE\xFF");
}

/// True for the first bytes of an LCM event log.
[[nodiscard]] bool is_lcm_log(std::string_view head) noexcept;

/// Reads the sample_t events of `channel`, or of the one channel that carries that type when there
/// is no such channel. Throws schema::DataError.
[[nodiscard]] Record read_lcm_log(const std::string& file, std::string_view channel);

}  // namespace config::record
