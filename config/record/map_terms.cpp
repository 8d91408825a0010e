#include "config/record/map_terms.h"

#include <array>
#include <charconv>
#include <string_view>

#include "config/schema/error.h"

namespace config::record {
namespace {

using schema::bad_data;

/// Takes "*2.5" or "-10" from the end of `text`, in each way there is ("Pos-1e-3" ends in -3 and
/// -1e-3), until `accepts(rest, number)`. False: none is accepted.
template <class F>
bool ends_in_number(const std::string& text, std::string_view marks, F&& accepts) {
  for (std::size_t at = text.size(); at-- > 1;) {
    if (marks.find(text[at]) == std::string_view::npos) continue;
    const bool minus = text[at] == '-';
    const char* begin = text.data() + at + 1;
    const char* const end = text.data() + text.size();
    double number = 0.0;
    while (begin != end && *begin == ' ') ++begin;
    const auto result = std::from_chars(begin, end, number);
    if (begin == end || (minus && *begin == '-')) continue;
    if (result.ec != std::errc{} || result.ptr != end) continue;
    if (minus) number = -number;
    std::string rest = text.substr(0, at);
    while (!rest.empty() && rest.back() == ' ') rest.pop_back();
    if (accepts(rest, number)) return true;
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
  const auto term = [&](const std::string& name, double factor,
                        double offset) -> std::optional<MapTerm> {
    const auto column = column_named(columns, where, name);
    if (!column) return std::nullopt;
    return MapTerm{*column, factor, offset, name != text && "-" + name != text};
  };
  for (const double sign : {1.0, -1.0}) {
    std::string whole = text;
    if (sign < 0.0) {
      const std::size_t name = text.find_first_not_of(' ', 1);
      if (text.empty() || text.front() != '-' || name == std::string::npos) break;
      whole = text.substr(name);
    }
    std::optional<MapTerm> found = term(whole, sign, 0.0);
    const auto scaled = [&](const std::string& scaled_name, double offset) {
      return ends_in_number(scaled_name, "*", [&](const std::string& name, double factor) {
        found = term(name, sign * factor, offset);
        return found.has_value();
      });
    };
    if (found || scaled(whole, 0.0)) return found;
    ends_in_number(whole, "+-", [&](const std::string& rest, double offset) {
      found = term(rest, sign, offset);
      return found.has_value() || scaled(rest, offset);
    });
    if (found) return found;
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
