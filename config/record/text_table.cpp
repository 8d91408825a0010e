#include "config/record/text_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "config/record/clock_text.h"
#include "config/record/layout.h"
#include "config/record/text_fields.h"
#include "config/schema/error.h"

namespace config::record {
namespace {

using schema::bad_data;

/// "2024-05-01", "01.05.2024": a word beside the times of day.
bool is_date(std::string_view field) {
  constexpr std::size_t kShortest = 8;
  double time_s = 0.0;
  return field.size() >= kShortest && parse_clock(std::string(field) + " 00:00:00", time_s);
}

/// Looks like a number that was cut apart or is written another way: no name of anything.
bool is_garbled(std::string_view field) {
  if (is_date(field)) return false;
  bool digit = false;
  for (const char c : field) {
    digit = digit || is_digit(c);
    if (!is_digit(c) && std::string_view("+-.,;:|eE \t'").find(c) == std::string_view::npos) {
      return false;
    }
  }
  return digit;
}

/// Several cells that another sign separates: "5 V;3", or that sign alone.
bool is_several(std::string_view field, char separator) {
  constexpr std::string_view kSeparators = ";|\t";
  if (separator == ' ' && field.find_first_not_of(";|,") == std::string_view::npos) return true;
  if (field.find_first_of(kSeparators) == std::string_view::npos) return false;
  while (true) {
    const std::size_t end = std::min(field.find_first_of(kSeparators), field.size());
    const std::string_view part = without_unit(trimmed(field.substr(0, end)));
    double value = 0.0;
    if (!part.empty() && !parse_number(part, '.', value) && !parse_number(part, ',', value)) {
      return false;
    }
    if (end == field.size()) return true;
    field.remove_prefix(end + 1);
  }
}

/// The fields of one row.
struct Row {
  std::vector<FieldKind> kinds;                ///< text for a number with a unit
  std::vector<std::optional<UnitCell>> units;  ///< refer to `fields`
  std::vector<double> values;  ///< in the dialect's decimals; "1,234" counts as thousands there
  std::vector<std::string> fields;

  [[nodiscard]] FieldKind kind(std::size_t c) const {
    return units[c] ? FieldKind::number : kinds[c];
  }
  [[nodiscard]] std::size_t with_unit() const {
    return static_cast<std::size_t>(std::count_if(
        units.begin(), units.end(), [](const auto& unit) { return unit.has_value(); }));
  }
  [[nodiscard]] std::string number(std::size_t c) const {
    return units[c] ? std::string(units[c]->number) : fields[c];
  }
};

/// Between commas a quoted number may have a comma of its own: each column says by all its numbers
/// what that is.
bool columns_decide(const std::vector<TextLine>& lines, const TextDialect& dialect) {
  const auto quotes = [](const TextLine& line) {
    return line.text.find('"') != std::string_view::npos;
  };
  return dialect.separator == ',' && dialect.decimal == '.' &&
         std::any_of(lines.begin(), lines.end(), quotes);
}

/// True for a row. A blank sets thousands apart where it cannot be between two columns.
bool is_row(const std::string_view line, const TextDialect& dialect, bool decides, Row& row) {
  row.kinds.clear();
  row.units.clear();
  row.values.clear();
  if (trimmed(line).empty()) return false;
  row.fields = split_fields(line, dialect.separator);
  const bool quotes = line.find('"') != std::string_view::npos;
  const bool blanks_group = (dialect.separator != ',' && dialect.separator != ' ') || quotes;
  std::size_t numbers = 0;
  std::size_t clocks = 0;
  for (const std::string& field : row.fields) {
    double value = 0.0;
    FieldKind kind = kind_of(field, dialect.decimal, value);
    std::optional<UnitCell> unit;
    if (kind == FieldKind::text) unit = unit_cell(field);
    const std::string_view text = unit ? unit->number : std::string_view(field);
    if (unit) kind = kind_of(text, dialect.decimal, value);
    if (kind == FieldKind::number && !blanks_group && text.find(' ') != std::string_view::npos) {
      return false;
    }
    if (kind == FieldKind::text && decides &&
        (parse_number(text, '.', value, LoneGroup::thousands) || parse_number(text, ',', value))) {
      kind = FieldKind::number;
    }
    if (kind == FieldKind::text && (is_garbled(text) || is_several(field, dialect.separator))) {
      return false;
    }
    numbers += kind == FieldKind::number ? 1 : 0;
    clocks += kind == FieldKind::clock ? 1 : 0;
    if (unit && kind != FieldKind::number) unit.reset();
    row.kinds.push_back(unit ? FieldKind::text : kind);
    row.units.push_back(std::move(unit));
    row.values.push_back(value);
  }
  return row.kinds.size() >= 2 && numbers >= 1 && numbers + clocks >= 2;
}

void decide(const std::vector<ColumnReading>& columns, TextTable& table) {
  bool comma = false;
  bool thousands = false;
  for (const ColumnReading& column : columns) {
    comma = comma || column.shows_comma();
    thousands = thousands || column.shows_thousands();
  }
  const char others = comma == thousands ? ' ' : comma ? ',' : '.';
  for (std::size_t c = 0; c < columns.size(); ++c) {
    table.decimals[c] = columns[c].decimals(others);
    if (table.decimals[c].decimal == ',') table.head[c] = columns[c].head(',');
  }
}

/// True where a cell goes on with a column. A unit that one cell has and another lacks ends no
/// table: it is refused.
bool goes_on(FieldKind column, const CellUnits& cells, FieldKind kind, bool has_unit) {
  if (column == FieldKind::missing || kind == FieldKind::missing) return true;
  if (has_unit && column == FieldKind::number) return true;
  if (kind == FieldKind::number && column == FieldKind::text) return !cells.words();
  return column == kind;
}

/// True where the first rows may show a setting or a name ("24V", "1A" and "2A"), not a
/// measurement: hardly two values, and never zero. `most`: as many values.
bool has_few_values(const std::vector<double>& head, std::size_t most) {
  constexpr std::size_t kFewestRows = 8;
  if (head.size() < kFewestRows) return false;
  std::set<double> values;
  for (const double value : head) {
    if (value == 0.0) return false;
    if (!std::isnan(value)) values.insert(value);
    if (values.size() > most) return false;
  }
  return true;
}

/// Columns whose cells are numbers with units become columns of numbers. Names do not; settings
/// are in doubt.
void take_units(TextTable& table) {
  constexpr std::size_t kMostSettings = 2;
  for (std::size_t c = 0; c < table.columns; ++c) {
    CellUnits& cells = table.cell_units[c];
    if (table.kinds[c] == FieldKind::text && has_few_values(table.head[c], kMostSettings)) {
      const bool setting = has_few_values(table.head[c], 1);
      if (cells.words() || (cells.glued() && !setting)) {
        cells = {};
      } else {
        cells.doubt();
      }
    }
    if (table.kinds[c] == FieldKind::text && cells.any()) table.kinds[c] = FieldKind::number;
    if (table.kinds[c] != FieldKind::text) continue;
    std::fill(table.head[c].begin(), table.head[c].end(), std::nan(""));
  }
}

/// The longest run of rows in one dialect.
TextTable table_in(const std::vector<TextLine>& lines, const TextDialect& dialect) {
  const bool decides = columns_decide(lines, dialect);
  TextTable best;
  Row fields;
  TextTable now;
  std::vector<ColumnReading> readings;
  const auto close = [&] {
    if (now.rows > best.rows) {
      if (decides) {
        decide(readings, now);
        now.rows = std::min(now.rows, kHeadRows);  // as many as other dialects count
      }
      take_units(now);
      best = now;
    }
    now = {};
  };
  bool named_as_units = false;
  const auto fits = [&] {
    if (fields.kinds.size() != now.columns) return false;
    if (now.rows == 1 && named_as_units && fields.with_unit() == 0) return false;  // "5V;12V"
    for (std::size_t c = 0; c < now.columns; ++c) {
      const bool has_unit = fields.units[c].has_value();
      if (!goes_on(now.kinds[c], now.cell_units[c], fields.kinds[c], has_unit)) return false;
    }
    for (std::size_t c = 0; decides && c < now.columns; ++c) {
      if (!readings[c].allows(fields.number(c), fields.kind(c))) return false;
    }
    return true;
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool row = is_row(lines[i].text, dialect, decides, fields);
    if (now.rows > 0 && !(row && fits())) close();
    if (!row) continue;
    if (now.rows == 0) {
      now.dialect = dialect;
      now.first = i;
      now.columns = fields.kinds.size();
      named_as_units = fields.with_unit() == now.columns;
      now.kinds = fields.kinds;
      now.head.assign(now.columns, {});
      now.decimals.assign(now.columns, {dialect.decimal, LoneGroup::refused, ""});
      now.cell_units.assign(now.columns, {});
      readings.assign(now.columns, {});
    }
    ++now.rows;
    for (std::size_t c = 0; c < fields.kinds.size(); ++c) {
      if (decides) readings[c].take(fields.number(c), fields.kind(c));
      const FieldKind kind = fields.kinds[c];
      const bool bare_behind_unit = now.kinds[c] == FieldKind::text && kind == FieldKind::number;
      if (now.kinds[c] == FieldKind::missing || bare_behind_unit) now.kinds[c] = kind;
      if (fields.kind(c) == FieldKind::number) {
        now.cell_units[c].take_number(fields.fields[c], fields.units[c], i + 1);
      } else if (kind == FieldKind::text) {
        now.cell_units[c].take_word(fields.fields[c], i + 1);
      } else if (const auto unit = missing_cell_unit(fields.fields[c])) {
        now.cell_units[c].take_missing(*unit);
      }
      if (now.head[c].size() < kHeadRows) now.head[c].push_back(fields.values[c]);
    }
    if (!decides && now.rows >= kHeadRows && now.rows > 2 * best.rows) break;  // the table
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

/// The line with most numbers that one field keeps from being a row, and that field.
struct NearRow {
  std::size_t line = 0;
  std::size_t numbers = 0;
  std::string field;
  TextDialect dialect;
};

NearRow near_row(const std::vector<TextLine>& lines, const std::vector<TextDialect>& dialects) {
  NearRow best;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const TextDialect& dialect : dialects) {
      NearRow now{i, 0, "", dialect};
      bool words = false;
      for (const std::string& field : split_fields(lines[i].text, dialect.separator)) {
        double value = 0.0;
        const FieldKind kind = cell_kind(field, dialect.decimal, value);
        now.numbers += kind == FieldKind::number ? 1 : 0;
        if (kind != FieldKind::text) continue;
        words = words || !is_garbled(without_unit(field)) || !now.field.empty();
        now.field = field;
      }
      if (!words && !now.field.empty() && now.numbers > best.numbers) best = now;
    }
  }
  return best;
}

[[noreturn]] void refuse_text(const std::vector<TextLine>& lines, const std::string& name,
                              const std::vector<TextDialect>& dialects) {
  // A table whose header can be told, and nothing below it.
  std::size_t filled = 0;
  for (const TextLine& line : lines) filled += trimmed(line.text).empty() ? 0 : 1;
  if (filled <= 1) throw bad_data(name, "has a header but no data");
  const NearRow near = near_row(lines, dialects);
  if (near.numbers > 0) {
    double value = 0.0;
    const bool two =
        parse_number(without_unit(near.field), near.dialect.decimal, value, LoneGroup::thousands);
    const std::string where = name + ":" + std::to_string(near.line + 1);
    double seconds = 0.0;
    if (near.field.find(':') != std::string::npos && parse_clock(near.field + ".0", seconds)) {
      throw bad_data(where,
                     record::quoted(near.field) +
                         " has two readings, hours and minutes or minutes "
                         "and seconds",
                     "seconds, hh:mm:ss or mm:ss.0");
    }
    throw bad_data(where,
                   record::quoted(near.field) + " " + (two ? "has two readings" : "is no number") +
                       " where " + words(near.dialect) + " are written",
                   two ? kOneReading : "one way of writing numbers in all columns");
  }
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
  return is_missing_cell(field) ? FieldKind::missing : FieldKind::text;
}

FieldKind cell_kind(std::string_view field, char decimal, double& value) {
  const FieldKind kind = kind_of(field, decimal, value);
  if (kind != FieldKind::text) return kind;
  const std::optional<UnitCell> cell = unit_cell(field);
  const bool number = cell && parse_number(cell->number, decimal, value);
  return number ? FieldKind::number : FieldKind::text;
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
  if (tables.empty()) refuse_text(lines, name, {kDialects.begin(), kDialects.end()});
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
