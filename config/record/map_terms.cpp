#include "config/record/map_terms.h"

#include <array>
#include <charconv>
#include <string_view>

#include "config/schema/error.h"

namespace config::record {
namespace {

using schema::bad_data;

/// Takes "*2.5" or "-10" from the end of `text`.
bool ends_in_number(std::string& text, std::string_view marks, double& number) {
  for (std::size_t at = text.size(); at-- > 1;) {
    if (marks.find(text[at]) == std::string_view::npos) continue;
    const char* begin = text.data() + at + (text[at] == '-' ? 0 : 1);
    const char* const end = text.data() + text.size();
    double value = 0.0;
    while (begin != end && *begin == ' ') ++begin;
    const auto result = std::from_chars(begin, end, value);
    if (begin == end || result.ec != std::errc{} || result.ptr != end) continue;
    number = value;
    text.resize(at);
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return true;
  }
  return false;
}

}  // namespace

std::optional<std::size_t> column_named(const std::vector<ReadColumn>& columns,
                                        const std::string& where, const std::string& name) {
  using Text = std::string (*)(const ReadColumn&);
  constexpr std::array<Text, 4> kTexts{[](const ReadColumn& c) { return c.header; },
                                       [](const ReadColumn& c) { return c.text.name; },
                                       [](const ReadColumn& c) { return folded(c.header); },
                                       [](const ReadColumn& c) { return folded(c.text.name); }};
  for (std::size_t way = 0; way < kTexts.size(); ++way) {
    const std::string wanted = way < 2 ? name : folded(name);
    if (wanted.empty()) return std::nullopt;
    // A sign, a factor and an offset are no punctuation.
    if (way >= 2 && (name.front() == '-' || name.find_first_of("*+@[") != std::string::npos)) {
      break;
    }
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (!columns[i].named || kTexts[way](columns[i]) != wanted) continue;
      if (found) {
        throw bad_data(where,
                       "--map: " + name + " is columns " + std::to_string(*found + 1) + " and " +
                           std::to_string(i + 1),
                       "the number of one");
      }
      found = i;
    }
    if (found) return found;
  }
  std::size_t number = 0;
  const auto result = std::from_chars(name.data(), name.data() + name.size(), number);
  const bool whole = result.ec == std::errc{} && result.ptr == name.data() + name.size();
  if (whole && number >= 1 && number <= columns.size()) return number - 1;
  return std::nullopt;
}

std::optional<MapTerm> map_term(const std::vector<ReadColumn>& columns, const std::string& where,
                                const std::string& text) {
  for (const bool negative : {false, true}) {
    if (negative && (text.size() < 2 || text.front() != '-')) break;
    std::string rest = negative ? text.substr(text.find_first_not_of(' ', 1)) : text;
    MapTerm term;
    term.factor = negative ? -1.0 : 1.0;
    const auto named = [&]() -> bool {
      const auto column = column_named(columns, where, rest);
      if (column) term.column = *column;
      return column.has_value();
    };
    if (named()) return term;
    const std::string whole = rest;
    double number = 0.0;
    if (ends_in_number(rest, "*", number)) {
      term.factor *= number;
      if (named()) return term;
      term.factor = negative ? -1.0 : 1.0;
    }
    rest = whole;
    if (ends_in_number(rest, "+-", term.offset)) {
      if (named()) return term;
      if (ends_in_number(rest, "*", number)) {
        term.factor *= number;
        if (named()) return term;
      }
    }
  }
  return std::nullopt;
}

double period_in(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc{} || !(value > 0.0) || result.ptr == end) return 0.0;
  if (text.ends_with(']')) return 0.0;  // 1[s] is a column
  const UnitText unit =
      parse_unit(std::string_view(result.ptr, static_cast<std::size_t>(end - result.ptr)));
  if (unit.si == "s") return value * unit.factor;
  if (unit.si == "Hz") return 1.0 / (value * unit.factor);
  return 0.0;
}

}  // namespace config::record
