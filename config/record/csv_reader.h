// The CSV form of a record.
#pragma once

#include <string>
#include <string_view>

#include "config/record/record.h"

namespace config::record {

/// `text` is the file's content, `name` its name in messages. Throws schema::DataError.
[[nodiscard]] Record read_csv(std::string_view text, const std::string& name);

}  // namespace config::record
