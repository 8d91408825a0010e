// Further columns of a record, from a daemon's samples beyond time, command and position.
//
//   reference_m, u_requested_V, quality, state, saturated    of the sample itself
//   rod_in_charge, rod_1_m, rod_2_m, ...                     where a log has several rod sensors
//   supply_pressure_Pa, pressure_in_Pa, pressure_out_Pa      where a log has pressures
//
// Rod sensors count from 1, the configured one first, as in the quantities sample.rod_1_m, ...
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "spoolwatch/pressures_t.hpp"
#include "spoolwatch/rods_t.hpp"

namespace spoolwatch {
class sample_t;
}

namespace config::record {

inline constexpr const char* kSupplyPressure = "supply_pressure_Pa";
inline constexpr const char* kPressureIn = "pressure_in_Pa";
inline constexpr const char* kPressureOut = "pressure_out_Pa";
inline constexpr const char* kRodInCharge = "rod_in_charge";
/// "rod_1_m" of 0.
[[nodiscard]] std::string rod_column(std::size_t rod);

class SampleColumns {
 public:
  SampleColumns();

  /// Takes what comes just before its sample. The first of a kind adds columns at the end.
  void note(const spoolwatch::rods_t& rods);
  void note(const spoolwatch::pressures_t& pressures);

  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
  /// In the order of the names; NaN where no message belongs to this sample.
  [[nodiscard]] const std::vector<double>& row(const spoolwatch::sample_t& sample);

 private:
  spoolwatch::rods_t rods_{};  ///< the newest
  spoolwatch::pressures_t pressures_{};
  std::size_t rod_columns_ = 0;       ///< place of the first, 0: none
  std::size_t pressure_columns_ = 0;  ///< likewise
  std::size_t rods_shown_ = 0;
  std::vector<std::string> names_;
  std::vector<double> row_;
};

}  // namespace config::record
