#include "workbench/reproduce/print.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <ostream>

namespace workbench::reproduce {
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
