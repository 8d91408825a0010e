#include "config/record/text_form.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "config/record/column_unit.h"
#include "config/record/column_words.h"
#include "config/record/damaged_row.h"
#include "config/record/layout.h"
#include "config/record/limit_line.h"
#include "config/record/own_form.h"
#include "config/record/row_preamble.h"
#include "config/record/stated_step.h"
#include "config/record/text_fields.h"
#include "config/record/unit_line.h"
#include "config/record/unit_text.h"
#include "config/schema/error.h"

namespace config::record {
namespace {

using schema::bad_data;

class FormFinder {
 public:
  FormFinder(std::string_view text, const std::string& name) : text_(text), name_(name) {
    std::size_t at = 0;
    while (at < text.size() && lines_.size() < static_cast<std::size_t>(kMostFormLines)) {
      std::size_t end = text.find('\n', at);
      if (end == std::string_view::npos) end = text.size();
      std::string_view line = text.substr(at, end - at);
      if (line.ends_with('\r')) line.remove_suffix(1);
      lines_.push_back({line, at});
      at = end + 1;
    }
  }

  TextForm form() {
    if (trimmed(text_.substr(0, 4096)).find_first_not_of(" \t\r\n") == std::string_view::npos &&
        text_.find_first_not_of(" \t\r\n") == std::string_view::npos) {
      throw bad_data(name_, "is empty", "CSV with a header t_s,u_V,y_m");
    }
    if (std::optional<TextForm> own = own_form(text_, lines_)) return *std::move(own);
    TextTable table = find_table(lines_, name_);
    take_preamble_rows(lines_, table);
    form_.dialect = table.dialect;
    form_.kinds = table.kinds;
    form_.head = table.head;
    form_.decimals = table.decimals;
    form_.cell_units = table.cell_units;
    form_.data_line = table.first + 1;
    form_.data_offset = lines_[table.first].offset;
    first_ = table.first;
    name_columns();
    read_preamble();
    for (std::size_t c = 0; c < form_.kinds.size(); ++c) settle_unit(form_, c, name_);
    return form_;
  }

 private:
  // --- names and units above the first row

  static std::string_view without_comment_mark(std::string_view line) {
    line = trimmed(line);
    while (!line.empty() &&
           std::string_view("#%!*/").find(line.front()) != std::string_view::npos) {
      line.remove_prefix(1);
    }
    return trimmed(line);
  }

  /// Fields of a header line: in blank-separated text a bracketed unit belongs to the word before.
  [[nodiscard]] std::vector<std::string> header_fields(std::string_view line) const {
    std::vector<std::string> fields = split_fields(line, form_.dialect.separator);
    if (form_.dialect.separator != ' ') return fields;
    std::vector<std::string> joined;
    bool open = false;
    for (std::string& field : fields) {
      const bool unit = !field.empty() && (field.front() == '[' || field.front() == '(');
      if ((unit || open) && !joined.empty()) {
        joined.back() += " " + field;
      } else {
        joined.push_back(std::move(field));
      }
      const std::string& last = joined.back();
      open = std::count(last.begin(), last.end(), '[') + std::count(last.begin(), last.end(), '(') >
             std::count(last.begin(), last.end(), ']') + std::count(last.begin(), last.end(), ')');
    }
    return joined;
  }

  /// Names of `line`, cut or filled to the number of columns; false: they are of another number.
  bool names_in(std::string_view line, std::vector<std::string>& names) const {
    names = header_fields(line);
    const std::size_t columns = form_.kinds.size();
    if (names.size() == columns) return true;
    if (names.size() == columns + 1) {  // LabVIEW's "Comment", a separator at the line's end
      const std::string last = lower(names.back());
      if (!last.empty() && last != "comment") return false;
      names.pop_back();
      return true;
    }
    if (names.size() + 1 == columns && counts_rows(line, names.size())) {
      names.insert(names.begin(), "");
      return true;
    }
    const bool open_end = form_.kinds.back() == FieldKind::missing && names.size() + 1 == columns;
    if (open_end) names.emplace_back();
    return open_end;
  }

  /// True for R's tables: every name quoted, none for the column of row numbers.
  [[nodiscard]] bool counts_rows(std::string_view line, std::size_t names) const {
    if (std::count(line.begin(), line.end(), '"') != static_cast<std::ptrdiff_t>(2 * names)) {
      return false;
    }
    const std::vector<double>& numbers = form_.head.front();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i] != static_cast<double>(i + 1)) return false;
    }
    return numbers.size() > 1;
  }

  /// How many of time, command and position a line of names gives.
  static int words_known(const std::vector<std::string>& names) {
    int known = 0;
    for (const std::string& name : names) known += parse_header(name).unit.known() ? 2 : 0;
    for (const std::string& name : names) {
      known += std::any_of(name.begin(), name.end(),
                           [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; })
                   ? 1
                   : 0;
    }
    return known;
  }

  /// True where the upper of two lines is the one of names: a title has units behind numbers
  /// ("Pump 140 bar") and less of time, command and position.
  static bool names_more(const std::vector<std::string>& upper,
                         const std::vector<std::string>& lower) {
    if (words_known(upper) <= words_known(lower)) return false;
    const bool value = std::any_of(upper.begin(), upper.end(), [](const std::string& field) {
      const HeaderText text = parse_header(field);
      return text.unit.known() && is_digit(text.name.back()) && field.ends_with(text.unit.text);
    });
    return !value || roles_named(upper) >= roles_named(lower);
  }

  /// A line of as many fields as the rows, directly above them; blank lines between are passed.
  struct Candidate {
    std::size_t line = 0;
    std::vector<std::string> names;
    bool units = false;
    bool limits = false;
    bool commented = false;
  };

  [[nodiscard]] std::vector<Candidate> lines_above() const {
    std::vector<Candidate> above;
    for (std::size_t i = first_; i-- > 0 && first_ - i < 12;) {
      std::string_view line = lines_[i].text;
      if (trimmed(line).empty()) continue;
      std::vector<std::string> names;
      const bool commented =
          std::string_view("#%!").find(trimmed(line).front()) != std::string_view::npos;
      // "# t_s u_V y_m": the mark names no column.
      const bool fits = names_in(commented ? without_comment_mark(line) : line, names);
      if (!fits) {
        if (above.empty() && commented) continue;  // a comment between header and rows
        break;
      }
      const bool limits = is_limit_line(names, form_.dialect.decimal);
      above.push_back({i, names, is_unit_line(names), limits, commented});
    }
    return above;
  }

  void name_columns() {
    const std::vector<Candidate> above = lines_above();
    const Candidate* units = nullptr;
    const Candidate* header = nullptr;
    const Candidate* below_units = nullptr;  // words between a line of units and the rows
    const auto has_units = [](const Candidate& line) {
      return std::any_of(line.names.begin(), line.names.end(),
                         [](const std::string& name) { return parse_header(name).unit.known(); });
    };
    for (const Candidate& candidate : above) {
      if (candidate.limits) continue;
      if (candidate.units && units == nullptr && (header == nullptr || !has_units(*header))) {
        units = &candidate;
        below_units = std::exchange(header, nullptr);
      } else if (words_known(candidate.names) > 0 &&
                 (header == nullptr || names_more(candidate.names, header->names))) {
        header = &candidate;
      }
    }
    if (header == nullptr && units != nullptr) {  // "t;u;y" would not be units; "s;V;m" are names
      header = below_units != nullptr ? below_units : units;
      units = nullptr;
    }
    if (units != nullptr) {
      form_.units = units->names;
      for (std::string& unit : form_.units) unit = clean_text(unit);
      if (leads_units(form_.units.front())) form_.units.front().clear();
      form_.unit_line = units->line + 1;
    }
    refuse_units_of_first_row(above);
    note_factors(header, units);
    for (auto each = above.rbegin(); each != above.rend(); ++each) {  // in the order of the file
      const Candidate& candidate = *each;
      if (&candidate == units || candidate.commented) continue;
      if (header != nullptr && candidate.line < header->line) continue;
      if (!candidate.limits || leads_to_rows(candidate.names, rows_below(header != nullptr))) {
        require_no_row(candidate.line, candidate.names, header == &candidate ? nullptr : header);
      }
      if (header != nullptr ? header != &candidate : candidate.limits) {
        const std::string_view text = trimmed(lines_[candidate.line].text);
        form_.passed.push_back({candidate.line + 1, std::string(text)});
      }
    }
    if (header == nullptr) return;
    require_no_rows_above(*header, above);
    form_.names = header->names;
    for (std::string& name : form_.names) name = clean_text(name);
    form_.header_line = header->line + 1;
  }

  /// Refuses a line of numbers with units between names and rows of numbers without.
  void refuse_units_of_first_row(const std::vector<Candidate>& above) const {
    if (above.size() < 2) return;
    std::size_t with_unit = 0;
    for (const std::string& field : above.front().names) {
      if (!unit_cell(field) && !is_missing(field)) return;
      with_unit += unit_cell(field) ? 1 : 0;
    }
    if (with_unit < 2) return;
    throw bad_data(name_ + ":" + std::to_string(above.front().line + 1),
                   record::quoted(trimmed(lines_[above.front().line].text)) +
                       " has units in its cells, the rows below have none",
                   kOneUnit);
  }

  /// Notes the factors and offsets of the lines above the rows, by column where there are as many
  /// fields, or one more for the word in front. Other lines name no column: they are reported.
  void note_factors(const Candidate* header, const Candidate* units) {
    for (std::size_t i = 0; i < first_; ++i) {
      if ((header != nullptr && header->line == i) || (units != nullptr && units->line == i)) {
        continue;
      }
      std::vector<std::string> fields;
      const std::string_view line = without_comment_mark(lines_[i].text);
      const bool aligned = names_in(line, fields);
      std::vector<std::string> stated;
      if (aligned || fields.size() == form_.kinds.size() + 1) {
        stated = stated_factors(fields, form_.dialect.decimal);
      }
      if (!aligned && !stated.empty() && stated.front().empty()) {
        stated.erase(stated.begin());
      } else if (!aligned) {
        if (states_factor(line, form_.dialect.separator, form_.dialect.decimal)) {
          form_.passed.push_back({i + 1, std::string(trimmed(lines_[i].text))});
        }
        continue;
      }
      if (stated.empty()) continue;
      form_.factors.resize(form_.kinds.size());
      for (std::size_t c = 0; c < stated.size(); ++c) {
        if (!stated[c].empty()) form_.factors[c].push_back({i + 1, stated[c]});
      }
    }
  }

  [[nodiscard]] RowsBelow rows_below(bool named) const {
    return {form_.dialect.decimal, form_.kinds, form_.head, named};
  }

  /// Refuses a line above the table that damaged fields keep from being a row. `header`: another
  /// line, which has the names; null: there is none.
  void require_no_row(std::size_t line, const std::vector<std::string>& fields,
                      const Candidate* header) const {
    const std::optional<std::size_t> damaged = damaged_field(fields, rows_below(header != nullptr));
    if (!damaged) return;
    const bool named = header != nullptr && !header->names[*damaged].empty();
    refuse_field(line, fields[*damaged], *damaged,
                 named ? clean_text(header->names[*damaged]) : std::to_string(*damaged + 1));
  }

  [[noreturn]] void refuse_field(std::size_t line, const std::string& field, std::size_t c,
                                 const std::string& column) const {
    const bool clock = form_.kinds[c] == FieldKind::clock;
    throw bad_data(name_ + ":" + std::to_string(line + 1),
                   "column " + column + ": " + record::quoted(field) +
                       (clock ? " is no date and time" : " is no number"));
  }

  /// Refuses a line of names amid rows: a row of which every field is damaged.
  void require_no_rows_above(const Candidate& header, const std::vector<Candidate>& above) const {
    const RowsBelow rows = rows_below(false);
    for (std::size_t i = 1; i < above.size(); ++i) {
      if (above[i - 1].line >= header.line) continue;
      if (!are_rows(above[i].names, above[i - 1].names, rows)) continue;
      std::size_t c = 0;
      const auto fits = [&](std::size_t column) {
        double value = 0.0;
        return cell_kind(header.names[column], form_.dialect.decimal, value) == form_.kinds[column];
      };
      while (c + 1 < header.names.size() && fits(c)) ++c;
      refuse_field(header.line, header.names[c], c, std::to_string(c + 1));
    }
  }

  /// Reads LabVIEW's tags in the lines above the table: the period, the channels' units.
  void read_preamble() {
    const std::size_t end = form_.header_line > 0 ? form_.header_line - 1 : first_;
    for (std::size_t i = 0; i < end; ++i) {
      std::vector<std::string> fields = split_fields(lines_[i].text, form_.dialect.separator);
      if (fields.empty()) continue;
      const std::string tag = lower(fields[0]);
      if (tag == "delta_x" && fields.size() > 1) {
        (void)parse_number(fields[1], form_.dialect.decimal, form_.step_s);
      } else if (tag == "y_unit_label" && form_.units.empty()) {
        // One label for each channel; the first column is time.
        form_.units.assign(form_.kinds.size(), "");
        for (std::size_t c = 1; c < std::min(fields.size(), form_.kinds.size()); ++c) {
          form_.units[c] = fields[c];
        }
        form_.unit_line = i + 1;
      } else if (tag == "x_dimension" && fields.size() > 1 && lower(fields[1]) == "time") {
        x_is_time_ = true;
      }
    }
    form_.stated_step_s = stated_step_s(lines_, end, form_.dialect);
    const bool labview = x_is_time_ && form_.header_line > 0 && !form_.names.empty() &&
                         folded(form_.names[0]) == "xvalue";
    if (!labview) {
      form_.step_s = 0.0;
      return;
    }
    if (form_.units.empty()) form_.units.assign(form_.kinds.size(), "");
    if (form_.kinds[0] == FieldKind::missing) {  // X_Columns No: the period alone
      form_.kinds[0] = FieldKind::text;
      return;
    }
    form_.units[0] = "s";
    form_.step_s = 0.0;
  }

  std::string_view text_;
  const std::string& name_;
  std::vector<TextLine> lines_;
  std::size_t first_ = 0;
  bool x_is_time_ = false;
  TextForm form_;
};

}  // namespace

TextForm find_form(std::string_view text, const std::string& name) {
  return FormFinder(text, name).form();
}

}  // namespace config::record
