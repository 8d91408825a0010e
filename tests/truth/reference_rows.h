// Rows of a table that SciPy's solve_ivp wrote: NAME, t, u, then six states.
#pragma once

#include <array>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace truth {

using ReferenceRow = std::array<double, 8>;  ///< t_s, u_V, then the states in SI

/// The rows of `name` in a file under tests/plant_sim. Throws std::runtime_error where there is
/// none.
inline std::vector<ReferenceRow> reference_rows(const std::string& file, const std::string& name) {
  std::ifstream in(SPOOLWATCH_SOURCE_DIR "/tests/plant_sim/" + file);
  std::vector<ReferenceRow> rows;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    std::string field;
    std::getline(fields, field, ',');
    if (field != name) continue;
    ReferenceRow row{};
    for (double& value : row) {
      std::getline(fields, field, ',');
      value = std::stod(field);
    }
    rows.push_back(row);
  }
  if (rows.empty()) throw std::runtime_error(file + " has no rows of " + name);
  return rows;
}

}  // namespace truth
