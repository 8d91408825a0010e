#include "config/record/layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "config/schema/error.h"

namespace config::record {
namespace {

struct ColumnUnit {
  std::string_view suffix;
  std::string_view si;
  double factor;
};

constexpr double kPsi_Pa = 6894.757293168361;

constexpr std::array kUnits{
    ColumnUnit{"s", "s", 1.0},        ColumnUnit{"ms", "s", 1e-3},     ColumnUnit{"us", "s", 1e-6},
    ColumnUnit{"V", "V", 1.0},        ColumnUnit{"mV", "V", 1e-3},     ColumnUnit{"m", "m", 1.0},
    ColumnUnit{"cm", "m", 1e-2},      ColumnUnit{"mm", "m", 1e-3},     ColumnUnit{"um", "m", 1e-6},
    ColumnUnit{"mps", "mps", 1.0},    ColumnUnit{"mmps", "mps", 1e-3}, ColumnUnit{"Pa", "Pa", 1.0},
    ColumnUnit{"kPa", "Pa", 1e3},     ColumnUnit{"MPa", "Pa", 1e6},    ColumnUnit{"bar", "Pa", 1e5},
    ColumnUnit{"psi", "Pa", kPsi_Pa}, ColumnUnit{"N", "N", 1.0},       ColumnUnit{"kN", "N", 1e3},
};

}  // namespace

RecordColumn parse_column(std::string_view name) {
  const std::size_t underscore = name.rfind('_');
  if (underscore != std::string_view::npos && underscore > 0) {
    for (const ColumnUnit& unit : kUnits) {
      if (name.substr(underscore + 1) == unit.suffix) {
        const std::string stem(name.substr(0, underscore));
        return {stem, std::string(unit.si), stem + "_" + std::string(unit.si), unit.factor};
      }
    }
  }
  return {std::string(name), "", std::string(name), 1.0};
}

namespace {

using schema::bad_data;

struct MainColumn {
  MissingColumn missing;
  const char* si_unit;
  const char* allowed;
  std::vector<double> Record::*values;
};

constexpr std::array kMain = {
    MainColumn{{"time", "t_s, t_ms"}, "s", "t_s, t_ms", &Record::t_s},
    MainColumn{{"command", "u_V, u_mV"}, "V", "u_V, u_mV", &Record::u_V},
    MainColumn{{"position", "y_m, y_mm"}, "m", "y_m, y_mm, y_um", &Record::y_m},
};

const MainColumn* main_of(const RecordColumn& column) {
  if (is_time(column)) return kMain.data();
  if (column.stem == "u") return &kMain[1];
  if (column.stem == "y") return &kMain[2];
  return nullptr;
}

void refuse_clash(const std::vector<RecordColumn>& columns, const std::vector<std::string>& names,
                  std::size_t i, const std::string& where) {
  for (std::size_t j = 0; j < i; ++j) {
    const std::string both = names[j] + " and " + names[i];
    if (names[i] == names[j]) throw bad_data(where, "has column " + names[i] + " twice");
    if (is_time(columns[i]) && is_time(columns[j])) {
      throw bad_data(where, "has two time columns, " + both);
    }
    const bool main = columns[i].stem == "u" || columns[i].stem == "y";
    const bool same_stem = columns[i].stem == columns[j].stem && !columns[i].si_unit.empty() &&
                           !columns[j].si_unit.empty();
    if (same_stem && (main || columns[i].si_unit == columns[j].si_unit)) {
      throw bad_data(where, "has contradictory units: " + both);
    }
  }
}

}  // namespace

bool is_time(const RecordColumn& column) { return column.stem == "t" || column.stem == "time"; }

bool is_main(const RecordColumn& column) { return main_of(column) != nullptr; }

std::vector<Target> lay_out(const std::vector<std::string>& names, const std::string& where,
                            Record& record) {
  std::vector<RecordColumn> columns;
  columns.reserve(names.size());
  for (const std::string& name : names) columns.push_back(parse_column(name));
  std::vector<Target> targets;
  record.further.reserve(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    refuse_clash(columns, names, i, where);
    const RecordColumn& column = columns[i];
    if (const MainColumn* main = main_of(column); main == nullptr) {
      record.further.emplace_back(column.si_name, std::vector<double>{});
      targets.push_back({names[i], column.factor, &record.further.back().second, true});
    } else if (column.si_unit == main->si_unit) {
      targets.push_back({names[i], column.factor, &(record.*main->values), false});
    } else {
      throw bad_data(where,
                     "column " + names[i] +
                         (column.si_unit.empty() ? " has no unit" : " has a contradictory unit"),
                     main->allowed);
    }
  }
  return targets;
}

const MissingColumn* first_missing(const std::vector<Target>& targets, const Record& record) {
  for (const MainColumn& main : kMain) {
    const bool found = std::any_of(targets.begin(), targets.end(), [&](const Target& target) {
      return target.values == &(record.*main.values);
    });
    if (!found) return &main.missing;
  }
  return nullptr;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string shown(text.substr(0, kLongest));
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < ' ') c = '?';
  }
  return "'" + shown + (text.size() > kLongest ? "...'" : "'");
}

namespace {

/// Share of a period by which a step may miss the grid: time stamps rounded to 1 ms at 130 Hz do so
/// by up to 0.125.
constexpr double kJitter = 0.15;
/// Relative error of the median step that a long gap multiplies.
constexpr double kMedianError = 1e-3;
constexpr std::size_t kStepsPerGap = 10;

std::string in_ms(double time_s) {
  std::ostringstream out;
  out << time_s * 1e3 << " ms";
  return out.str();
}

}  // namespace

TimeGrid find_grid(const std::vector<double>& t_s,
                   const std::function<std::string(std::size_t)>& where) {
  using schema::bad_data;
  if (t_s.size() < 3) throw bad_data(where(0), "has fewer than 3 samples");
  std::vector<double> steps(t_s.size() - 1);
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    steps[i - 1] = t_s[i] - t_s[i - 1];
    if (!(steps[i - 1] > 0.0)) throw bad_data(where(i), "time does not increase");
  }
  std::vector<double> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double median_s = *middle;

  TimeGrid grid;
  double periods = 0.0;
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    const double ratio = steps[i - 1] / median_s;
    const double whole = std::round(ratio);
    const double allowed = std::min(0.5, kJitter + kMedianError * (whole - 1.0));
    if (whole < 1.0 || std::abs(ratio - whole) > allowed) {
      throw bad_data(where(i), "is unevenly sampled: a step of " + in_ms(steps[i - 1]),
                     "whole numbers of the median step, " + in_ms(median_s));
    }
    if (whole > 1.0) grid.gaps.push_back(i);
    periods += whole;
  }
  if (grid.gaps.size() * kStepsPerGap > steps.size() && grid.gaps.size() > 1) {
    throw bad_data(where(grid.gaps.front()),
                   "is unevenly sampled: " + std::to_string(grid.gaps.size()) + " of " +
                       std::to_string(steps.size()) + " steps are longer than the median step, " +
                       in_ms(median_s));
  }
  grid.sample_time_s = (t_s.back() - t_s.front()) / periods;
  return grid;
}

}  // namespace config::record
