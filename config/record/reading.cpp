#include "config/record/reading.h"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <filesystem>
#include <set>
#include <sstream>
#include <system_error>

#include "config/record/text_fields.h"
#include "config/schema/error.h"
#include "config/schema/read_file.h"

namespace config::record {
namespace {

using schema::UsageError;

bool is_key_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Length of "key=" at the front of `text`, blanks included; 0: there is none.
std::size_t key_length(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size() && text[at] == ' ') ++at;
  const std::size_t begin = at;
  while (at < text.size() && is_key_letter(text[at])) ++at;
  if (at == begin) return 0;
  while (at < text.size() && text[at] == ' ') ++at;
  return at < text.size() && text[at] == '=' ? at + 1 : 0;
}

/// Without the quotes of a shell or of TOML.
std::string unquoted(std::string text) {
  if (text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
      text.back() == text.front()) {
    text = text.substr(1, text.size() - 2);
  }
  return text;
}

/// Appends the pairs of one line; a comma ends a value only before the next "key=".
void append_pairs(std::string_view line, const std::string& where, std::vector<MapEntry>& pairs) {
  while (!trimmed(line).empty()) {
    const std::size_t length = key_length(line);
    if (length == 0) {
      throw UsageError(where + ": '" + std::string(trimmed(line)) +
                       "' is no pair; allowed: t=COLUMN,u=COLUMN,y=COLUMN, each with a [unit] "
                       "where the header has none");
    }
    std::size_t end = length;
    char quote = 0;
    for (; end < line.size(); ++end) {
      const char c = line[end];
      if (quote != 0) {
        if (c == quote) quote = 0;
      } else if (c == '"' && trimmed(line.substr(length, end - length)).empty()) {
        quote = c;
      } else if (c == ',' && key_length(line.substr(end + 1)) > 0) {
        break;
      }
    }
    const std::string key(trimmed(line.substr(0, length - 1)));
    const std::string column = unquoted(std::string(trimmed(line.substr(length, end - length))));
    if (column.empty()) throw UsageError(fmt::format("{}: {} has no column", where, key));
    pairs.push_back({key, column});
    line = end < line.size() ? line.substr(end + 1) : std::string_view{};
  }
}

}  // namespace

void require_as_logged(const ReadOptions& options, const std::string& log) {
  if (!options.given()) return;
  throw UsageError(log +
                   ": --map, --resample, --flip, --advance: are for records, not for the messages "
                   "of an LCM log");
}

std::vector<MapEntry> parse_map(const std::string& map) {
  std::vector<MapEntry> pairs;
  if (map.empty()) return pairs;
  if (key_length(map) > 0) {
    append_pairs(map, "--map", pairs);
  } else {
    std::error_code ignored;
    if (!std::filesystem::exists(map, ignored)) {
      throw UsageError("--map " + map +
                       ": is no pair and no file; allowed: t=COLUMN,u=COLUMN,y=COLUMN, or a file "
                       "with such pairs, one per line");
    }
    const schema::FileContent content = schema::read_file(map, schema::kMostConfigurationBytes);
    if (!content.wrong.empty()) {
      throw schema::bad_config(map, "cannot be read (" + content.wrong + ")",
                               "t = Time [s], one per line");
    }
    std::istringstream file(content.text);
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
      const std::string_view text = trimmed(line);
      if (text.empty() || text.front() == '#') continue;
      append_pairs(text, map + ":" + std::to_string(number), pairs);
    }
    if (pairs.empty()) throw schema::bad_config(map, "has no pairs", "t = Time [s], one per line");
  }
  std::set<std::string> keys;
  for (const MapEntry& pair : pairs) {
    if (!keys.insert(pair.key).second) throw UsageError("--map: has " + pair.key + " twice");
  }
  return pairs;
}

double parse_resample(const std::string& resample) {
  if (resample == "auto" || resample.empty()) return 0.0;
  double rate_Hz = 0.0;
  const char* const end = resample.data() + resample.size();
  const auto result = std::from_chars(resample.data(), end, rate_Hz);
  const bool unit =
      std::string_view(result.ptr, static_cast<std::size_t>(end - result.ptr)) == "Hz";
  if (result.ec != std::errc{} || (result.ptr != end && !unit) || !(rate_Hz > 0.0) ||
      !(rate_Hz < 1e7)) {
    throw UsageError("--resample=" + resample + ": is no rate; allowed: a number in Hz");
  }
  return rate_Hz;
}

}  // namespace config::record
