// How soon null was at a valve that somebody watches, and what `--check` states for it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

namespace program {

/// Voltages that still count as null: two steps of the converter.
inline constexpr double kNull_V = 0.01;

/// An observation of the rig between two times.
struct Look {
  std::int64_t before_ns, after_ns;
  double command_V, valve_V, rod_m;
};

struct Stated {
  double time_s = std::nan("");
  double travel_m = std::nan("");
};

/// The row of `--check`.
inline Stated stated(const std::string& table, const std::string& failure) {
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("# " + failure + " ", 0) != 0) continue;
    std::istringstream rest(line.substr(2 + failure.size()));
    std::string backend;
    Stated row;
    rest >> backend >> row.time_s >> row.travel_m;
    return {row.time_s * 1e-3, row.travel_m * 1e-3};
  }
  return {};
}

struct Measured {
  double least_s;  ///< it was longer than that
  double most_s;   ///< and shorter than that
  double travel_m;
};

inline Measured measure(const std::vector<Look>& looks, std::int64_t begin_ns,
                        std::int64_t begun_ns, bool at_command) {
  Measured measured{0.0, std::nan(""), 0.0};
  double start_m = std::nan("");
  for (const Look& look : looks) {
    if (look.after_ns < begin_ns) {
      start_m = look.rod_m;
      continue;
    }
    measured.travel_m = std::max(measured.travel_m, std::abs(look.rod_m - start_m));
    const double u_V = at_command ? look.command_V : look.valve_V;
    if (std::abs(u_V) < kNull_V) {
      measured.most_s = static_cast<double>(look.after_ns - begin_ns) * 1e-9;
      return measured;
    }
    measured.least_s = std::max(0.0, static_cast<double>(look.before_ns - begun_ns) * 1e-9);
  }
  return measured;
}

}  // namespace program
