#include "config/record/damaged_row.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "config/record/text_table.h"

namespace config::record {
namespace {

/// No name of a column and no word of a preamble: "0.3x5", "***", "overflow"; in a column of dates,
/// "2024-13-01".
bool is_damaged(std::string_view field, char decimal, bool clock) {
  constexpr std::array<std::string_view, 22> kWords{
      "error", "err", "#ref!", "#name?",     "#num!",     "inf",         "-inf", "overrange",
      "over",  "ovf", "fault", "invalid",    "overflow",  "overload",    "ol",   "-ol",
      "+ol",   "o.l", "o.l.",  "underrange", "underflow", "out of range"};
  const std::string word = lower(field);
  if (std::find(kWords.begin(), kWords.end(), word) != kWords.end()) return true;
  const auto count = [&word](auto is) { return std::count_if(word.begin(), word.end(), is); };
  const auto digits = count(is_digit);
  const auto letters = count([](char c) {
    return static_cast<unsigned char>(c) >= 0x80 || (c >= 'a' && c <= 'z') || c == '%';
  });
  const auto decimals = count([decimal](char c) { return c == decimal; });
  if (clock && digits >= 2) return letters < digits;
  if (digits == 0) return letters == 0 && word.find_first_of("[]()") == std::string::npos;
  const std::size_t begin = word.find_first_not_of("+-");
  const bool date = letters == 0 && decimals == 2 && word.size() >= 8;
  return is_digit(word[begin]) && digits >= 2 && letters < digits && decimals > 0 && !date &&
         word.find_first_of(":/- ", begin) == std::string::npos;
}

/// True where `first` is an even step before a column's values.
bool leads_to(double first, const std::vector<double>& values) {
  constexpr std::size_t kLooked = 4;
  if (values.size() < 3) return false;
  const double step = values[1] - values[0];
  const auto even = [step](double other) { return std::abs(other - step) < 0.5 * std::abs(step); };
  for (std::size_t i = 2; i < std::min(kLooked, values.size()); ++i) {
    if (!even(values[i] - values[i - 1])) return false;
  }
  return even(values[0] - first);
}

/// True where `first` is less than a column's values, and not far less: a number of a channel.
bool is_before(double first, const std::vector<double>& values) {
  constexpr double kMostSteps = 20.0;
  if (values.empty() || !(first < values[0])) return false;
  return values.size() < 2 || !(values[1] > values[0]) ||
         values[0] - first <= kMostSteps * (values[1] - values[0]);
}

}  // namespace

std::optional<std::size_t> damaged_field(const std::vector<std::string>& fields,
                                         const RowsBelow& rows) {
  std::size_t numbers = 0;
  std::vector<std::size_t> others;
  bool begins = false;
  bool leads = false;
  bool before = false;
  for (std::size_t c = 0; c < fields.size(); ++c) {
    if (rows.kinds[c] != FieldKind::number && rows.kinds[c] != FieldKind::clock) continue;
    double value = 0.0;
    const FieldKind kind = cell_kind(fields[c], rows.decimal, value);
    if (kind == FieldKind::missing) continue;
    if (kind != rows.kinds[c]) {
      others.push_back(c);
      continue;
    }
    ++numbers;
    begins = begins || others.empty();
    leads = leads || (c == 0 && leads_to(value, rows.head[c]));
    before = before || (c == 0 && is_before(value, rows.head[c]));
  }
  if (others.empty() || numbers == 0) return std::nullopt;
  const bool named = rows.named && (before || others.size() == 1);
  const bool row = begins && (2 * numbers > fields.size() || named || leads);
  const bool damaged = std::all_of(others.begin(), others.end(), [&](std::size_t c) {
    return is_damaged(fields[c], rows.decimal, rows.kinds[c] == FieldKind::clock);
  });
  if (!row && !damaged) return std::nullopt;
  return others.front();
}

bool leads_to_rows(const std::vector<std::string>& fields, const RowsBelow& rows) {
  double value = 0.0;
  return rows.kinds.front() == FieldKind::number &&
         cell_kind(fields.front(), rows.decimal, value) == FieldKind::number &&
         leads_to(value, rows.head.front());
}

bool are_rows(const std::vector<std::string>& upper, const std::vector<std::string>& lower,
              const RowsBelow& rows) {
  const std::vector<double>& values = rows.head.front();
  const auto first = [&rows](const std::vector<std::string>& fields) {
    std::vector<double> numbers(fields.size());
    for (std::size_t c = 0; c < fields.size(); ++c) {
      const FieldKind kind = cell_kind(fields[c], rows.decimal, numbers[c]);
      if (kind != rows.kinds[c] && kind != FieldKind::missing) return std::nan("");
    }
    return numbers.front();
  };
  return values.size() >= 3 && first(lower) < values[0] &&
         leads_to(first(upper), {first(lower), first(lower) + values[1] - values[0],
                                 first(lower) + values[2] - values[0]});
}

}  // namespace config::record
