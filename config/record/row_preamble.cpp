#include "config/record/row_preamble.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

namespace config::record {
namespace {

/// Fields of a line that is a row, with or without texts beside it; empty: it is none.
std::vector<std::string> row_beside(std::string_view line, const TextTable& table) {
  std::vector<std::string> fields = split_fields(line, table.dialect.separator);
  if (fields.size() != table.columns) return {};
  for (std::size_t c = 0; c < fields.size(); ++c) {
    double value = 0.0;
    const FieldKind kind = kind_of(fields[c], table.dialect.decimal, value);
    const bool text = table.kinds[c] == FieldKind::missing || table.kinds[c] == FieldKind::text;
    if (!text && table.kinds[c] != kind) return {};
  }
  return fields;
}

/// True where the even steps of `values` lead back to `first`.
bool leads_to(double first, const std::vector<double>& values) {
  constexpr double kTolerance = 0.5;
  if (values.size() < 2) return false;
  const double step = values[1] - values[0];
  return step > 0.0 && std::abs(values[0] - first - step) < kTolerance * step;
}

}  // namespace

void take_preamble_rows(const std::vector<TextLine>& lines, TextTable& table) {
  const auto number = std::find(table.kinds.begin(), table.kinds.end(), FieldKind::number);
  if (number == table.kinds.end()) return;
  const auto time = static_cast<std::size_t>(number - table.kinds.begin());
  std::vector<std::size_t> texts;
  while (table.first > 0) {
    const std::vector<std::string> fields = row_beside(lines[table.first - 1].text, table);
    double value = 0.0;
    if (fields.empty()) break;
    (void)cell_kind(fields[time], table.dialect.decimal, value);
    if (!leads_to(value, table.head[time])) break;
    for (std::size_t c = 0; c < fields.size(); ++c) {
      (void)cell_kind(fields[c], table.dialect.decimal, value);
      table.head[c].insert(table.head[c].begin(), value);
      if (table.kinds[c] == FieldKind::missing && !fields[c].empty()) texts.push_back(c);
    }
    --table.first;
    ++table.rows;
  }
  for (const std::size_t c : texts) table.kinds[c] = FieldKind::text;
}

}  // namespace config::record
