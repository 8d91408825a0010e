#include "config/record/text_form.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "config/record/layout.h"
#include "config/record/unit_text.h"
#include "config/schema/error.h"

namespace config::record {
namespace {

using schema::bad_data;

constexpr std::size_t kHeadRows = 60;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

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

FieldKind kind_of(std::string_view field, char decimal, double& value) {
  value = std::numeric_limits<double>::quiet_NaN();
  if (is_missing(field)) return FieldKind::missing;
  if (parse_number(field, decimal, value)) return FieldKind::number;
  if (parse_clock(field, value)) return FieldKind::clock;
  return FieldKind::text;
}

struct Line {
  std::string_view text;  ///< without its end
  std::size_t offset = 0;
};

/// A candidate: how the lines read in one dialect.
struct Reading {
  TextDialect dialect;
  std::size_t first = 0;  ///< line of the first row, from 0
  std::size_t rows = 0;   ///< consecutive rows among the lines looked at
  std::size_t columns = 0;
  std::vector<FieldKind> kinds;
  std::vector<std::vector<double>> head;
};

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
    if (plain_header()) return form_;
    choose_dialect();
    name_columns();
    read_preamble();
    return form_;
  }

 private:
  // --- the project's own files: the first line has time, command and position by their names

  bool plain_header() {
    std::size_t first = 0;
    while (first < lines_.size() && trimmed(lines_[first].text).empty()) ++first;
    if (first == lines_.size() || first > 0) return false;
    const std::vector<std::string> names = split_fields(lines_[0].text, ',');
    bool time = false;
    bool command = false;
    bool position = false;
    for (const std::string& name : names) {
      const RecordColumn column = parse_column(name);
      time = time || (is_time(column) && column.si_unit == "s");
      command = command || (column.stem == "u" && column.si_unit == "V");
      position = position || (column.stem == "y" && column.si_unit == "m");
    }
    if (!time || !command || !position) return false;
    form_.header_line = 1;
    form_.names = names;
    form_.kinds.assign(names.size(), FieldKind::number);
    form_.head.resize(names.size());
    form_.data_line = 2;
    form_.data_offset = lines_.size() > 1 ? lines_[1].offset : text_.size();
    // A column of words beside the three is left out, as in any other file.
    if (lines_.size() > 1) {
      const std::vector<std::string> fields = split_fields(lines_[1].text, ',');
      for (std::size_t i = 0; i < std::min(fields.size(), names.size()); ++i) {
        double value = 0.0;
        const bool word = kind_of(fields[i], '.', value) == FieldKind::text &&
                          std::none_of(fields[i].begin(), fields[i].end(), is_digit);
        if (word && !is_main(parse_column(names[i]))) form_.kinds[i] = FieldKind::text;
      }
    }
    return true;
  }

  // --- other files

  /// Fields of a row; empty when the line is none. `kinds` of each.
  static bool is_row(const std::string_view line, const TextDialect& dialect,
                     std::vector<FieldKind>& kinds, std::vector<double>& values) {
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

  static bool alike(FieldKind a, FieldKind b) {
    return a == b || a == FieldKind::missing || b == FieldKind::missing;
  }

  [[nodiscard]] Reading reading_in(const TextDialect& dialect) const {
    Reading best;
    std::vector<FieldKind> kinds;
    std::vector<double> values;
    Reading now;
    const auto close = [&] {
      if (now.rows > best.rows) best = now;
      now = {};
    };
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      bool row = is_row(lines_[i].text, dialect, kinds, values);
      if (row && now.rows > 0) {
        row = kinds.size() == now.columns;
        for (std::size_t c = 0; row && c < kinds.size(); ++c) row = alike(kinds[c], now.kinds[c]);
      }
      if (!row) {
        close();
        // The line that ends one run of rows may begin another.
        if (!is_row(lines_[i].text, dialect, kinds, values)) continue;
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

  static bool same_numbers(const Reading& a, const Reading& b) {
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

  void choose_dialect() {
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
    std::vector<Reading> readings;
    for (const TextDialect& dialect : kDialects) {
      Reading reading = reading_in(dialect);
      if (reading.rows > 0) readings.push_back(std::move(reading));
    }
    if (readings.empty()) refuse_text();
    const auto best =
        std::max_element(readings.begin(), readings.end(), [](const Reading& a, const Reading& b) {
          return a.rows < b.rows || (a.rows == b.rows && a.first > b.first);
        });
    // As many rows, read in another way, with other numbers.
    for (const Reading& other : readings) {
      if (&other == &*best || other.rows < best->rows || same_numbers(other, *best)) continue;
      if (other.dialect.separator == ' ' && best->dialect.separator == '\t') continue;
      throw bad_data(
          place(best->first),
          "can be read in two ways, " + words(best->dialect) + " and " + words(other.dialect),
          "one separator that is not the decimal sign too");
    }
    form_.dialect = best->dialect;
    form_.kinds = best->kinds;
    form_.head = best->head;
    form_.data_line = best->first + 1;
    form_.data_offset = lines_[best->first].offset;
    first_ = best->first;
  }

  static std::string words(const TextDialect& dialect) {
    const char* const separator = dialect.separator == ','    ? "commas"
                                  : dialect.separator == ';'  ? "semicolons"
                                  : dialect.separator == '\t' ? "tabs"
                                  : dialect.separator == '|'  ? "bars"
                                                              : "blanks";
    return std::string(separator) + " with decimal " +
           (dialect.decimal == ',' ? "commas" : "points");
  }

  [[nodiscard]] std::string place(std::size_t line) const {
    return name_ + ":" + std::to_string(line + 1);
  }

  [[noreturn]] void refuse_text() const {
    // A table whose header can be told, and nothing below it.
    std::size_t filled = 0;
    for (const Line& line : lines_) filled += trimmed(line.text).empty() ? 0 : 1;
    if (filled <= 1) throw bad_data(name_, "has a header but no data");
    throw bad_data(name_,
                   "holds no table of numbers, separated by commas, semicolons, tabs or "
                   "blanks",
                   "text with columns of numbers, a MAT file or an LCM event log");
  }

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

  static bool is_unit_row(const std::vector<std::string>& fields) {
    std::size_t known = 0;
    for (const std::string& field : fields) {
      if (field.empty() || field == "-" || field == "[]" || field == "[-]" || field == "()")
        continue;
      const UnitText unit = parse_unit(field);
      if (!unit.known()) {
        const bool bracketed = field.front() == '[' || field.front() == '(';
        if (!bracketed) return false;
        continue;
      }
      ++known;
    }
    return known > 0;
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
    const bool open_end = form_.kinds.back() == FieldKind::missing && names.size() + 1 == columns;
    if (open_end) names.emplace_back();
    return open_end;
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

  void name_columns() {
    // Lines of as many fields as the rows, directly above them; blank lines between are passed.
    struct Candidate {
      std::size_t line = 0;
      std::vector<std::string> names;
      bool units = false;
    };
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
      above.push_back({i, names, is_unit_row(names)});
    }
    const Candidate* units = nullptr;
    const Candidate* header = nullptr;
    for (const Candidate& candidate : above) {
      const bool letters = words_known(candidate.names) > 0;
      if (candidate.units && header == nullptr && units == nullptr) {
        units = &candidate;
      } else if (letters &&
                 (header == nullptr || words_known(candidate.names) > words_known(header->names))) {
        header = &candidate;
      }
    }
    if (header == nullptr && units != nullptr) {  // "t;u;y" would not be units; "s;V;m" are names
      header = units;
      units = nullptr;
    }
    if (units != nullptr) {
      form_.units = units->names;
      form_.unit_line = units->line + 1;
    }
    if (header == nullptr) return;
    form_.names = header->names;
    for (std::string& name : form_.names) name = clean_text(name);
    form_.header_line = header->line + 1;
  }

  /// What the lines above the table state: LabVIEW's tags, "Sample rate: 1000 Hz".
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
  std::vector<Line> lines_;
  std::size_t first_ = 0;
  bool x_is_time_ = false;
  TextForm form_;
};

}  // namespace

TextForm find_form(std::string_view text, const std::string& name) {
  return FormFinder(text, name).form();
}

std::vector<std::string> split_fields(std::string_view line, char separator) {
  std::vector<std::string> fields;
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (separator == ' ') line = trimmed(line);
  std::size_t at = 0;
  while (true) {
    while (at < line.size() && line[at] != separator && is_blank(line[at])) ++at;
    std::string field;
    if (at < line.size() && line[at] == '"') {
      ++at;
      while (at < line.size()) {
        if (line[at] == '"' && at + 1 < line.size() && line[at + 1] == '"') {
          field += '"';
          at += 2;
        } else if (line[at] == '"') {
          ++at;
          break;
        } else {
          field += line[at++];
        }
      }
      field = std::string(trimmed(field));
    }
    const std::size_t begin = at;
    while (at < line.size() && line[at] != separator && !(separator == ' ' && is_blank(line[at]))) {
      ++at;
    }
    field += trimmed(line.substr(begin, at - begin));
    fields.push_back(std::move(field));
    if (at >= line.size()) return fields;
    ++at;
    if (separator == ' ') {
      while (at < line.size() && is_blank(line[at])) ++at;
    }
  }
}

bool is_missing(std::string_view field) {
  if (field.empty()) return true;
  if (field.size() > 9 || is_digit(field.front())) return field == "1.#QNAN" || field == "1.#IND";
  const std::string word = lower(field);
  for (const std::string_view missing :
       {"nan",  "-nan", "+nan", "nan(ind)", "-nan(ind)", "na",      "n/a",
        "#n/a", "#na",  "#nv",  "null",     "none",      "nil",     "-",
        "--",   "---",  "?",    "novalue",  "-1.#ind",   "#value!", "#div/0!"}) {
    if (word == missing) return true;
  }
  return false;
}

bool parse_number(std::string_view field, char decimal, double& value) {
  if (field.starts_with('+')) field.remove_prefix(1);
  if (field.empty() || !(is_digit(field.front()) || field.front() == '-' || field.front() == '.' ||
                         field.front() == ',')) {
    return false;
  }
  std::array<char, 64> buffer{};
  if (decimal == ',') {
    if (field.size() >= buffer.size()) return false;
    const std::size_t comma = field.find(',');
    // A point is no decimal sign here; before a comma it may group thousands: 1.234,5.
    if (comma == std::string_view::npos && field.find('.') != std::string_view::npos) return false;
    std::size_t size = 0;
    std::size_t group = 0;
    bool grouped = false;
    for (std::size_t i = 0; i < field.size(); ++i) {
      const char c = field[i];
      if (c == '.') {
        const bool in_place =
            i < comma && i > 0 && is_digit(field[i - 1]) && group <= 3 && (!grouped || group == 3);
        if (!in_place) return false;
        grouped = true;
        group = 0;
        continue;
      }
      if (i < comma && is_digit(c)) ++group;
      if (i == comma && grouped && group != 3) return false;
      if (i == comma && (i + 1 == field.size() || !is_digit(field[i + 1]))) return false;
      buffer[size++] = c == ',' ? '.' : c;
    }
    field = {buffer.data(), size};
  }
  const char* const end = field.data() + field.size();
  const auto result = std::from_chars(field.data(), end, value);
  if (result.ec == std::errc::result_out_of_range && result.ptr == end) {
    value = std::numeric_limits<double>::infinity();
    return true;
  }
  return result.ec == std::errc{} && result.ptr == end;
}

namespace {

/// Days since 1970-01-01 of the proleptic Gregorian calendar.
std::int64_t days_of(std::int64_t year, std::int64_t month, std::int64_t day) {
  year -= month <= 2 ? 1 : 0;
  const std::int64_t era = (year >= 0 ? year : year - 399) / 400;
  const std::int64_t year_of_era = year - era * 400;
  const std::int64_t day_of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  const std::int64_t day_of_era =
      year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
  return era * 146097 + day_of_era - 719468;
}

bool take_integer(std::string_view& text, std::size_t least, std::size_t most,
                  std::int64_t& value) {
  std::size_t digits = 0;
  while (digits < text.size() && digits < most && is_digit(text[digits])) ++digits;
  if (digits < least) return false;
  value = 0;
  for (std::size_t i = 0; i < digits; ++i) value = 10 * value + (text[i] - '0');
  text.remove_prefix(digits);
  return true;
}

bool take_char(std::string_view& text, char c) {
  if (text.empty() || text.front() != c) return false;
  text.remove_prefix(1);
  return true;
}

/// "12:34:56.789", "12:34:56,789", "1:02:03 PM"; the rest stays in `text`.
bool take_time_of_day(std::string_view& text, double& time_s) {
  std::int64_t hours = 0;
  std::int64_t minutes = 0;
  std::int64_t seconds = 0;
  if (!take_integer(text, 1, 2, hours) || !take_char(text, ':') ||
      !take_integer(text, 2, 2, minutes) || !take_char(text, ':') ||
      !take_integer(text, 2, 2, seconds)) {
    return false;
  }
  double fraction = 0.0;
  if (!text.empty() && (text.front() == '.' || text.front() == ',' || text.front() == ':') &&
      text.size() > 1 && is_digit(text[1])) {
    text.remove_prefix(1);
    double digit = 0.1;
    while (!text.empty() && is_digit(text.front())) {
      fraction += digit * (text.front() - '0');
      digit *= 0.1;
      text.remove_prefix(1);
    }
  }
  if (hours > 24 || minutes > 59 || seconds > 60) return false;
  std::string_view rest = trimmed(text);
  const std::string half = lower(rest.substr(0, 2));
  if (half == "pm" || half == "am") {
    if (hours < 1 || hours > 12) return false;
    hours = hours % 12 + (half == "pm" ? 12 : 0);
    rest.remove_prefix(2);
    text = rest;
  }
  time_s = static_cast<double>(hours * 3600 + minutes * 60 + seconds) + fraction;
  return true;
}

/// "2024-05-01", "2024/05/01", "01.05.2024", "05/01/2024". Day and month of the last are the same
/// to a record, which counts from its first sample; over a change of date they are not.
bool take_date(std::string_view& text, std::int64_t& days) {
  std::int64_t a = 0;
  std::int64_t b = 0;
  std::int64_t c = 0;
  std::string_view rest = text;
  if (!take_integer(rest, 1, 4, a) || rest.empty()) return false;
  const char mark = rest.front();
  if (mark != '-' && mark != '/' && mark != '.') return false;
  rest.remove_prefix(1);
  if (!take_integer(rest, 1, 2, b) || !take_char(rest, mark) || !take_integer(rest, 1, 4, c)) {
    return false;
  }
  if (a > 31) {
    if (b < 1 || b > 12 || c < 1 || c > 31) return false;
    days = days_of(a, b, c);
  } else {
    if (c < 70) c += 2000;
    const bool month_first = mark == '/' && a <= 12;
    const std::int64_t month = month_first ? a : b;
    const std::int64_t day = month_first ? b : a;
    if (month < 1 || month > 12 || day < 1 || day > 31) return false;
    days = days_of(c, month, day);
  }
  text = rest;
  return true;
}

}  // namespace

bool parse_clock(std::string_view field, double& time_s) {
  if (field.size() < 7 || field.size() > 40 || !is_digit(field.front())) return false;
  std::string_view text = field;
  std::int64_t days = 0;
  double seconds = 0.0;
  if (take_date(text, days)) {
    if (!text.empty() && (text.front() == 'T' || text.front() == ' ')) text.remove_prefix(1);
    text = trimmed(text);
    if (text.empty() || !take_time_of_day(text, seconds)) return false;
  } else if (!take_time_of_day(text, seconds)) {
    return false;
  }
  text = trimmed(text);
  const bool zone = text.empty() || text == "Z" || text == "UTC" ||
                    ((text.front() == '+' || text.front() == '-') && text.size() <= 6);
  if (!zone) return false;
  time_s = static_cast<double>(days) * 86400.0 + seconds;
  return true;
}

}  // namespace config::record
