// The fields of the page's requests, checked: names in addresses, and the members of a JSON body. A
// field that is missing, too long or of another type throws config::schema::UsageError.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "workbench/serve/http_server.h"
#include "workbench/serve/study.h"
#include "workbench/serve/trigger.h"

namespace workbench::serve {

/// %XX resolved, once; nothing where it is malformed.
[[nodiscard]] std::optional<std::string> decoded(std::string_view text);
/// The file name of /api/upload?name=...; empty where it is none.
[[nodiscard]] std::string upload_name(const HttpHead& head);
/// The mapping of an upload's columns, of its query; empty: none.
[[nodiscard]] std::string upload_map(const HttpHead& head);
[[nodiscard]] std::string text_in(const nlohmann::ordered_json& body, const char* key);
/// Empty where the key is absent.
[[nodiscard]] std::vector<std::string> texts_in(const nlohmann::ordered_json& body,
                                                const char* key);
/// `otherwise` where the key is absent or null.
[[nodiscard]] double number_in(const nlohmann::ordered_json& body, const char* key,
                               double otherwise);
/// Parameter values under "values".
[[nodiscard]] ParameterValues values_in(const nlohmann::ordered_json& body);
/// "mode", "channel", "edge", "level", "window_s", "before_ratio" and "hold_off_s".
[[nodiscard]] TriggerSettings trigger_in(const nlohmann::ordered_json& body);
/// The visible part of the time axis, "from" and "to" in s, and the rows that are drawn.
[[nodiscard]] View view_in(const nlohmann::ordered_json& body);

}  // namespace workbench::serve
