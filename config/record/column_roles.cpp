#include "config/record/column_roles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "config/record/layout.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/spelling.h"

namespace config::record {
namespace {

using schema::bad_data;
using Words = std::vector<std::string_view>;

constexpr std::array kMainRoles{Role::time, Role::command, Role::position};
constexpr std::array<const char*, 3> kRoleWords{"time", "command", "position"};
constexpr std::array<const char*, 3> kRoleKeys{"t", "u", "y"};

std::size_t index_of(Role role) { return static_cast<std::size_t>(role); }

// --- words ------------------------------------------------------------------------------------

/// "Valve cmdVoltage_1" as "valve", "cmd", "voltage", "1".
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words(1);
  char before = 0;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool letter = byte >= 0x80 || std::isalpha(byte) != 0;
    const bool digit = std::isdigit(byte) != 0;
    const auto last = static_cast<unsigned char>(before);
    const bool was_digit = std::isdigit(last) != 0;
    const bool hump = std::isupper(byte) != 0 && std::islower(last) != 0;
    if ((!letter && !digit) || hump || (before != 0 && digit != was_digit)) {
      if (!words.back().empty()) words.emplace_back();
    }
    if (letter || digit) words.back() += static_cast<char>(std::tolower(byte));
    before = letter || digit ? c : 0;
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

/// Any of `wanted` among the words; those that end in * may begin or end a longer word.
bool has_word(const std::vector<std::string>& words, const Words& wanted) {
  for (const std::string& word : words) {
    for (const std::string_view want : wanted) {
      if (want.ends_with('*') ? word.find(want.substr(0, want.size() - 1)) != std::string::npos
                              : word == want) {
        return true;
      }
    }
  }
  return false;
}

const Words kTimeWords{"t",        "time",  "zeit", "timestamp*", "zeitstempel*", "elapsed*",
                       "sekunden", "temps", "tid",  "tiempo",     "messzeit*",    "abtastzeit"};
const Words kNoTimeWords{"cycle",  "task", "exec",     "execution", "delay", "turnaround",
                         "jitter", "rise", "settling", "dead",      "step",  "sample"};
const Words kCommandWords{
    "u",          "command*", "cmd",        "stell*", "kommando*", "befehl*",     "commande",
    "ansteuer*",  "control",  "controller", "ctrl",   "drive",     "manipulated", "valve",
    "servovalve", "ventil*",  "regler*",    "dac",    "ao",        "input",       "eingang*"};
const Words kWeakCommandWords{"voltage*", "spannung*", "volt",   "volts",  "current*", "strom*",
                              "torque*",  "moment*",   "force*", "kraft*", "pwm",      "duty"};
const Words kPositionWords{
    "y",    "pos",    "position*", "displacement*", "stroke",   "weg",     "wegauf*", "hub",
    "lage", "rod",    "piston*",   "kolben*",       "angle",    "winkel*", "theta",   "encoder*",
    "lvdt", "travel", "extension", "istwert",       "rotation", "posicion"};
const Words kWeakPositionWords{"x", "output", "ausgang*", "out", "phi", "measured", "ist"};
const Words kReferenceWords{"ref",     "reference*", "setpoint*", "sp",        "soll*",
                            "target*", "demand*",    "desired",   "nominal*",  "wanted",
                            "set",     "des",        "sollwert*", "fuehrung*", "führung*"};
const Words kOtherWords{"error*", "err",      "fehler*",   "deviation", "abweich*",  "velocity*",
                        "vel",    "speed*",   "geschw*",   "accel*",    "pressure*", "druck*",
                        "temp*",  "supply",   "limit",     "min",       "max",       "model*",
                        "sim*",   "estimat*", "observer*", "offset",    "status",    "tank"};
const Words kMeasuredWords{"act",      "actual*", "meas", "measured",
                           "feedback", "fbk",     "ist*", "mess*"};

// --- a file's columns, read as words and units ------------------------------------------------

struct ReadColumn {
  std::string header;  ///< for messages: as in the file, or its number
  HeaderText text;
  std::vector<std::string> words;
  bool numbers = true;
  bool clock = false;
  const std::vector<double>* sample = nullptr;
};

std::vector<ReadColumn> read_columns(const FileHead& head) {
  std::vector<ReadColumn> columns;
  for (std::size_t i = 0; i < head.columns.size(); ++i) {
    const FileColumn& column = head.columns[i];
    ReadColumn read;
    read.header = column.header.empty() ? std::to_string(i + 1) : column.header;
    if (!column.header.empty()) read.text = parse_header(column.header);
    if (!column.unit.empty()) {
      // With a line of units the whole header is the name, unless both name the same unit.
      const UnitText unit = parse_unit(column.unit);
      if (unit.si != read.text.unit.si || unit.factor != read.text.unit.factor) {
        if (!read.text.unit.text.empty() && read.text.unit.known() && unit.known() &&
            unit.si != "1") {
          throw bad_data(head.where, "column " + read.header + " names two units, " +
                                         read.text.unit.text + " and " + unit.text);
        }
        if (unit.si != "1" || !read.text.unit.known()) {
          if (!read.text.unit.known()) read.text.name = column.header;
          read.text.unit = unit;
        }
      }
    }
    // Of a path within a model only the last part says what the signal is.
    const std::string& name = read.text.name;
    const std::size_t part = name.find_last_of("/\\:.");
    const bool path = part != std::string::npos && part + 1 < name.size();
    read.words = words_of(path ? name.substr(part + 1) : name);
    read.numbers = column.numbers;
    read.clock = column.clock;
    read.sample = &column.sample;
    columns.push_back(std::move(read));
  }
  return columns;
}

bool increases(const std::vector<double>& values) {
  if (values.size() < 3) return false;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (!(values[i] > values[i - 1])) return false;
  }
  return true;
}

bool fits(Role role, std::string_view si) {
  switch (role) {
    case Role::time:
      return si == "s";
    case Role::command:
      return si == "V" || si == "A" || si == "pct" || si == "N" || si == "Nm" || si == "mps" ||
             si == "radps";
    case Role::position:
      return si == "m" || si == "rad";
    case Role::further:
      break;
  }
  return false;
}

constexpr int kStrong = 50;
constexpr int kWeak = 20;

/// How well a column's words and unit fit a role; 0: not at all.
int score(Role role, const ReadColumn& column) {
  if (!column.numbers && !column.clock) return 0;
  const UnitText& unit = column.text.unit;
  if (role == Role::time && column.clock) return kStrong + 5;
  if (column.clock) return 0;
  if (unit.known() && !fits(role, unit.si)) return 0;
  const bool reference = has_word(column.words, kReferenceWords);
  const bool other = has_word(column.words, kOtherWords);
  if (role == Role::time) {
    if (has_word(column.words, kNoTimeWords)) return 0;
    if (folded(column.text.name) == "xvalue") return kStrong;
    if (has_word(column.words, kTimeWords)) return kStrong;
    return unit.known() && increases(*column.sample) ? kWeak : 0;
  }
  if (reference || other) return 0;
  const int measured = has_word(column.words, kMeasuredWords) ? 5 : 0;
  if (role == Role::command) {
    const bool positional = has_word(column.words, kPositionWords);
    if (positional && !unit.known()) return 0;
    if (has_word(column.words, kCommandWords)) return kStrong;
    return has_word(column.words, kWeakCommandWords) && !positional ? kWeak : 0;
  }
  if (!unit.known() && has_word(column.words, kCommandWords)) return 0;
  if (has_word(column.words, kCommandWords)) return 0;  // a commanded position is a reference
  if (has_word(column.words, kPositionWords)) return kStrong + measured;
  return has_word(column.words, kWeakPositionWords) ? kWeak + measured : 0;
}

// --- the mapping ------------------------------------------------------------------------------

class Understanding {
 public:
  Understanding(const FileHead& head, const std::vector<MapEntry>& map, bool position_optional)
      : head_(head), columns_(read_columns(head)), position_optional_(position_optional) {
    for (const MapEntry& entry : map) take(entry);
  }

  Layout layout() {
    for (const Role role : kMainRoles) {
      if (!found_[index_of(role)]) choose(role);
    }
    if (!problems_.empty()) throw refusal();
    for (const std::optional<Channel>& channel : found_) {
      if (channel) layout_.channels.push_back(*channel);
    }
    layout_.command_unit = si_of(*found_[1]);
    if (found_[2]) layout_.position_unit = si_of(*found_[2]);
    add_further();
    std::sort(layout_.channels.begin(), layout_.channels.end(),
              [](const Channel& a, const Channel& b) { return a.column < b.column; });
    return std::move(layout_);
  }

 private:
  [[nodiscard]] const char* noun() const { return head_.variables ? "variable " : "column "; }

  static std::string si_of(const Channel& channel) {
    return channel.name.substr(channel.name.find('_') + 1);
  }

  // --- a mapping's entries

  [[nodiscard]] std::optional<std::size_t> column_named(const std::string& name) const {
    using Text = std::string (*)(const ReadColumn&);
    constexpr std::array<Text, 4> kTexts{[](const ReadColumn& c) { return c.header; },
                                         [](const ReadColumn& c) { return c.text.name; },
                                         [](const ReadColumn& c) { return folded(c.header); },
                                         [](const ReadColumn& c) { return folded(c.text.name); }};
    for (std::size_t way = 0; way < kTexts.size(); ++way) {
      const std::string wanted = way < 2 ? name : folded(name);
      if (wanted.empty()) return std::nullopt;
      // What looks like a sign, a factor or an offset is one, not punctuation.
      if (way >= 2 && (name.front() == '-' || name.find_first_of("*+@[") != std::string::npos)) {
        break;
      }
      std::optional<std::size_t> found;
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        if (head_.columns[i].header.empty() || kTexts[way](columns_[i]) != wanted) continue;
        if (found) {
          throw bad_data(head_.where,
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
    if (whole && number >= 1 && number <= columns_.size()) return number - 1;
    return std::nullopt;
  }

  struct Term {
    std::size_t column = 0;
    double factor = 1.0;
    double offset = 0.0;
  };

  static bool ends_in_number(std::string& text, std::string_view marks, double& number) {
    for (std::size_t at = text.size(); at-- > 1;) {
      if (marks.find(text[at]) == std::string_view::npos) continue;
      const char* begin = text.data() + at + (text[at] == '-' ? 0 : 1);
      const char* const end = text.data() + text.size();
      double value = 0.0;
      while (begin != end && *begin == ' ') ++begin;
      const auto result = std::from_chars(begin, end, value);
      if (begin == end || result.ec != std::errc{} || result.ptr != end) continue;
      number = value;
      text.resize(at);
      while (!text.empty() && text.back() == ' ') text.pop_back();
      return true;
    }
    return false;
  }

  /// [-]name[*factor][+offset]
  [[nodiscard]] std::optional<Term> term_of(const std::string& text) const {
    for (const bool negative : {false, true}) {
      if (negative && (text.size() < 2 || text.front() != '-')) break;
      std::string rest = negative ? text.substr(text.find_first_not_of(' ', 1)) : text;
      Term term;
      term.factor = negative ? -1.0 : 1.0;
      const auto named = [&]() -> bool {
        const auto column = column_named(rest);
        if (column) term.column = *column;
        return column.has_value();
      };
      if (named()) return term;
      const std::string whole = rest;
      double number = 0.0;
      if (ends_in_number(rest, "*", number)) {
        term.factor *= number;
        if (named()) return term;
        term.factor = negative ? -1.0 : 1.0;
      }
      rest = whole;
      if (ends_in_number(rest, "+-", term.offset)) {
        if (named()) return term;
        if (ends_in_number(rest, "*", number)) {
          term.factor *= number;
          if (named()) return term;
        }
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const ReadColumn& column : columns_) {
      all.push_back(column.header);
      if (column.text.name != column.header && !column.text.name.empty()) {
        all.push_back(column.text.name);
      }
    }
    return all;
  }

  /// "1000Hz", "2 ms": the period, s.
  static double period_in(const std::string& text) {
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

  void take(const MapEntry& entry) {
    Role role = Role::further;
    for (const Role main : kMainRoles) {
      if (entry.key == kRoleKeys[index_of(main)]) role = main;
    }
    if (role == Role::time && !column_named(entry.column)) {
      if (const double period_s = period_in(entry.column); period_s > 0.0) {
        layout_.step_s = period_s;
        has_rate_ = true;
        return;
      }
    }
    std::string text = entry.column;
    Channel channel;
    channel.role = role;
    std::optional<Term> term = term_of(text);
    if (const auto at = text.rfind('@'); !term && at != std::string::npos && role != Role::time) {
      std::string own = text.substr(at + 1);
      std::string behind;
      if (own.ends_with(']') && !column_named(own)) {  // Cmd@Time[V]
        behind = own.substr(own.rfind('['));
        own.resize(own.rfind('['));
      }
      const auto times = column_named(own);
      if (times) {
        channel.times = *times;
        text = text.substr(0, at) + behind;
        term = term_of(text);
      }
    }
    std::optional<UnitText> stated;
    if (!term && text.ends_with(']') && text.find('[') != std::string::npos) {
      const std::size_t open = text.rfind('[');
      stated = parse_unit(std::string_view(text).substr(open));
      if (!stated->known()) {
        throw schema::UsageError("--map " + entry.key + "=" + entry.column + ": the unit " +
                                 stated->text +
                                 " is not known; allowed: s, ms, V, mV, A, mA, %, N, kN, N m, m, "
                                 "mm, um, in, rad, deg, bar, psi, l/min, ...");
      }
      text.resize(open);
      while (!text.empty() && text.back() == ' ') text.pop_back();
      term = term_of(text);
    }
    if (!term) {
      const std::string near = schema::nearest(text, names());
      throw bad_data(head_.where,
                     "--map " + entry.key + ": there is no " + noun() + text +
                         (near.empty() ? std::string() : ", did you mean " + near + "?"),
                     listing());
    }
    set_channel(channel, entry, *term, stated);
  }

  void set_channel(Channel channel, const MapEntry& entry, const Term& term,
                   const std::optional<UnitText>& stated) {
    const ReadColumn& column = columns_[term.column];
    const Role role = channel.role;
    UnitText unit = stated ? *stated : column.text.unit;
    if (!stated && unit.text.empty() && role == Role::time && (column.clock || head_.time_in_s)) {
      unit = parse_unit("s");
    }
    if (column.clock && role == Role::time) unit = parse_unit("s");
    if (!column.numbers && !column.clock) {
      problems_.push_back(noun() + column.header + " holds text, not numbers");
    }
    if (role != Role::further && !unit.known()) {
      problems_.push_back(
          noun() + column.header +
          (unit.text.empty() ? " has no unit" : " has the unknown unit " + unit.text));
    } else if ((role == Role::time) != (unit.si == "s") && role != Role::further) {
      problems_.push_back(noun() + column.header + " has a contradictory unit, " + unit.text);
    }
    channel.column = term.column;
    channel.unit_text = unit.text;
    channel.factor = unit.known() ? term.factor * unit.factor : term.factor;
    channel.offset = unit.known() ? term.offset * unit.factor : term.offset;
    if (role == Role::further) {
      const RecordColumn key = parse_column(entry.key);
      channel.name = unit.known() && key.si_unit != unit.si && unit.si != "1"
                         ? entry.key + "_" + unit.si
                         : entry.key;
      mapped_further_.push_back(channel);
    } else {
      channel.name = std::string(kRoleKeys[index_of(role)]) + "_" + unit.si;
      found_[index_of(role)] = channel;
    }
    if (!taken_.insert(term.column).second) {
      problems_.push_back("--map names " + std::string(noun()) + column.header + " twice");
    }
    if (channel.times != Channel::kSharedTimes) taken_.insert(channel.times);
  }

  // --- words and units

  void choose(Role role) {
    if (role == Role::time && has_rate_) return;
    std::size_t best = 0;
    int best_score = 0;
    std::vector<std::size_t> rivals;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (taken_.contains(i)) continue;
      const int points = canonical(role, columns_[i]) ? 100 : score(role, columns_[i]);
      if (points > best_score) {
        best = i;
        best_score = points;
      }
    }
    if (best_score == 0) {
      if (role == Role::time && head_.step_s > 0.0) {
        layout_.step_s = head_.step_s;
        has_rate_ = true;
        return;
      }
      refuse_unit_of_canonical(role);
      return;
    }
    constexpr int kNear = 10;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (taken_.contains(i)) continue;
      const int points = canonical(role, columns_[i]) ? 100 : score(role, columns_[i]);
      if (points > best_score - kNear && points > 0) rivals.push_back(i);
    }
    guess_[index_of(role)] = best;
    if (rivals.size() > 1) {
      std::vector<std::string> names;
      names.reserve(rivals.size());
      for (const std::size_t i : rivals) names.push_back(columns_[i].header);
      problems_.push_back(std::string("the ") + kRoleWords[index_of(role)] + " may be " +
                          schema::listed(names, "or"));
      return;
    }
    const ReadColumn& column = columns_[best];
    UnitText unit = column.text.unit;
    if (role == Role::time && (column.clock || (unit.text.empty() && head_.time_in_s))) {
      unit = parse_unit("s");
    }
    if (!unit.known()) {
      problems_.push_back(
          noun() + column.header +
          (unit.text.empty() ? " has no unit" : " has the unknown unit " + unit.text));
      return;
    }
    Channel channel;
    channel.role = role;
    channel.column = best;
    channel.unit_text = column.clock ? "date and time" : unit.text;
    channel.factor = unit.factor;
    channel.name = std::string(kRoleKeys[index_of(role)]) + "_" + unit.si;
    found_[index_of(role)] = channel;
    taken_.insert(best);
  }

  /// t_s, u_A, y_rad: the stem is the role's own and the unit fits, signals of sensors included.
  static bool canonical(Role role, const ReadColumn& column) {
    if (!column.numbers) return false;
    const std::string stem = column.text.name;
    const bool own = stem == kRoleKeys[index_of(role)] || (role == Role::time && stem == "time");
    const std::string& si = column.text.unit.si;
    const bool signal = role == Role::position && (si == "V" || si == "A" || si == "pct");
    return own && (fits(role, si) || signal);
  }

  /// No column fits: one may be meant all the same, but for its unit.
  void refuse_unit_of_canonical(Role role) {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const ReadColumn& column = columns_[i];
      const std::string& stem = column.text.name;
      const bool own = stem == kRoleKeys[index_of(role)] || (role == Role::time && stem == "time");
      if (!own || taken_.contains(i)) continue;
      guess_[index_of(role)] = i;
      problems_.push_back(noun() + column.header + " has a contradictory unit");
      return;
    }
    if (role == Role::position && position_optional_) return;
    problems_.push_back(std::string("lacks a ") + kRoleWords[index_of(role)] + " " +
                        (head_.variables ? "variable" : "column"));
  }

  void add_further() {
    std::set<std::string> names;
    for (const Channel& channel : mapped_further_) {
      names.insert(channel.name);
      layout_.channels.push_back(channel);
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const ReadColumn& column = columns_[i];
      if (taken_.contains(i) || !column.numbers || column.clock) continue;
      Channel channel;
      channel.column = i;
      channel.unit_text = column.text.unit.text;
      const RecordColumn old = parse_column(column.header);
      if (!old.si_unit.empty()) {
        channel.name = old.si_name;
        channel.factor = old.factor;
      } else if (column.text.unit.known()) {
        const std::string& si = column.text.unit.si;
        const bool reference =
            has_word(column.words, kReferenceWords) && (si == "m" || si == "rad");
        const std::string stem =
            reference && !names.contains("reference_" + si) ? "reference" : slug(column.text.name);
        channel.name = si == "1" ? stem : fmt::format("{}_{}", stem, si);
        channel.factor = column.text.unit.factor;
      } else {
        const bool named = !head_.columns[i].header.empty();
        channel.name = named ? slug(column.header) : "column_" + column.header;
      }
      std::string unique = channel.name;
      for (int k = 2; !names.insert(unique).second; ++k) {
        unique = channel.name + "_" + std::to_string(k);
      }
      channel.name = unique;
      layout_.channels.push_back(channel);
    }
  }

  static std::string slug(const std::string& name) {
    std::string result;
    for (const char c : name) {
      const auto byte = static_cast<unsigned char>(c);
      const bool kept = byte >= 0x80 || std::isalnum(byte) != 0 || c == '.' || c == '-';
      if (kept) {
        result += c;
      } else if (!result.empty() && result.back() != '_') {
        result += '_';
      }
    }
    while (result.ends_with('_')) result.pop_back();
    return result.empty() ? "column" : result;
  }

  // --- the refusal

  /// "1 Time, 2 Command [V], ..."
  [[nodiscard]] std::string listing() const {
    constexpr std::size_t kMost = 16;
    std::string text = "it has: ";
    for (std::size_t i = 0; i < std::min(kMost, columns_.size()); ++i) {
      const bool named = !head_.columns[i].header.empty();
      std::string name = columns_[i].header;
      if (name.size() > 40) name = name.substr(0, 37) + "...";
      if (i > 0) text += ", ";
      if (!named) {
        text += std::to_string(i + 1);
        if (!columns_[i].sample->empty()) {
          text += fmt::format(" ({:.6g}, ...)", columns_[i].sample->front());
        }
      } else {
        text += head_.variables ? name : std::to_string(i + 1) + " " + name;
      }
    }
    if (columns_.size() > kMost) text += ", ... (" + std::to_string(columns_.size()) + ")";
    if (columns_.empty()) text += head_.variables ? "no variables" : "no columns";
    if (!head_.more.empty()) text += "; " + head_.more;
    return text;
  }

  [[nodiscard]] schema::DataError refusal() const {
    const bool nameless = std::all_of(head_.columns.begin(), head_.columns.end(),
                                      [](const FileColumn& c) { return c.header.empty(); });
    std::string what = nameless && !columns_.empty() ? "has no header that names its columns"
                                                     : schema::joined(problems_, "; ");
    what += "; " + listing();
    if (const std::string map = probable_map(); !map.empty())
      what += (nameless ? "; for example: --map " : "; probably: --map ") + map;
    return bad_data(head_.where, what);
  }

  /// How a column is named on the command line: its name, or its number where that needs quoting.
  [[nodiscard]] std::string typed(std::size_t i) const {
    if (head_.columns[i].header.empty()) return std::to_string(i + 1);
    const auto plain = [](const std::string& text) {
      return !text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) == 0 &&
             std::all_of(text.begin(), text.end(), [](char c) {
               return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == ' ' ||
                      c == '.';
             });
    };
    const auto only = [&](const std::string& text) {
      return std::count_if(columns_.begin(), columns_.end(), [&](const ReadColumn& column) {
               return folded(column.header) == folded(text) ||
                      folded(column.text.name) == folded(text);
             }) == 1;
    };
    for (const std::string& text : {columns_[i].header, columns_[i].text.name}) {
      if (plain(text) && only(text)) return text;
    }
    return std::to_string(i + 1);
  }

  [[nodiscard]] std::string probable_map() const {
    if (columns_.size() < 2) return "";
    std::array<std::optional<std::size_t>, 3> columns;
    std::set<std::size_t> used;
    for (const Role role : kMainRoles) {
      const std::size_t r = index_of(role);
      if (found_[r]) columns[r] = found_[r]->column;
      if (!columns[r] && guess_[r]) columns[r] = guess_[r];
      if (columns[r]) used.insert(*columns[r]);
    }
    const auto pick = [&](Role role, const auto& good) {
      const std::size_t r = index_of(role);
      if (columns[r] || (role == Role::time && has_rate_)) return;
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        if (used.contains(i) || !columns_[i].numbers || !good(columns_[i])) continue;
        columns[r] = i;
        used.insert(i);
        return;
      }
    };
    pick(Role::time, [](const ReadColumn& c) { return increases(*c.sample); });
    const auto fitting = [](Role role) {
      return [role](const ReadColumn& c) { return fits(role, c.text.unit.si); };
    };
    const auto plain = [](const ReadColumn& c) {
      return c.text.unit.si != "s" && !has_word(c.words, kReferenceWords) &&
             !has_word(c.words, kOtherWords);
    };
    pick(Role::position, fitting(Role::position));
    pick(Role::command, fitting(Role::command));
    pick(Role::command, plain);
    pick(Role::position, plain);
    std::string map;
    for (const Role role : kMainRoles) {
      const std::size_t r = index_of(role);
      if (role == Role::time && has_rate_) continue;
      map += map.empty() ? "" : ",";
      map += std::string(kRoleKeys[r]) + "=";
      if (!columns[r]) {
        map += role == Role::time ? "1000Hz" : "COLUMN[UNIT]";
        continue;
      }
      map += typed(*columns[r]);
      const ReadColumn& column = columns_[*columns[r]];
      const bool stated = fits(role, column.text.unit.si) || (role == Role::time && column.clock);
      // A unit of another quantity is a sensor's signal: the mapping may say so.
      const bool signal = column.text.unit.known() && column.text.unit.si != "s" &&
                          column.text.unit.si != "1" && role != Role::time;
      if (!stated) {
        map += "[" + (signal ? column.text.unit.text : probable_unit(role, column)) + "]";
      }
    }
    return "'" + map + "'";
  }

  [[nodiscard]] static std::string probable_unit(Role role, const ReadColumn& column) {
    const std::vector<double>& sample = *column.sample;
    if (role == Role::time) {
      const bool coarse = sample.size() > 1 && sample[1] - sample[0] >= 0.5;
      return coarse ? "ms" : "s";
    }
    if (role == Role::command) return "V";
    double most = 0.0;
    for (const double value : sample) most = std::max(most, std::abs(value));
    return most > 3.0 ? "mm" : "m";
  }

  const FileHead& head_;
  std::vector<ReadColumn> columns_;
  Layout layout_;
  std::array<std::optional<Channel>, 3> found_;
  std::array<std::optional<std::size_t>, 3> guess_;
  std::vector<Channel> mapped_further_;
  std::set<std::size_t> taken_;
  std::vector<std::string> problems_;
  bool has_rate_ = false;
  bool position_optional_ = false;
};

}  // namespace

const Channel* Layout::of(Role role) const noexcept {
  for (const Channel& channel : channels) {
    if (channel.role == role) return &channel;
  }
  return nullptr;
}

Layout understand(const FileHead& head, const std::vector<MapEntry>& map, bool position_optional) {
  if (map.empty()) {
    std::vector<std::string> names;
    for (const FileColumn& column : head.columns) names.push_back(column.header);
    if (auto layout = plain_layout(names, head.where)) {
      std::erase_if(layout->channels,
                    [&](const Channel& channel) { return !head.columns[channel.column].numbers; });
      return *std::move(layout);
    }
  }
  return Understanding(head, map, position_optional).layout();
}

}  // namespace config::record
