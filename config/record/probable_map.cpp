#include "config/record/probable_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

#include "config/record/map_terms.h"
#include "config/record/text_fields.h"
#include "config/schema/error.h"

namespace config::record {
namespace {

/// Needs no quoting within a mapping: a word, or a number that is a name.
bool is_plain_name(const std::string& text) {
  if (text.empty()) return false;
  if (is_digit(text.front())) return std::all_of(text.begin(), text.end(), is_digit);
  return std::all_of(text.begin(), text.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == ' ' || c == '.';
  });
}

/// Means itself in a mapping between apostrophes: "x-axis".
bool is_typeable(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return c >= ' ' && std::string_view("'\"[]=@,").find(c) == std::string_view::npos;
  });
}

/// How a column is named on the command line: its name, or its number where that needs quoting. A
/// number that is the name of another column stands for that one.
std::string typed(const std::vector<ReadColumn>& columns, std::size_t i) {
  const auto means_it = [&](const std::string& text) {
    try {
      return column_named(columns, "", text) == i;
    } catch (const schema::DataError&) {
      return false;  // several
    }
  };
  std::string number = std::to_string(i + 1);
  if (!columns[i].named) return number;
  const std::array<std::string, 2> names{columns[i].header, columns[i].text.name};
  for (const std::string& name : names) {
    if (is_plain_name(name) && means_it(name)) return name;
  }
  if (means_it(number)) return number;
  for (const std::string& name : names) {
    if (is_typeable(name) && means_it(name)) return name;
  }
  return number;
}

/// Times of Windows, since 1601.
bool counts_tenths_of_us(const ReadColumn& column) {
  return !column.text.unit.known() && !column.sample->empty() && column.sample->front() > 1e17 &&
         column.sample->front() < 5e17;
}

/// Serial dates of spreadsheets and MATLAB: days, with times as their decimals.
bool counts_days(const ReadColumn& column) {
  constexpr double kStep = 0.01;
  const std::vector<double>& sample = *column.sample;
  if (column.text.unit.known() || column.clock || sample.size() < 2) return false;
  const double first = sample.front();
  // Within one day: no record in seconds has such steps.
  constexpr double kShortest = 2e-6;
  if (first >= 0.0 && first < 1.0) return sample[1] > first && sample[1] - first < kShortest;
  const bool day = (first > 2e4 && first < 8e4) || (first > 7e5 && first < 8e5);
  return day && sample[1] - first < kStep;
}

/// "Position 50 mm/V": the header states a sensor's sensitivity.
bool states_sensitivity(const std::string& header) {
  constexpr std::array<std::string_view, 6> kPer{"/V", "/mV", "/A", "/mA", "/inc", "/digit"};
  return std::any_of(kPer.begin(), kPer.end(), [&](std::string_view per) {
    const std::size_t at = header.find(per);
    return at != std::string::npos && header.find_first_of("0123456789") < at;
  });
}

/// Numbers of samples, where another period is stated.
bool is_counter(const ReadColumn& column, double step_s) {
  const std::vector<double>& sample = *column.sample;
  return !column.text.unit.known() && !column.clock && sample.size() > 1 &&
         sample[1] - sample[0] == 1.0 && step_s != 1.0;
}

/// How likely a column is the one, without its name being certain; 0: not at all.
int likelihood(Role role, const ReadColumn& column) {
  const std::string& si = column.text.unit.si;
  if (role == Role::command && !column.clock && is_drive_set_point(column)) return 4;
  if (si == "s" || column.clock || !is_plain(column)) return 0;
  if (is_spool(column)) return role == Role::command ? 2 : 0;
  if (role == Role::command && !may_drive(column)) return 0;
  if (!column.text.unit.known() && increases(*column.sample)) return 1;  // a time, a counter
  const bool right = fits(role, si);
  if (role == Role::position) {
    if (is_commanded(column)) return 0;
    const bool other = column.text.unit.known() && !right && si != "V" && si != "A" && si != "1";
    return (other ? 1 : right ? 4 : 2) + (is_measured(column) ? 1 : 0);
  }
  const bool usual = si == "V" || si == "A" || si == "pct";
  const bool length = si == "m" || si == "rad";
  return (length                     ? 1
          : usual                    ? 5
          : right                    ? 4
          : column.text.unit.known() ? 1
                                     : 3) +
         (is_commanded(column) ? 4 : 0);
}

std::string probable_unit(Role role, const ReadColumn& column) {
  const std::vector<double>& sample = *column.sample;
  if (role == Role::time) {
    // Counted since 1970, a date says its unit by its size.
    const double first = sample.empty() ? 0.0 : sample.front();
    if (first >= 1e18) return "ns";
    if (first >= 1e15 && first < 1e16) return "us";
    const bool coarse = sample.size() > 1 && sample[1] - sample[0] >= 0.5;
    return coarse ? "ms" : "s";
  }
  if (role == Role::command) return "V";
  double most = 0.0;
  for (const double value : sample) most = std::max(most, std::abs(value));
  constexpr double kTurn_rad = 6.3;
  if (is_angle(column)) return most > kTurn_rad ? "deg" : "rad";
  return most > 3.0 ? "mm" : "m";
}

}  // namespace

std::string listing(const FileHead& head, const std::vector<ReadColumn>& columns) {
  constexpr std::size_t kMost = 16;
  std::string text = "it has: ";
  for (std::size_t i = 0; i < std::min(kMost, columns.size()); ++i) {
    const bool named = columns[i].named;
    std::string name = columns[i].header;
    if (name.size() > 40) name = std::string(cut_text(name, 37)) + "...";
    if (i > 0) text += ", ";
    if (!named) {
      text += std::to_string(i + 1);
      if (!columns[i].sample->empty()) {
        text += fmt::format(" ({:.6g}, ...)", columns[i].sample->front());
      }
    } else {
      text += head.variables ? name : std::to_string(i + 1) + " " + name;
    }
  }
  if (columns.size() > kMost) text += ", ... (" + std::to_string(columns.size()) + ")";
  if (columns.empty()) text += head.variables ? "no variables" : "no columns";
  if (!head.more.empty()) text += "; " + head.more;
  return text;
}

std::string probable_map(const std::vector<ReadColumn>& columns,
                         const std::array<std::optional<std::size_t>, 3>& known,
                         const std::set<std::size_t>& taken, bool has_rate, double stated_step_s) {
  if (columns.size() < 2) return "";
  std::array<std::optional<std::size_t>, 3> chosen = known;
  std::set<std::size_t> used = taken;
  for (const std::optional<std::size_t>& column : known) {
    if (column) used.insert(*column);
  }
  const auto pick = [&](Role role, const auto& points) {
    const std::size_t r = index_of(role);
    if (chosen[r] || (role == Role::time && has_rate)) return;
    int most = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (used.contains(i) || !columns[i].numbers || points(columns[i]) <= most) continue;
      chosen[r] = i;
      most = points(columns[i]);
    }
    if (chosen[r]) used.insert(*chosen[r]);
  };
  const auto likely = [](Role role) {
    return [role](const ReadColumn& column) { return likelihood(role, column); };
  };
  const auto fitting = [](Role role) {
    return [role](const ReadColumn& column) {
      return fits(role, column.text.unit.si) ? likelihood(role, column) : 0;
    };
  };
  pick(Role::time, [](const ReadColumn& c) {
    if (!increases(*c.sample) || (c.text.unit.known() && c.text.unit.si != "s")) return 0;
    return c.text.unit.si == "s" ? 2 : 1;
  });
  pick(Role::position, fitting(Role::position));
  pick(Role::command, likely(Role::command));
  pick(Role::position, likely(Role::position));
  std::string map;
  for (const Role role : kMainRoles) {
    const std::size_t r = index_of(role);
    if (role == Role::time && has_rate) continue;
    map += map.empty() ? "" : ",";
    map += std::string(kRoleKeys[r]) + "=";
    const bool by_rate = role == Role::time && stated_step_s > 0.0 &&
                         (!chosen[r] || is_counter(columns[*chosen[r]], stated_step_s));
    if (by_rate) {
      map += fmt::format("{:.9g}s", stated_step_s);
      continue;
    }
    const bool counter = role == Role::time && chosen[r] && is_counter(columns[*chosen[r]], 0.0) &&
                         score(role, columns[*chosen[r]]) == 0;
    if (!chosen[r] || counter) {
      map += role == Role::time ? "RATEHz" : "COLUMN[UNIT]";
      continue;
    }
    const ReadColumn& column = columns[*chosen[r]];
    const bool unknown = !column.text.unit.text.empty() && !column.text.unit.known();
    if (!column.scale.empty() || (unknown && !counts_days(column)) ||
        (role != Role::time && states_sensitivity(column.header))) {
      const bool right = fits(role, column.text.unit.si);
      map += std::to_string(*chosen[r] + 1) + "*FACTOR[" +
             (right ? column.text.unit.text : probable_unit(role, column)) + "]";
      continue;
    }
    map += typed(columns, *chosen[r]);
    if (role == Role::time && counts_tenths_of_us(column)) {
      map += "*1e-7[s]";
      continue;
    }
    if (role == Role::time && counts_days(column)) {
      map += "*86400[s]";
      continue;
    }
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

}  // namespace config::record
