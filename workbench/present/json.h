// JSON as all commands write it: SI, a missing number is null.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace workbench::present {

/// null for NaN and infinities.
[[nodiscard]] nlohmann::ordered_json number_or_null(double value);

/// The lines, each typeset (text.h).
[[nodiscard]] nlohmann::ordered_json typeset_all(const std::vector<std::string>& lines);

/// Writes `json` to `file`, whole or not at all; "-" is standard output, "" nowhere. True when
/// standard output has taken it and no other text belongs there. Throws config::schema::RunError.
bool write_json(const std::string& json, const std::string& file);

}  // namespace workbench::present
