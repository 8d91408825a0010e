#include "workbench/present/text.h"

#include <array>
#include <nlohmann/json.hpp>

#include "workbench/present/script_json.h"

namespace workbench::present {
namespace {

struct Spelling {
  std::string_view typed;
  std::string_view printed;
};

/// Spellings of whole words; the longer before its beginning.
constexpr std::array kSpellings{
    Spelling{"+-", "±"},      Spelling{"->", "→"},      Spelling{"um", "µm"},
    Spelling{"N s2", "N·s²"}, Spelling{"N s", "N·s"},   Spelling{"cm3", "cm³"},
    Spelling{"m3", "m³"},     Spelling{"m2", "m²"},     Spelling{"s2", "s²"},
    Spelling{"rad2", "rad²"}, Spelling{"urad", "µrad"},
};

bool in_word(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool digit(char c) { return c >= '0' && c <= '9'; }

/// True when text[at, at + length) stands alone: no part of a longer word or of a file's name.
bool alone(std::string_view text, std::size_t at, std::size_t length) {
  const auto blocks = [&](char c) { return in_word(c) || c == '.' || c == '-'; };
  const std::size_t after = at + length;
  if (at > 0 && blocks(text[at - 1])) return false;
  if (after == text.size()) return true;
  const bool ends = text[after] == '.' && (after + 1 == text.size() || text[after + 1] == ' ');
  return ends || !blocks(text[after]);
}

}  // namespace

std::string typeset(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const Spelling* found = nullptr;
    for (const Spelling& one : kSpellings) {
      const bool here = found == nullptr && text.substr(i, one.typed.size()) == one.typed;
      if (here && alone(text, i, one.typed.size())) found = &one;
    }
    const char next = i + 1 < text.size() ? text[i + 1] : ' ';
    const char last = i > 0 ? text[i - 1] : ' ';
    if (found != nullptr) {
      out += found->printed;
      i += found->typed.size();
      continue;
    }
    if (text[i] == '-' && digit(next) && (last == ' ' || last == '(')) {
      out += "−";
    } else if (text[i] == ' ' && next == '%' && digit(last)) {
      out += "\u00a0";
    } else {
      out += text[i];
    }
    ++i;
  }
  return out;
}

std::string html(std::string_view text) {
  const std::string clean = nlohmann::json::parse(json_string(text)).get<std::string>();
  std::string out;
  out.reserve(clean.size());
  for (const char c : clean) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace workbench::present
