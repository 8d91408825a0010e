#include "config/schema/error.h"

namespace config::schema {

namespace {

/// Bytes of a UTF-8 character behind its first.
constexpr int kMostInside = 3;

bool is_inside(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// A hostile key or value is not echoed whole.
std::string shortened(const std::string& text, std::size_t longest) {
  constexpr std::size_t kLeftOut = 300;
  constexpr std::size_t kEnd = 200;
  if (text.size() <= longest) return text;
  const std::size_t cut = longest - kLeftOut;
  std::size_t to = cut, from = text.size() - kEnd;
  for (int k = 0; k < kMostInside && is_inside(text[to]); ++k) --to;
  for (int k = 0; k < kMostInside && is_inside(text[from]); ++k) ++from;
  if (is_inside(text[to])) to = cut;  // no UTF-8
  return text.substr(0, to) + "..." + text.substr(from);
}

}  // namespace

std::string error_line(const std::string& where, const std::string& what,
                       const std::string& allowed) {
  constexpr std::size_t kLongest = 1000;
  constexpr std::size_t kLongestAllowed = 4000;  // all keys of a table
  std::string text = shortened(where, kLongest) + ": " + shortened(what, kLongest) +
                     (allowed.empty() ? "" : "; allowed: " + shortened(allowed, kLongestAllowed));
  for (char& c : text) {
    if (c == '\n' || c == '\t') c = ' ';
    if (static_cast<unsigned char>(c) < ' ') c = '?';
  }
  return text;
}

}  // namespace config::schema
