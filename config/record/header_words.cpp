#include "config/record/header_words.h"

#include <cctype>

namespace config::record {

std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words(1);
  char before = 0;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool letter = byte >= 0x80 || std::isalpha(byte) != 0;
    const bool digit = std::isdigit(byte) != 0;
    const auto last = static_cast<unsigned char>(before);
    const bool was_digit = std::isdigit(last) != 0;
    const bool hump = std::isupper(byte) != 0 && std::islower(last) != 0;
    if ((!letter && !digit) || hump || (before != 0 && digit != was_digit)) {
      if (!words.back().empty()) words.emplace_back();
    }
    if (letter || digit) words.back() += static_cast<char>(std::tolower(byte));
    before = letter || digit ? c : 0;
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

bool has_word(const std::vector<std::string>& words, const Words& wanted) {
  for (const std::string& word : words) {
    for (const std::string_view want : wanted) {
      if (want.ends_with('*') ? word.find(want.substr(0, want.size() - 1)) != std::string::npos
                              : word == want) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace config::record
