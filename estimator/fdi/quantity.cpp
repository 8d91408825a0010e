#include "estimator/fdi/quantity.h"

#include <limits>

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
