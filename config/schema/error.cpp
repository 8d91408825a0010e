#include "config/schema/error.h"

namespace config::schema {

namespace {

/// A hostile key or value is not echoed whole.
std::string shortened(const std::string& text) {
  constexpr std::size_t kLongest = 1000;
  constexpr std::size_t kBegin = 700;
  constexpr std::size_t kEnd = 200;
  if (text.size() <= kLongest) return text;
  const auto inside = [&](std::size_t at) { return (text[at] & 0xC0) == 0x80; };
  std::size_t to = kBegin, from = text.size() - kEnd;
  while (inside(to)) --to;
  while (from < text.size() && inside(from)) ++from;
  return text.substr(0, to) + "..." + text.substr(from);
}

}  // namespace

std::string error_line(const std::string& where, const std::string& what,
                       const std::string& allowed) {
  std::string text =
      shortened(where) + ": " + shortened(what) + (allowed.empty() ? "" : "; allowed: " + allowed);
  for (char& c : text) {
    if (c == '\n' || c == '\t') c = ' ';
    if (static_cast<unsigned char>(c) < ' ') c = '?';
  }
  return text;
}

}  // namespace config::schema
