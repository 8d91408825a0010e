#include "estimator/fdi/quantity.h"

#include <limits>

#include "config/schema/error.h"

namespace estimator::fdi {

QuantityName split_quantity(std::string_view quantity) noexcept {
  const std::size_t dot = quantity.rfind('.');
  if (dot == std::string_view::npos) return {{}, quantity};
  return {quantity.substr(0, dot), quantity.substr(dot + 1)};
}

std::vector<std::string> estimate_names(const Structure& structure) {
  std::vector<std::string> names = structure.names();
  names.emplace_back("residual_rms_m");
  names.emplace_back("condition");
  return names;
}

SampleQuantity parse_sample_quantity(std::string_view name, const std::string& where) {
  if (name == "y_m") return SampleQuantity::y;
  if (name == "u_V") return SampleQuantity::u;
  if (name == "reference_m") return SampleQuantity::reference;
  if (name == "following_error_m") return SampleQuantity::following_error;
  throw config::schema::bad_config(where, "a sample has no " + std::string(name),
                                   "y_m, u_V, reference_m, following_error_m");
}

double usable_y_m(const Sample& sample) noexcept {
  const bool usable = sample.quality == Quality::good || sample.quality == Quality::uncertain;
  return usable ? sample.y_m : std::numeric_limits<double>::quiet_NaN();
}

double value_of(SampleQuantity quantity, const Sample& sample) noexcept {
  switch (quantity) {
    case SampleQuantity::y:
      return usable_y_m(sample);
    case SampleQuantity::u:
      return sample.u_applied_V;
    case SampleQuantity::reference:
      return sample.reference_m;
    case SampleQuantity::following_error:
      return sample.reference_m - usable_y_m(sample);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace estimator::fdi
