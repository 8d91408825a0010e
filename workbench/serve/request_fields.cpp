#include "workbench/serve/request_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "workbench/serve/live_points.h"

namespace workbench::serve {
namespace {

using config::schema::UsageError;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostValues = 200;

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

std::optional<std::string> decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const int high = digit_of(text[i + 1]);
    const int low = digit_of(text[i + 2]);
    if (high < 0 || low < 0) return std::nullopt;
    out += static_cast<char>(16 * high + low);
    i += 2;
  }
  return out;
}

std::string upload_name(const HttpHead& head) {
  constexpr std::string_view kName = "name=";
  if (!std::string_view(head.query).starts_with(kName)) return {};
  const std::string_view query = std::string_view(head.query).substr(kName.size());
  const auto name = decoded(query.substr(0, query.find('&')));
  return name && is_plain_name(*name) ? *name : std::string();
}

std::string upload_map(const HttpHead& head) {
  constexpr std::string_view kMap = "&map=";
  const std::size_t at = head.query.find(kMap);
  if (at == std::string::npos) return {};
  return decoded(std::string_view(head.query).substr(at + kMap.size())).value_or("");
}

std::string text_in(const Json& body, const char* key) {
  const auto found = body.find(key);
  if (found == body.end() || !found->is_string()) {
    throw UsageError(std::string(key) + ": a text is missing");
  }
  return found->get<std::string>();
}

std::vector<std::string> texts_in(const Json& body, const char* key) {
  std::vector<std::string> texts;
  const auto found = body.find(key);
  if (found == body.end()) return texts;
  if (!found->is_array() || found->size() > kMostValues) {
    throw UsageError(std::string(key) + ": is no list");
  }
  for (const Json& one : *found) {
    if (!one.is_string()) throw UsageError(std::string(key) + ": is no list of texts");
    texts.push_back(one.get<std::string>());
  }
  return texts;
}

double number_in(const Json& body, const char* key, double otherwise) {
  const auto found = body.find(key);
  if (found == body.end() || found->is_null()) return otherwise;
  if (!found->is_number() || !std::isfinite(found->get<double>())) {
    throw UsageError(std::string(key) + ": is no number");
  }
  return found->get<double>();
}

ParameterValues values_in(const Json& body) {
  ParameterValues values;
  const auto found = body.find("values");
  if (found == body.end()) return values;
  if (!found->is_object() || found->size() > kMostValues) throw UsageError("values: is no object");
  for (const auto& [name, value] : found->items()) {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      throw UsageError("values: is not a number each");
    }
    values[name] = value.get<double>();
  }
  return values;
}

TriggerSettings trigger_in(const Json& body) {
  TriggerSettings settings;
  const auto one_of = [&](const char* key, std::initializer_list<const char*> allowed) {
    std::string text = text_in(body, key);
    for (const char* const one : allowed) {
      if (text == one) return text;
    }
    throw UsageError(
        std::string(key) + ": allowed: " +
        config::schema::joined(std::vector<std::string>(allowed.begin(), allowed.end())));
  };
  const auto within = [&](const char* key, double otherwise, double least, double most) {
    const double value = number_in(body, key, otherwise);
    if (value >= least && value <= most) return value;
    throw UsageError(fmt::format("{}: allowed: {:g} to {:g}", key, least, most));
  };
  const std::string mode = one_of("mode", {"off", "normal", "single"});
  settings.mode = mode == "normal"   ? TriggerSettings::Mode::normal
                  : mode == "single" ? TriggerSettings::Mode::single
                                     : TriggerSettings::Mode::off;
  settings.channel = text_in(body, "channel");
  if (!column_of(settings.channel)) {
    std::vector<std::string> keys;
    for (std::size_t i = 0; i < kLiveColumns; ++i) {
      keys.push_back(key_of(static_cast<LiveColumn>(i)));
    }
    throw UsageError("channel: allowed: " + config::schema::joined(keys));
  }
  const std::string edge = one_of("edge", {"rising", "falling", "either"});
  settings.edge = edge == "falling"  ? TriggerSettings::Edge::falling
                  : edge == "either" ? TriggerSettings::Edge::either
                                     : TriggerSettings::Edge::rising;
  constexpr double kMost = 1e9;
  constexpr double kLongestHoldOff_s = 3600.0;
  settings.level = within("level", 0.0, -kMost, kMost);
  settings.window_s = within("window_s", settings.window_s, 0.05, TriggerSettings::kLongest_s);
  settings.before_ratio = within("before_ratio", settings.before_ratio, 0.0, 1.0);
  settings.hold_off_s = within("hold_off_s", 0.0, 0.0, kLongestHoldOff_s);
  return settings;
}

View view_in(const Json& body) {
  constexpr double kMostRows = 20'000.0;
  View view;
  view.from_s = number_in(body, "from", 0.0);
  view.to_s = number_in(body, "to", 0.0);
  view.rows =
      static_cast<std::size_t>(std::clamp(number_in(body, "rows", 3000.0), 200.0, kMostRows));
  return view;
}

}  // namespace workbench::serve
