#include "config/record/column_roles.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

#include "config/record/column_words.h"
#include "config/record/command_doubt.h"
#include "config/record/further_names.h"
#include "config/record/layout.h"
#include "config/record/map_terms.h"
#include "config/record/probable_map.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/spelling.h"

namespace config::record {
namespace {

using schema::bad_data;

class Understanding {
 public:
  Understanding(const FileHead& head, const std::vector<MapEntry>& map, bool position_optional)
      : head_(head), columns_(read_columns(head)), position_optional_(position_optional) {
    for (const MapEntry& entry : map) take(entry);
    refuse_two_units();
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

  void take(const MapEntry& entry) {
    Role role = Role::further;
    for (const Role main : kMainRoles) {
      if (entry.key == kRoleKeys[index_of(main)]) role = main;
    }
    if (role == Role::time && !column_named(columns_, head_.where, entry.column)) {
      if (const double period_s = period_in(entry.column); period_s > 0.0) {
        layout_.step_s = period_s;
        has_rate_ = true;
        return;
      }
    }
    std::string text = entry.column;
    Channel channel;
    channel.role = role;
    std::optional<MapTerm> term = map_term(columns_, head_.where, text);
    if (const auto at = text.rfind('@'); !term && at != std::string::npos && role != Role::time) {
      std::string own = text.substr(at + 1);
      std::string behind;
      if (own.ends_with(']') && !column_named(columns_, head_.where, own)) {  // Cmd@Time[V]
        behind = own.substr(own.rfind('['));
        own.resize(own.rfind('['));
      }
      const auto times = column_named(columns_, head_.where, own);
      if (times) {
        channel.times = *times;
        text = text.substr(0, at) + behind;
        term = map_term(columns_, head_.where, text);
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
      term = map_term(columns_, head_.where, text);
    }
    if (!term) {
      const std::string near = schema::nearest(text, names());
      throw bad_data(head_.where,
                     "--map " + entry.key + ": there is no " + noun() + text +
                         (near.empty() ? std::string() : ", did you mean " + near + "?"),
                     listing(head_, columns_));
    }
    set_channel(channel, entry, *term, stated);
  }

  /// Refuses columns of which header and line of units name two units, where no entry states one.
  void refuse_two_units() const {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const ReadColumn& column = columns_[i];
      if (column.conflict.empty() || stated_.contains(i)) continue;
      throw bad_data(head_.where, noun() + column.header + " names two units, " + column.conflict,
                     one_unit_or_map(column.text.name, column.text.unit.text));
    }
  }

  void set_channel(Channel channel, const MapEntry& entry, const MapTerm& term,
                   const std::optional<UnitText>& stated) {
    const ReadColumn& column = columns_[term.column];
    const Role role = channel.role;
    if (stated) stated_.insert(term.column);
    UnitText unit = stated ? *stated : column.text.unit;
    if (!stated && unit.text.empty() && role == Role::time && (column.clock || head_.time_in_s)) {
      unit = parse_unit("s");
    }
    if (column.clock && role == Role::time) unit = parse_unit("s");
    if (!column.numbers && !column.clock) {
      problems_.push_back(noun() + column.header + " holds text, not numbers");
    }
    if (!stated && !term.stated && !column.scale.empty()) {
      problems_.push_back(noun() + column.header + " " + column.scale);
    } else if (role != Role::further && !unit.known()) {
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
      const int points = score(role, columns_[i]);
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
      const int points = score(role, columns_[i]);
      if (points > best_score - kNear && points > 0) rivals.push_back(i);
    }
    guess_[index_of(role)] = best;
    if (role == Role::command && may_be_measured_force(columns_[best])) {
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        const bool known = std::find(rivals.begin(), rivals.end(), i) != rivals.end();
        if (!taken_.contains(i) && !known && may_drive_besides(columns_[i])) rivals.push_back(i);
      }
    }
    if (rivals.size() > 1) {
      std::vector<std::string> names;
      names.reserve(rivals.size());
      for (const std::size_t i : rivals) names.push_back(columns_[i].header);
      problems_.push_back(std::string("the ") + kRoleWords[index_of(role)] + " may be " +
                          schema::listed(names, "or"));
      return;
    }
    const ReadColumn& column = columns_[best];
    if (role == Role::command) {
      if (const std::string doubt = doubt_of_command(column); !doubt.empty()) {
        problems_.push_back(noun() + column.header + " " + doubt);
        return;
      }
    }
    UnitText unit = column.text.unit;
    if (role == Role::time && (column.clock || (unit.text.empty() && head_.time_in_s))) {
      unit = parse_unit("s");
    }
    if (!column.scale.empty()) {
      problems_.push_back(noun() + column.header + " " + column.scale);
      return;
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

  /// No column fits: one may be meant all the same, but for its unit.
  void refuse_unit_of_canonical(Role role) {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const ReadColumn& column = columns_[i];
      if (!has_stem_of(role, column) || taken_.contains(i)) continue;
      guess_[index_of(role)] = i;
      problems_.push_back(noun() + column.header + " has a contradictory unit");
      return;
    }
    if (role == Role::position && position_optional_) return;
    problems_.push_back(std::string("lacks a ") + kRoleWords[index_of(role)] + " " +
                        (head_.variables ? "variable" : "column") +
                        (role == Role::command ? spool_words() : ""));
  }

  /// The way out where a spool's position alone could stand for the command.
  [[nodiscard]] std::string spool_words() const {
    for (const ReadColumn& column : columns_) {
      if (!is_spool(column) || !is_plain(column) || !column.numbers) continue;
      return " (" + column.header +
             " is the measured spool; as the command it leaves out the valve's dynamics)";
    }
    return "";
  }

  void add_further() {
    FurtherNames names;
    for (const Channel& channel : mapped_further_) {
      (void)names.take(channel.name);
      layout_.channels.push_back(channel);
    }
    const auto is_further = [this](std::size_t i) {
      return !taken_.contains(i) && columns_[i].numbers && !columns_[i].clock;
    };
    // A name as this project writes it is kept: p_Pa behind "p [bar]".
    std::vector<std::string> own(columns_.size());
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const RecordColumn old = parse_column(columns_[i].header);
      const UnitText& unit = columns_[i].text.unit;
      if (!is_further(i) || old.si_unit.empty()) continue;
      if (old.si_unit == unit.si && old.factor == unit.factor) own[i] = names.take(old.si_name);
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const ReadColumn& column = columns_[i];
      if (!is_further(i)) continue;
      Channel channel;
      channel.column = i;
      channel.unit_text = column.text.unit.text;
      if (!own[i].empty()) {
        channel.name = own[i];
        channel.factor = column.text.unit.factor;
      } else if (column.text.unit.known()) {
        channel.name =
            names.take_with_unit(column.text.name, column.text.unit.si, is_reference(column));
        channel.factor = column.text.unit.factor;
      } else {
        channel.name = names.take(column.named ? slug(column.header) : "column_" + column.header);
      }
      layout_.channels.push_back(channel);
    }
  }

  // --- the refusal

  /// The columns that were found, then those that were guessed, each for one role alone.
  [[nodiscard]] std::array<std::optional<std::size_t>, 3> known() const {
    std::array<std::optional<std::size_t>, 3> columns;
    std::set<std::size_t> used;
    for (std::size_t r = 0; r < columns.size(); ++r) {
      if (found_[r] && used.insert(found_[r]->column).second) columns[r] = found_[r]->column;
    }
    for (std::size_t r = 0; r < columns.size(); ++r) {
      if (!found_[r] && guess_[r] && used.insert(*guess_[r]).second) columns[r] = guess_[r];
    }
    return columns;
  }

  [[nodiscard]] schema::DataError refusal() const {
    const bool nameless = std::all_of(head_.columns.begin(), head_.columns.end(),
                                      [](const FileColumn& c) { return c.header.empty(); });
    std::string what = nameless && !columns_.empty() ? "has no header that names its columns"
                                                     : schema::joined(problems_, "; ");
    what += "; " + listing(head_, columns_);
    if (const std::string map =
            probable_map(columns_, known(), taken_, has_rate_, head_.stated_step_s);
        !map.empty())
      what += (nameless ? "; for example: --map " : "; probably: --map ") + map;
    return bad_data(head_.where, what);
  }

  const FileHead& head_;
  std::vector<ReadColumn> columns_;
  Layout layout_;
  std::array<std::optional<Channel>, 3> found_;
  std::array<std::optional<std::size_t>, 3> guess_;
  std::vector<Channel> mapped_further_;
  std::set<std::size_t> taken_;
  std::set<std::size_t> stated_;  ///< columns whose unit an entry states
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
    std::vector<std::string> units;
    for (const FileColumn& column : head.columns) {
      names.push_back(column.header);
      units.push_back(column.unit);
    }
    if (auto layout = plain_layout(names, units, head.where)) {
      for (const Channel& channel : layout->channels) {
        const FileColumn& column = head.columns[channel.column];
        if (channel.role != Role::further && !column.factor.empty()) {
          throw bad_data(head.where, "column " + names[channel.column] + " " + column.factor,
                         "--map with FACTOR 1 or the one that is stated: " +
                             std::string(kRoleKeys[index_of(channel.role)]) + "=" +
                             names[channel.column] + "*FACTOR");
        }
        if (channel.role == Role::further || column.numbers) continue;
        throw bad_data(head.where, "column " + names[channel.column] + " holds text, not numbers");
      }
      std::erase_if(layout->channels,
                    [&](const Channel& channel) { return !head.columns[channel.column].numbers; });
      return *std::move(layout);
    }
  }
  return Understanding(head, map, position_optional).layout();
}

}  // namespace config::record
