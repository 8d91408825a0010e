#include "config/record/own_form.h"

#include <algorithm>
#include <string>

#include "config/record/layout.h"
#include "config/record/limit_line.h"
#include "config/record/text_fields.h"
#include "config/record/unit_cells.h"
#include "config/record/unit_line.h"
#include "config/record/unit_text.h"

namespace config::record {
namespace {

/// A number such as "1,25" or "1,234.5" below the first line.
bool has_quoted_comma(const std::vector<TextLine>& lines) {
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].text.find('"') == std::string_view::npos) continue;
    for (const std::string& field : split_fields(lines[i].text, ',')) {
      double value = 0.0;
      if (field.find(',') != std::string::npos &&
          (parse_number(field, '.', value) || parse_number(field, ',', value))) {
        return true;
      }
    }
  }
  return false;
}

/// A number, or a gap, with a unit behind it below the first line.
bool has_unit_cells(const std::vector<TextLine>& lines) {
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::string_view line = lines[i].text;
    if (line.find_first_not_of("0123456789+-.,eE\" \t") == std::string_view::npos) continue;
    const std::vector<std::string> fields = split_fields(line, ',');
    if (std::any_of(fields.begin(), fields.end(), [](const std::string& field) {
          return unit_cell(field).has_value() || is_missing_cell(field);
        })) {
      return true;
    }
  }
  return false;
}

/// A line of units or limits; "1,1,1" is a row.
bool is_no_row(const std::vector<std::string>& fields) {
  const bool numbers = std::all_of(fields.begin(), fields.end(), [](const std::string& field) {
    double value = 0.0;
    return is_missing(field) || parse_number(field, '.', value);
  });
  return !numbers && (is_unit_line(fields) || is_limit_line(fields, '.'));
}

}  // namespace

std::optional<TextForm> own_form(std::string_view text, const std::vector<TextLine>& lines) {
  if (lines.empty() || trimmed(lines[0].text).empty()) return std::nullopt;
  const std::vector<std::string> names = split_fields(lines[0].text, ',');
  bool time = false;
  bool command = false;
  bool position = false;
  for (const std::string& name : names) {
    const RecordColumn column = parse_column(name);
    time = time || (is_time(column) && column.si_unit == "s");
    command = command || (column.stem == "u" && column.si_unit == "V");
    position = position || (column.stem == "y" && column.si_unit == "m");
  }
  if (!time || !command || !position) return std::nullopt;
  if (has_quoted_comma(lines) || has_unit_cells(lines)) return std::nullopt;
  TextForm form;
  form.header_line = 1;
  form.names = names;
  for (std::string& name : form.names) name = utf8_text(name);
  form.kinds.assign(names.size(), FieldKind::number);
  form.head.resize(names.size());
  form.decimals.resize(names.size());
  form.cell_units.resize(names.size());
  form.data_line = 2;
  form.data_offset = lines.size() > 1 ? lines[1].offset : text.size();
  if (lines.size() == 1) return form;
  const std::vector<std::string> fields = split_fields(lines[1].text, ',');
  if (fields.size() == names.size() && is_no_row(fields)) return std::nullopt;
  // A column of words beside the three is left out, as in any other file.
  for (std::size_t i = 0; i < std::min(fields.size(), names.size()); ++i) {
    double value = 0.0;
    const bool word = kind_of(fields[i], '.', value) == FieldKind::text &&
                      std::none_of(fields[i].begin(), fields[i].end(), is_digit);
    if (word && !is_main(parse_column(names[i]))) form.kinds[i] = FieldKind::text;
  }
  return form;
}

}  // namespace config::record
