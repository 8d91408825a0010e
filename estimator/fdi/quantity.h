// Named quantities that a band can monitor.
//
//   ESTIMATOR.a1 .b1 .constant .residual_rms_m .condition    of the estimator with that id
//   METHOD.name                     any other detection method (detection_method.h)
//   sample.y_m .u_V .reference_m    every sample
//   sample.following_error_m        reference minus position
//   sample.supply_pressure_Pa .pressure_in_Pa .pressure_out_Pa    NaN where the rig has no sensor
//   sample.rod_1_m ... .rod_5_m .rod_in_charge    rigs with several position sensors, the
//                                   configured one first; NaN elsewhere
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "config/signals/sample.h"
#include "estimator/structure.h"

namespace estimator::fdi {

inline constexpr std::string_view kSampleSource = "sample";

/// One number of a method, with its uncertainty and limits.
struct EstimatedValue {
  std::string_view name;  ///< a1, b1, constant, residual_rms_m, ...
  double value;
  double std_error;  ///< NaN where unknown
  double low;        ///< band, NaN where none is set
  double high;
};

/// "period.b1", split at the last dot.
struct QuantityName {
  std::string_view source;
  std::string_view name;
};
[[nodiscard]] QuantityName split_quantity(std::string_view quantity) noexcept;

/// Names of an estimate's values in their order: coefficients, residual_rms_m, condition.
[[nodiscard]] std::vector<std::string> estimate_names(const Structure& structure);

enum class SampleQuantity {
  y,
  u,
  reference,
  following_error,
  supply_pressure,
  pressure_in,
  pressure_out,
  rod_in_charge,
  rod_1,
  rod_2,
  rod_3,
  rod_4,
  rod_5
};
struct NamedSampleQuantity {
  SampleQuantity quantity;
  std::string_view name;
};
inline constexpr std::array<NamedSampleQuantity, 13> kSampleQuantities = {
    {{SampleQuantity::y, "y_m"},
     {SampleQuantity::u, "u_V"},
     {SampleQuantity::reference, "reference_m"},
     {SampleQuantity::following_error, "following_error_m"},
     {SampleQuantity::supply_pressure, "supply_pressure_Pa"},
     {SampleQuantity::pressure_in, "pressure_in_Pa"},
     {SampleQuantity::pressure_out, "pressure_out_Pa"},
     {SampleQuantity::rod_in_charge, "rod_in_charge"},
     {SampleQuantity::rod_1, "rod_1_m"},
     {SampleQuantity::rod_2, "rod_2_m"},
     {SampleQuantity::rod_3, "rod_3_m"},
     {SampleQuantity::rod_4, "rod_4_m"},
     {SampleQuantity::rod_5, "rod_5_m"}}};
/// NaN when missing, or of stale or bad quality.
[[nodiscard]] double value_of(SampleQuantity quantity,
                              const config::signals::Sample& sample) noexcept;

/// Number of the position sensor, from 1, that "sample.rod_2_m" names; 0: another quantity.
[[nodiscard]] std::size_t rod_of(std::string_view quantity) noexcept;

/// Position that an estimator may use: good or uncertain, and from the same sensor as the sample
/// before; NaN otherwise.
[[nodiscard]] double usable_y_m(const config::signals::Sample& sample) noexcept;

}  // namespace estimator::fdi
