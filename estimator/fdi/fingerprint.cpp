#include "estimator/fdi/fingerprint.h"

#include <algorithm>
#include <vector>

namespace estimator::fdi {
namespace {

constexpr std::size_t kMaxShown = 160;  ///< characters of a setting

/// Split at blanks, those within quotes and brackets excepted.
std::vector<std::string> split_words(std::string_view line) {
  std::vector<std::string> words(1);
  bool quoted = false;
  int depth = 0;
  for (const char c : line) {
    if (c == '\'') quoted = !quoted;
    if (!quoted && c == '[') ++depth;
    if (!quoted && c == ']') --depth;
    if (c != ' ' || quoted || depth > 0) {
      words.back() += c;
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  return words;
}

/// "[table] key = value" each.
std::vector<std::string> settings_of(std::string_view line) {
  const std::vector<std::string> words = split_words(line);
  std::vector<std::string> settings;
  std::string table;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i + 2 < words.size() && words[i + 1] == "=") {
      settings.push_back(table + words[i] + " = " + words[i + 2]);
      i += 2;
    } else if (words[i].starts_with('[')) {
      table = words[i] + ' ';
    } else if (!words[i].empty()) {
      settings.push_back(words[i]);
    }
  }
  return settings;
}

std::string shown(const std::vector<std::string>& settings, std::size_t i) {
  if (i >= settings.size()) return "none";
  return settings[i].size() > kMaxShown ? settings[i].substr(0, kMaxShown) + "..." : settings[i];
}

}  // namespace

FingerprintDifference difference(std::string_view found, std::string_view expected) {
  const std::vector<std::string> one = settings_of(found);
  const std::vector<std::string> other = settings_of(expected);
  std::size_t i = 0;
  while (i < std::min(one.size(), other.size()) && one[i] == other[i]) ++i;
  return {shown(one, i), shown(other, i)};
}

}  // namespace estimator::fdi
