#include "config/record/text_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "config/record/clock_text.h"
#include "config/record/text_fields.h"
#include "config/schema/error.h"

namespace config::record {
namespace {

using schema::bad_data;

constexpr std::size_t kHeadRows = 60;

/// Looks like a number that was cut apart or is written another way: no name of anything.
bool is_garbled(std::string_view field) {
  bool digit = false;
  for (const char c : field) {
    digit = digit || is_digit(c);
    if (!is_digit(c) && std::string_view("+-.,;:|eE \t'").find(c) == std::string_view::npos) {
      return false;
    }
  }
  return digit;
}

/// True for a row; `kinds` and `values` of its fields.
bool is_row(const std::string_view line, const TextDialect& dialect, std::vector<FieldKind>& kinds,
            std::vector<double>& values) {
  kinds.clear();
  values.clear();
  if (trimmed(line).empty()) return false;
  std::size_t numbers = 0;
  std::size_t clocks = 0;
  for (const std::string& field : split_fields(line, dialect.separator)) {
    double value = 0.0;
    FieldKind kind = kind_of(field, dialect.decimal, value);
    if (kind == FieldKind::text && is_garbled(field)) return false;
    numbers += kind == FieldKind::number ? 1 : 0;
    clocks += kind == FieldKind::clock ? 1 : 0;
    kinds.push_back(kind);
    values.push_back(value);
  }
  return kinds.size() >= 2 && numbers >= 1 && numbers + clocks >= 2;
}

bool alike(FieldKind a, FieldKind b) {
  return a == b || a == FieldKind::missing || b == FieldKind::missing;
}

/// The longest run of rows in one dialect.
TextTable table_in(const std::vector<TextLine>& lines, const TextDialect& dialect) {
  TextTable best;
  std::vector<FieldKind> kinds;
  std::vector<double> values;
  TextTable now;
  const auto close = [&] {
    if (now.rows > best.rows) best = now;
    now = {};
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    bool row = is_row(lines[i].text, dialect, kinds, values);
    if (row && now.rows > 0) {
      row = kinds.size() == now.columns;
      for (std::size_t c = 0; row && c < kinds.size(); ++c) row = alike(kinds[c], now.kinds[c]);
    }
    if (!row) {
      close();
      // The line that ends one run of rows may begin another.
      if (!is_row(lines[i].text, dialect, kinds, values)) continue;
    }
    if (now.rows == 0) {
      now.dialect = dialect;
      now.first = i;
      now.columns = kinds.size();
      now.kinds = kinds;
      now.head.assign(kinds.size(), {});
    }
    ++now.rows;
    for (std::size_t c = 0; c < kinds.size(); ++c) {
      if (now.kinds[c] == FieldKind::missing) now.kinds[c] = kinds[c];
      if (now.head[c].size() < kHeadRows) now.head[c].push_back(values[c]);
    }
    if (now.rows >= kHeadRows && now.rows > 2 * best.rows) break;  // this is the table
  }
  close();
  return best;
}

bool same_numbers(const TextTable& a, const TextTable& b) {
  if (a.first != b.first || a.columns != b.columns) return false;
  for (std::size_t c = 0; c < a.columns; ++c) {
    for (std::size_t k = 0; k < std::min(a.head[c].size(), b.head[c].size()); ++k) {
      const double x = a.head[c][k];
      const double y = b.head[c][k];
      if (!(x == y || (std::isnan(x) && std::isnan(y)))) return false;
    }
  }
  return true;
}

std::string words(const TextDialect& dialect) {
  return std::string(separator_words(dialect)) + " with " + decimal_words(dialect);
}

[[noreturn]] void refuse_text(const std::vector<TextLine>& lines, const std::string& name) {
  // A table whose header can be told, and nothing below it.
  std::size_t filled = 0;
  for (const TextLine& line : lines) filled += trimmed(line.text).empty() ? 0 : 1;
  if (filled <= 1) throw bad_data(name, "has a header but no data");
  throw bad_data(name,
                 "holds no table of numbers, separated by commas, semicolons, tabs or "
                 "blanks",
                 "text with columns of numbers, a MAT file or an LCM event log");
}

}  // namespace

const char* separator_words(const TextDialect& dialect) {
  switch (dialect.separator) {
    case ',':
      return "commas";
    case ';':
      return "semicolons";
    case '\t':
      return "tabs";
    case '|':
      return "bars";
    default:
      return "blanks";
  }
}

const char* decimal_words(const TextDialect& dialect) {
  return dialect.decimal == ',' ? "decimal commas" : "decimal points";
}

FieldKind kind_of(std::string_view field, char decimal, double& value) {
  value = std::numeric_limits<double>::quiet_NaN();
  if (is_missing(field)) return FieldKind::missing;
  if (parse_number(field, decimal, value)) return FieldKind::number;
  if (parse_clock(field, value)) return FieldKind::clock;
  return FieldKind::text;
}

TextTable find_table(const std::vector<TextLine>& lines, const std::string& name) {
  constexpr std::array<TextDialect, 10> kDialects{{{',', '.'},
                                                   {';', '.'},
                                                   {';', ','},
                                                   {'\t', '.'},
                                                   {'\t', ','},
                                                   {' ', '.'},
                                                   {' ', ','},
                                                   {',', ','},
                                                   {'|', '.'},
                                                   {'|', ','}}};
  std::vector<TextTable> tables;
  for (const TextDialect& dialect : kDialects) {
    TextTable table = table_in(lines, dialect);
    if (table.rows > 0) tables.push_back(std::move(table));
  }
  if (tables.empty()) refuse_text(lines, name);
  const auto best =
      std::max_element(tables.begin(), tables.end(), [](const TextTable& a, const TextTable& b) {
        return a.rows < b.rows || (a.rows == b.rows && a.first > b.first);
      });
  // As many rows, read in another way, with other numbers.
  for (const TextTable& other : tables) {
    if (&other == &*best || other.rows < best->rows || same_numbers(other, *best)) continue;
    if (other.dialect.separator == ' ' && best->dialect.separator == '\t') continue;
    throw bad_data(
        name + ":" + std::to_string(best->first + 1),
        "can be read in two ways, " + words(best->dialect) + " and " + words(other.dialect),
        "one separator that is not the decimal sign too");
  }
  return *best;
}

}  // namespace config::record
