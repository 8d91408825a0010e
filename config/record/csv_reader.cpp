#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "config/record/assembly.h"
#include "config/record/column_roles.h"
#include "config/record/layout.h"
#include "config/record/readers.h"
#include "config/record/record.h"
#include "config/record/row_reader.h"
#include "config/record/text_form.h"
#include "config/record/text_window.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"

namespace config::record {
namespace {

/// "has 'Faktor' '0.001' in line 3"
std::string factors_in(const std::vector<PassedLine>& stated) {
  std::string words;
  for (const PassedLine& factor : stated) {
    words += (words.empty() ? "has " : " and ") + factor.text + " in line " +
             std::to_string(factor.line);
  }
  return words;
}

FileHead columns_of(const TextForm& form, const std::string& name) {
  FileHead head;
  const std::size_t line = form.header_line > 0 ? form.header_line : form.data_line;
  head.where = name + ":" + std::to_string(line);
  head.step_s = form.step_s;
  head.stated_step_s = form.stated_step_s;
  for (std::size_t i = 0; i < form.kinds.size(); ++i) {
    FileColumn column;
    if (!form.names.empty()) column.header = form.names[i];
    if (!form.units.empty()) column.unit = form.units[i];
    if (!form.factors.empty()) column.factor = factors_in(form.factors[i]);
    if (form.cell_units[i].any()) column.unit = form.cell_units[i].unit().text;
    column.numbers = form.kinds[i] == FieldKind::number ||
                     (form.kinds[i] == FieldKind::missing && !column.header.empty());
    column.clock = form.kinds[i] == FieldKind::clock;
    column.setting = form.cell_units[i].doubtful() && form.cell_units[i].glued();
    column.sample = form.head[i];
    std::erase_if(column.sample, [](double value) { return std::isnan(value); });
    head.columns.push_back(std::move(column));
  }
  return head;
}

std::string words_of(const TextForm& form) {
  std::string words = std::string(separator_words(form.dialect)) + " between columns, ";
  std::vector<std::string> others;
  for (std::size_t i = 0; i < form.decimals.size(); ++i) {
    if (form.decimals[i].decimal != form.dialect.decimal) others.push_back(std::to_string(i + 1));
  }
  const TextDialect commas{form.dialect.separator, ','};
  if (!others.empty() && others.size() == form.decimals.size()) {
    words += decimal_words(commas);
  } else {
    words += decimal_words(form.dialect);
    if (!others.empty()) {
      words += std::string(" and ") + decimal_words(commas) + " (columns " +
               schema::joined(others) + ")";
    }
  }
  if (form.header_line > 0) words += ", names in line " + std::to_string(form.header_line);
  if (form.unit_line > 0) words += ", units in line " + std::to_string(form.unit_line);
  if (std::any_of(form.cell_units.begin(), form.cell_units.end(),
                  [](const CellUnits& cells) { return cells.any(); })) {
    words += ", units in the cells";
  }
  return words + ", numbers from line " + std::to_string(form.data_line);
}

/// "line 3 'min;-10;-100', line 4 'max;10;100'"
std::string lines_in(const std::vector<PassedLine>& passed) {
  return schema::joined_by(passed, [](const PassedLine& line) {
    return "line " + std::to_string(line.line) + " " + record::quoted(line.text);
  });
}

std::string column_words(const TextForm& form, std::size_t column) {
  return form.names.empty() || form.names[column].empty() ? std::to_string(column + 1)
                                                          : form.names[column];
}

/// The first lines of a text, as many as its form is told from.
std::string_view first_lines(TextWindow& window, const std::string& name) {
  const auto lines = [&window] { return std::count(window.begin(), window.end(), '\n'); };
  if (window.text().empty() && !window.last()) throw too_long(name + ":1", window);
  while (lines() <= kMostFormLines && window.extend()) {
  }
  return window.text();
}

std::size_t byte_order_mark(std::string_view text) {
  return text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
}

/// Excel's first line: "sep=;".
std::size_t separator_line(std::string_view text) {
  if (!text.starts_with("sep=") && !text.starts_with("\"sep=")) return 0;
  const std::size_t end = text.find('\n');
  return end != std::string_view::npos && end <= 10 ? end + 1 : 0;
}

/// Counts the times of all columns of date and time from the earliest that begins.
void begin_clocks_together(const TextForm& form, std::vector<std::vector<double>>& columns) {
  const auto for_clocks = [&](const auto& work) {
    for (std::size_t i = 0; i < form.kinds.size(); ++i) {
      if (form.kinds[i] == FieldKind::clock) work(columns[i]);
    }
  };
  double begin_s = std::numeric_limits<double>::infinity();
  for_clocks([&](const std::vector<double>& times) {
    const auto first = std::find_if(times.begin(), times.end(),
                                    [](double time_s) { return std::isfinite(time_s); });
    if (first != times.end()) begin_s = std::min(begin_s, *first);
  });
  for_clocks([&](std::vector<double>& times) {
    for (double& time_s : times) time_s -= begin_s;
  });
}

/// Takes further columns whose numbers have two readings out of the layout, and names them. Throws
/// where it is time, command or position.
std::string leave_out_ambiguous(const TextForm& form, const std::string& name, Layout& layout) {
  const auto is_ambiguous = [&](std::size_t column) {
    return form.kinds[column] == FieldKind::number && !form.decimals[column].ambiguous.empty();
  };
  std::string left_out;
  std::erase_if(layout.channels, [&](const Channel& channel) {
    std::size_t column = channel.column;
    if (channel.times != Channel::kSharedTimes && is_ambiguous(channel.times)) {
      column = channel.times;
    }
    if (!is_ambiguous(column)) return false;
    if (channel.role != Role::further) {
      throw schema::bad_data(name + ":" + std::to_string(form.data_line),
                             "column " + column_words(form, column) + ": " +
                                 record::quoted(form.decimals[column].ambiguous) +
                                 " has two readings, with a decimal comma or with thousands",
                             kOneReading);
    }
    left_out += (left_out.empty() ? "" : ", ") + column_words(form, column);
    return true;
  });
  return left_out;
}

}  // namespace

Record read_csv(TextWindow& window, const std::string& name, const ReadOptions& options) {
  const std::vector<MapEntry> map = parse_map(options.map);
  const std::string_view text = first_lines(window, name);
  const std::size_t mark = byte_order_mark(text);
  const std::size_t passed = separator_line(text.substr(mark));
  TextForm form = find_form(text.substr(mark + passed), name);
  form.data_offset += mark + passed;
  for (std::size_t* line : {&form.data_line, &form.header_line, &form.unit_line}) {
    if (passed > 0 && *line > 0) ++*line;
  }
  for (PassedLine& line : form.passed) line.line += passed > 0 ? 1 : 0;
  for (std::vector<PassedLine>& factors : form.factors) {
    for (PassedLine& factor : factors) factor.line += passed > 0 ? 1 : 0;
  }
  const FileHead head = columns_of(form, name);
  Layout layout = understand(head, map, options.position_optional);
  const std::string left_out = leave_out_ambiguous(form, name, layout);
  std::vector<RowReader::Action> actions(form.kinds.size(), RowReader::Action::skip);
  const auto wanted = [&](std::size_t column) {
    actions[column] = form.kinds[column] == FieldKind::clock ? RowReader::Action::clock
                                                             : RowReader::Action::number;
  };
  for (const Channel& channel : layout.channels) {
    wanted(channel.column);
    const bool setting =
        channel.role == Role::further && form.cell_units[channel.column].doubtful();
    if (setting) actions[channel.column] = RowReader::Action::setting;
    if (channel.times != Channel::kSharedTimes) wanted(channel.times);
  }
  RowReader rows(window, name, form, actions);
  FileValues values;
  values.name = name;
  values.values = rows.read();
  std::string settings;
  std::erase_if(layout.channels, [&](const Channel& channel) {
    const std::size_t line = rows.left_out_at(channel.column);
    if (line == 0) return false;
    settings += (settings.empty() ? "" : ", ") + rows.column_name(channel.column) + " (line " +
                std::to_string(line) + ")";
    return true;
  });
  values.place = [&](std::size_t row) { return name + ":" + std::to_string(rows.line_of(row)); };
  values.header = [&](std::size_t column) { return rows.column_name(column); };
  begin_clocks_together(form, values.values);
  Record record = assemble(layout, std::move(values), options);
  record.form = words_of(form);
  std::string words;
  for (std::size_t i = 0; i < form.kinds.size(); ++i) {
    if (form.kinds[i] != FieldKind::text) continue;
    words += (words.empty() ? "" : ", ") + rows.column_name(i);
  }
  if (!words.empty()) record.notes.push_back("left out, no numbers: " + words);
  if (!settings.empty()) record.notes.push_back("left out, not all numbers: " + settings);
  if (!form.passed.empty()) {
    record.notes.push_back("left out, neither names nor a row: " + lines_in(form.passed));
  }
  if (const auto& [line, comment] = rows.comment(); line > 0) {
    record.notes.push_back("a comment below the first row is left out: line " +
                           std::to_string(line) + " " + record::quoted(comment));
  }
  if (!left_out.empty()) {
    record.notes.push_back("left out, '1,234' there has two readings: " + left_out);
  }
  if (rows.open_end()) {
    record.notes.emplace_back("the last line has no line end: its last number may be cut off");
  }
  return record;
}

}  // namespace config::record
