#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "config/record/assembly.h"
#include "config/record/column_roles.h"
#include "config/record/layout.h"
#include "config/record/readers.h"
#include "config/record/record.h"
#include "config/record/text_form.h"
#include "config/record/text_window.h"
#include "config/record/unit_text.h"
#include "config/record/whole_file.h"
#include "config/schema/error.h"

namespace config::record {
namespace {

using schema::bad_data;

/// Digits after the decimal sign; 0 with an exponent of one digit, such as a cut leaves.
std::size_t decimals(std::string_view number, char decimal) {
  const std::size_t exponent = number.find_first_of("eE");
  if (exponent != std::string_view::npos) {
    const std::size_t digits = number.find_first_not_of("eE+-", exponent);
    if (digits == std::string_view::npos || number.size() - digits < 2) return 0;
    number = number.substr(0, exponent);
  }
  const std::size_t point = number.find(decimal);
  return point == std::string_view::npos ? 0 : number.size() - point - 1;
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

schema::DataError too_long(const std::string& place, const TextWindow& window) {
  return bad_data(place, "is longer than a line may be",
                  std::to_string(window.longest_line()) + " bytes");
}

/// The rows of a text file, read once from front to back.
class RowReader {
 public:
  enum class Action { skip, number, clock };

  /// `window` begins with the text.
  RowReader(TextWindow& window, const std::string& name, const TextForm& form,
            std::vector<Action> actions)
      : window_(window),
        name_(name),
        form_(form),
        separator_(form.dialect.separator),
        decimal_(form.dialect.decimal),
        actions_(std::move(actions)),
        at_(window.begin() + form.data_offset),
        end_(window.end()),
        line_(form.data_line),
        ends_with_newline_(window.ends_with_newline()) {
    values_.resize(actions_.size());
    reserve();
  }

  std::vector<std::vector<double>> read() {
    while (has_line() && is_row()) read_row();
    if (rows_ == 0) throw bad_data(name_, "has a header but no data");
    return std::move(values_);
  }

  [[nodiscard]] bool open_end() const { return open_end_; }

  /// The line of a row.
  [[nodiscard]] std::size_t line_of(std::size_t row) const {
    std::size_t line = form_.data_line + row;
    for (const auto& [from, count] : passed_) {
      if (from <= row) line += count;
    }
    return line;
  }

  [[nodiscard]] std::string column_name(std::size_t i) const {
    return form_.names.empty() || form_.names[i].empty() ? std::to_string(i + 1) : form_.names[i];
  }

 private:
  void reserve() {
    const char* at = at_;
    std::size_t lines = 0;
    while (lines < 100 && at < end_) {
      const char* const next = std::find(at, end_, '\n');
      ++lines;
      at = next == end_ ? end_ : next + 1;
    }
    if (lines == 0) return;
    const double bytes_a_line = static_cast<double>(at - at_) / static_cast<double>(lines);
    const auto rows = static_cast<std::size_t>(
        1.01 * static_cast<double>(window_.bytes_from(at_)) / std::max(2.0, bytes_a_line) + 16.0);
    for (std::size_t i = 0; i < actions_.size(); ++i) {
      if (actions_[i] != Action::skip) values_[i].reserve(rows);
    }
  }

  [[nodiscard]] std::string place() const { return name_ + ":" + std::to_string(line_); }

  /// At the beginning of a line: the whole line is in the window then. False at the text's end.
  bool has_line() {
    if (at_ < end_) return true;
    if (window_.last()) return false;
    window_.refill();
    at_ = window_.begin();
    end_ = window_.end();
    if (at_ == end_) throw too_long(place(), window_);
    return true;
  }

  void require_length(const char* line_begin, const char* line_end) const {
    if (static_cast<std::size_t>(line_end - line_begin) <= window_.longest_line()) return;
    throw too_long(place(), window_);
  }

  /// Only blank lines follow, to the end of the text; moves the window.
  bool only_blanks_follow(const char* line_end) {
    at_ = line_end;
    do {
      at_ = std::find_if(at_, end_, [](char c) { return !is_blank(c) && c != '\n'; });
      if (at_ < end_) return false;
    } while (has_line());
    return true;
  }

  /// Passes comments; false at the end of the rows. An empty line may only end the file.
  bool is_row() {
    do {
      const char* first = at_;
      while (first < end_ && is_blank(*first) && *first != separator_) ++first;
      if (first < end_ && *first != '\n' && *first != '#' && *first != '%' && *first != 'E') {
        return true;
      }
      const char* const line_end = std::find(first, end_, '\n');
      require_length(at_, line_end);
      if (first == end_) return false;
      const std::string_view line = trimmed({first, static_cast<std::size_t>(line_end - first)});
      if (line.empty() || line == "EOF") {
        const bool empty = line.empty();
        if (only_blanks_follow(line_end)) return false;
        throw bad_data(place(), empty ? "is an empty line" : "is EOF, but rows follow");
      }
      if (line.front() == 'E') return true;
      passed_.emplace_back(rows_, 1);
      ++line_;
      at_ = line_end == end_ ? end_ : line_end + 1;
    } while (has_line());
    return false;
  }

  void read_row() {
    row_begin_ = at_;
    std::size_t count = 0;
    const std::size_t columns = actions_.size();
    if (separator_ == ' ') skip_blanks();
    while (true) {
      field_begin_ = at_;
      const bool more = count < columns ? read_field(count) : pass_field();
      ++count;
      if (!more) break;
    }
    const char* const row_end = at_;
    require_length(row_begin_, row_end);
    const bool cut = at_ >= end_ && !ends_with_newline_;
    open_end_ = cut;
    if (at_ < end_) ++at_;  // the line's end
    if (count != columns || !ends_with_newline_) check_row(count, row_end, cut);
    ++rows_;
    ++line_;
  }

  void check_row(std::size_t count, const char* row_end, bool cut) {
    const std::size_t columns = actions_.size();
    const std::string_view last =
        trimmed({field_begin_, static_cast<std::size_t>(row_end - field_begin_)});
    const std::size_t digits = decimals(last, decimal_);
    if (count < columns || (cut && digits < fewest_decimals_ && rows_ > 0)) {
      throw bad_data(
          place(),
          (cut ? "is cut off: " : "has too few fields: ") +
              quoted(trimmed({row_begin_, static_cast<std::size_t>(row_end - row_begin_)})),
          std::to_string(columns) + " columns");
    }
    if (count > columns) {
      const bool twice = separator_ == ',' && count == 2 * columns;
      throw bad_data(place(), "has " + std::to_string(count) + " fields",
                     std::to_string(columns) +
                         (form_.names.empty() ? ", as in the rows before" : ", as in the header") +
                         (twice ? "; decimal commas need another separator" : ""));
    }
    fewest_decimals_ = std::min(fewest_decimals_, digits);
  }

  void skip_blanks() {
    while (at_ < end_ && is_blank(*at_) && *at_ != separator_) ++at_;
    if (separator_ == ' ') {
      while (at_ < end_ && is_blank(*at_)) ++at_;
    }
  }

  /// At the end of a field: passes the separator. False at the line's end.
  bool next_field() {
    if (at_ >= end_ || *at_ == '\n') return false;
    if (separator_ != ' ') {
      ++at_;
      return true;
    }
    skip_blanks();
    return at_ < end_ && *at_ != '\n';
  }

  [[nodiscard]] bool at_field_end() const {
    return at_ >= end_ || *at_ == '\n' || *at_ == separator_ ||
           (separator_ == ' ' && is_blank(*at_));
  }

  bool read_field(std::size_t column) {
    const Action action = actions_[column];
    if (action == Action::skip) return pass_field();
    if (action == Action::number && decimal_ == '.') {
      if (separator_ != ' ') {
        while (at_ < end_ && *at_ == ' ') ++at_;
      }
      double value = 0.0;
      const auto result = std::from_chars(at_, end_, value);
      if (result.ec == std::errc{} && std::isfinite(value)) {
        at_ = result.ptr;
        if (separator_ != ' ') {
          while (at_ < end_ && is_blank(*at_) && *at_ != separator_) ++at_;
        }
        if (at_field_end()) {
          values_[column].push_back(value);
          return next_field();
        }
      }
      at_ = field_begin_;
    }
    const std::string_view text = take_field();
    values_[column].push_back(action == Action::clock ? clock_in(text, column)
                                                      : number_in(text, column));
    return next_field();
  }

  bool pass_field() {
    (void)take_field();
    return next_field();
  }

  /// The text up to the field's end, blanks and quotes removed.
  std::string_view take_field() {
    skip_blanks();
    const char* from = at_;
    if (at_ < end_ && *at_ == '"') {
      const char* close = at_ + 1;
      while (close < end_ && *close != '\n' &&
             !(*close == '"' && (close + 1 == end_ || close[1] != '"'))) {
        close += *close == '"' ? 2 : 1;
      }
      if (close < end_ && *close == '"') {
        from = at_ + 1;
        at_ = close + 1;
        while (!at_field_end()) ++at_;
        return trimmed({from, static_cast<std::size_t>(close - from)});
      }
    }
    while (!at_field_end()) ++at_;
    return trimmed({from, static_cast<std::size_t>(at_ - from)});
  }

  double number_in(std::string_view text, std::size_t column) {
    double value = std::numeric_limits<double>::quiet_NaN();
    if (is_missing(text)) return value;
    if (!parse_number(text, decimal_, value)) {
      std::string word(text);
      for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      const bool infinite = word == "inf" || word == "-inf" || word == "+inf" ||
                            word == "infinity" || word == "-infinity";
      if (!infinite) {
        const bool cut = at_ >= end_ && !ends_with_newline_;
        throw bad_data(place(), "column " + column_name(column) + ": " + quoted(text) +
                                    (cut ? " is no number, or is cut off" : " is no number"));
      }
      value = std::numeric_limits<double>::infinity();
    }
    if (!std::isfinite(value)) {
      throw bad_data(place(), "column " + column_name(column) + " is " + quoted(text),
                     "finite numbers");
    }
    return value;
  }

  double clock_in(std::string_view text, std::size_t column) {
    double time_s = std::numeric_limits<double>::quiet_NaN();
    if (is_missing(text)) return time_s;
    if (!parse_clock(text, time_s)) {
      throw bad_data(
          place(), "column " + column_name(column) + ": " + quoted(text) + " is no date and time");
    }
    constexpr double kDay_s = 86400.0;
    // Times of day begin again at midnight.
    if (time_s < kDay_s && time_s + day_s_ < before_s_ - 0.5 * kDay_s) day_s_ += kDay_s;
    if (time_s < kDay_s) time_s += day_s_;
    before_s_ = time_s;
    return time_s;
  }

  TextWindow& window_;
  const std::string& name_;
  const TextForm& form_;
  const char separator_;
  const char decimal_;
  std::vector<Action> actions_;
  const char* at_;
  const char* end_;
  const char* row_begin_ = nullptr;
  const char* field_begin_ = nullptr;
  std::size_t line_;
  std::size_t rows_ = 0;
  std::vector<std::vector<double>> values_;
  std::vector<std::pair<std::size_t, std::size_t>> passed_;  ///< row, comments before it
  std::size_t fewest_decimals_ = std::numeric_limits<std::size_t>::max();
  double before_s_ = -std::numeric_limits<double>::infinity();
  double day_s_ = 0.0;
  bool ends_with_newline_;
  bool open_end_ = false;
};

FileHead columns_of(const TextForm& form, const std::string& name) {
  FileHead head;
  const std::size_t line = form.header_line > 0 ? form.header_line : form.data_line;
  head.where = name + ":" + std::to_string(line);
  head.step_s = form.step_s;
  for (std::size_t i = 0; i < form.kinds.size(); ++i) {
    FileColumn column;
    if (!form.names.empty()) column.header = form.names[i];
    if (!form.units.empty()) column.unit = form.units[i];
    column.numbers = form.kinds[i] == FieldKind::number ||
                     (form.kinds[i] == FieldKind::missing && !column.header.empty());
    column.clock = form.kinds[i] == FieldKind::clock;
    column.sample = form.head[i];
    std::erase_if(column.sample, [](double value) { return std::isnan(value); });
    head.columns.push_back(std::move(column));
  }
  return head;
}

std::string words_of(const TextForm& form) {
  std::string words;
  switch (form.dialect.separator) {
    case ',':
      words = "commas";
      break;
    case ';':
      words = "semicolons";
      break;
    case '\t':
      words = "tabs";
      break;
    case '|':
      words = "bars";
      break;
    default:
      words = "blanks";
      break;
  }
  words += std::string(" between columns, decimal ") +
           (form.dialect.decimal == ',' ? "commas" : "points");
  if (form.header_line > 0) words += ", names in line " + std::to_string(form.header_line);
  if (form.unit_line > 0) words += ", units in line " + std::to_string(form.unit_line);
  return words + ", numbers from line " + std::to_string(form.data_line);
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
  const FileHead head = columns_of(form, name);
  const Layout layout = understand(head, map, options.position_optional);
  std::vector<RowReader::Action> actions(form.kinds.size(), RowReader::Action::skip);
  const auto wanted = [&](std::size_t column) {
    actions[column] = form.kinds[column] == FieldKind::clock ? RowReader::Action::clock
                                                             : RowReader::Action::number;
  };
  for (const Channel& channel : layout.channels) {
    wanted(channel.column);
    if (channel.times != Channel::kSharedTimes) wanted(channel.times);
  }
  RowReader rows(window, name, form, actions);
  FileValues values;
  values.name = name;
  values.values = rows.read();
  values.place = [&](std::size_t row) { return name + ":" + std::to_string(rows.line_of(row)); };
  values.header = [&](std::size_t column) { return rows.column_name(column); };
  for (std::size_t i = 0; i < form.kinds.size(); ++i) {
    std::vector<double>& times = values.values[i];
    if (form.kinds[i] != FieldKind::clock || times.empty()) continue;
    const double begin_s = times.front();
    for (double& time_s : times) time_s -= begin_s;
  }
  Record record = assemble(layout, std::move(values), options);
  record.form = words_of(form);
  std::string words;
  for (std::size_t i = 0; i < form.kinds.size(); ++i) {
    if (form.kinds[i] != FieldKind::text) continue;
    words += (words.empty() ? "" : ", ") + rows.column_name(i);
  }
  if (!words.empty()) record.notes.push_back("left out, no numbers: " + words);
  if (rows.open_end()) {
    record.notes.emplace_back("the last line has no line end: its last number may be cut off");
  }
  return record;
}

namespace {

void append(std::string& text, double value) {
  if (std::isnan(value)) return;  // a missing value is an empty field
  char buffer[32];
  const auto result = std::to_chars(std::begin(buffer), std::end(buffer), value);
  text.append(std::begin(buffer), result.ptr);
}

std::string csv_text(const Record& record) {
  std::string text = "t_s,u_" + record.command_unit + ",y_" + record.position_unit;
  for (const auto& [name, values] : record.further) text += "," + name;
  text += '\n';
  for (std::size_t i = 0; i < record.size(); ++i) {
    append(text, record.t_s[i]);
    text += ',';
    append(text, record.u_V[i]);
    text += ',';
    append(text, record.y_m[i]);
    for (const auto& [name, values] : record.further) {
      text += ',';
      append(text, values[i]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace

void write_csv(const Record& record, const std::filesystem::path& file) {
  write_whole(file, csv_text(record));
}

}  // namespace config::record
