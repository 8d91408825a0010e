#include "workbench/reproduce/tolerance.h"

#include <fmt/format.h>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>

namespace workbench::reproduce {
namespace {

constexpr Tolerance kTolerances[] = {
    {"information", Rule::none, false, 0, 0, "nothing printed to compare with"},
    {"solved for", Rule::none, false, 0, 0, "a free constant was chosen to give this very figure"},
    {"words", Rule::same, true, 0, 0, "the same verdict"},
    {"words, not expected", Rule::same, false, 0, 0,
     "the same verdict; it depends on how rounding spoils the thesis's normal equations"},
    {"cost, in step", Rule::relative, false, 0.01, 0,
     "1 %: six digits are printed, but gain and valve constant are not given well enough for more"},
    {"cost, out of step", Rule::relative, false, 0.01, 0,
     "1 %: as in step; a guess at how the printed figures came about"},
    {"mean b1", Rule::relative, true, 1e-4, 0,
     "0.01 %: the valve constant was solved for this figure"},
    {"mean b1, recursive", Rule::relative, true, 2e-4, 0,
     "0.02 %: as for the batch, and the recursion's wider spread"},
    {"mean b1, as printed", Rule::relative, false, 0.005, 0,
     "0.5 %: three digits of the printed parameters"},
    {"spread", Rule::relative, false, 0.1, 0,
     "10 %: spread of a noise-free run comes from start-up and rounding alone"},
    {"fall of the cost", Rule::relative, false, 0.05, 0,
     "5 %: which digits were kept, and the gain of the loop, are guesses"},
    {"spread, recursive", Rule::relative, true, 0.1, 0,
     "10 %: the forgetting factor was solved for another printed figure"},
    {"recursive cost", Rule::relative, false, 0.1, 0, "10 %: start and weights are not printed"},
    {"about +5 %", Rule::interval, true, 4.5, 5.5, "'about': a tenth either way"},
    {"about -5 %", Rule::interval, true, -5.5, -4.5, "'about': a tenth either way"},
    {"about +0.07 %", Rule::interval, true, 0.063, 0.077, "'about': a tenth either way"},
    {"about -0.07 %", Rule::interval, true, -0.077, -0.063, "'about': a tenth either way"},
    {"under 0.01 %", Rule::interval, true, -0.01, 0.01, "'less than 0.01 %'"},
    {"range over Ps", Rule::relative, false, 0.05, 0,
     "5 %: read off a figure with marks each 0.5e-4"},
    {"range over d", Rule::relative, false, 5e-4, 0,
     "0.05 %: half of the smallest step in which the figures on d are given"},
    {"alarm time", Rule::apart, true, -0.0051, 0.0051,
     "one sample: the last sample of a window comes 5 ms before the next window's first"},
    {"count", Rule::apart, true, 0, 0, "the same number"},
    {"about 3 s", Rule::interval, true, 2.5, 3.5, "'about 3 s': rounds to 3"},
    {"about 3 s, any phase", Rule::interval, false, 2.5, 3.5,
     "'about 3 s': rounds to 3; seen at one phase of the period only"},
    {"median 0.3 s", Rule::interval, true, 0.0, 0.3, "this product's requirement"},
    {"worst 0.6 s", Rule::interval, true, 0.0, 0.6, "this product's requirement"},
    {"no false alarm", Rule::interval, true, 0.0, 0.0, "this product's requirement"},
    {"rig b1", Rule::relative, true, 0.005, 0,
     "0.5 %: two standard deviations as printed; the valve constant was solved for this figure"},
    {"rig, about 5 %", Rule::relative, false, 0.1, 0, "'about': a tenth either way"},
    {"rig alarm time", Rule::apart, true, -0.0051, 0.0051,
     "one sample; the ramp of the pressure is assumed"},
    {"rig count", Rule::apart, false, 0, 0, "the same number"},
    {"rig figure", Rule::relative, false, 0.5, 0,
     "half of it: a figure of a real stand with a loop gain, friction and noise not printed"},
};

double number(const Value& value) {
  const double* found = std::get_if<double>(&value);
  return found == nullptr ? std::nan("") : *found;
}

bool agree(const Value& printed, const Value& ours, const Tolerance& rule) {
  const double is = number(ours);
  switch (rule.rule) {
    case Rule::relative:
      return std::abs(is - number(printed)) <= rule.low * std::abs(number(printed));
    case Rule::interval:
      return is >= rule.low && is <= rule.high;
    case Rule::apart:
      return is - number(printed) >= rule.low && is - number(printed) <= rule.high;
    case Rule::same:
      return printed == ours;
    case Rule::none:
      return false;
  }
  return false;
}

}  // namespace

const char* to_string(Agreement agreement) noexcept {
  constexpr const char* kTexts[] = {"yes", "no", "n.a."};
  return kTexts[static_cast<std::size_t>(agreement)];
}

const Tolerance& tolerance(std::string_view name) {
  const auto* found = std::find_if(std::begin(kTolerances), std::end(kTolerances),
                                   [&](const Tolerance& t) { return t.name == name; });
  assert(found != std::end(kTolerances));
  return *found;
}

ReproducedRow judged(std::string what, Value printed, Value ours, std::string_view rule,
                     std::string note) {
  const Tolerance& by = tolerance(rule);
  ReproducedRow row;
  row.what = std::move(what);
  row.printed = std::move(printed);
  row.ours = std::move(ours);
  row.note = std::move(note);
  row.tolerance = by.reason;
  row.expected = by.expected;
  if (by.rule != Rule::none) {
    row.agrees = agree(row.printed, row.ours, by) ? Agreement::yes : Agreement::no;
  }
  return row;
}

namespace {

constexpr std::size_t kWhatWidth = 78;
constexpr std::size_t kValueWidth = 22;

std::string shown(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:.6g}", *number);
  if (const auto* words = std::get_if<std::string>(&value)) return *words;
  return "-";
}

nlohmann::json json(const Value& value) {
  // JSON knows no infinity and no NaN.
  if (const auto* number = std::get_if<double>(&value)) {
    return std::isfinite(*number) ? nlohmann::json(*number) : nlohmann::json(nullptr);
  }
  if (const auto* words = std::get_if<std::string>(&value)) return *words;
  return nullptr;
}

std::string padded(std::string cell, std::size_t width) {
  cell.resize(std::max(width, cell.size()), ' ');
  return cell + ' ';
}

}  // namespace

void print_table(std::ostream& out, std::span<const ReproducedSection> sections) {
  int counts[3] = {0, 0, 0};
  for (const ReproducedSection& section : sections) {
    out << '\n'
        << section.title << '\n'
        << padded("", kWhatWidth + 2) << padded("printed", kValueWidth)
        << padded("ours", kValueWidth) << "agrees\n";
    for (const ReproducedRow& row : section.rows) {
      ++counts[static_cast<int>(row.agrees)];
      out << "  " << padded(row.what, kWhatWidth) << padded(shown(row.printed), kValueWidth)
          << padded(shown(row.ours), kValueWidth) << to_string(row.agrees)
          << (row.note.empty() ? "" : "  " + row.note) << '\n';
    }
  }
  out << '\n'
      << counts[0] << " agree, " << counts[1] << " do not, " << counts[2]
      << " have nothing to be compared with.\n";
}

void print_json(std::ostream& out, std::span<const ReproducedSection> sections) {
  nlohmann::json rows = nlohmann::json::array();
  for (const ReproducedSection& section : sections) {
    for (const ReproducedRow& row : section.rows) {
      rows.push_back({{"what", row.what},
                      {"printed", json(row.printed)},
                      {"ours", json(row.ours)},
                      {"agrees", to_string(row.agrees)},
                      {"note", row.note},
                      {"section", section.title},
                      {"tolerance", row.tolerance},
                      {"expected", row.expected}});
    }
  }
  out << nlohmann::json{{"rows", rows}}.dump(2) << '\n';
}

}  // namespace workbench::reproduce
