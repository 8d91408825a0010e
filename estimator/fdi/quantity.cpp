#include "estimator/fdi/quantity.h"

#include "config/signals/nan.h"

namespace estimator::fdi {
namespace {

using config::signals::kNaN;

double trusted(config::signals::Quality quality, double y_m) noexcept {
  return quality == config::signals::Quality::good || quality == config::signals::Quality::uncertain
             ? y_m
             : kNaN;
}

constexpr std::size_t index_of(SampleQuantity rod) noexcept {
  return static_cast<std::size_t>(rod) - static_cast<std::size_t>(SampleQuantity::rod_1);
}

}  // namespace

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

double usable_y_m(const config::signals::Sample& sample) noexcept {
  return sample.rod_changed ? kNaN : trusted(sample.quality, sample.y_m);
}

std::size_t rod_of(std::string_view quantity) noexcept {
  const QuantityName name = split_quantity(quantity);
  if (name.source != kSampleSource) return 0;
  for (const NamedSampleQuantity& each : kSampleQuantities) {
    if (each.name == name.name && each.quantity >= SampleQuantity::rod_1) {
      return index_of(each.quantity) + 1;
    }
  }
  return 0;
}

double value_of(SampleQuantity quantity, const config::signals::Sample& sample) noexcept {
  switch (quantity) {
    case SampleQuantity::y:
      return trusted(sample.quality, sample.y_m);
    case SampleQuantity::u:
      return sample.u_applied_V;
    case SampleQuantity::reference:
      return sample.reference_m;
    case SampleQuantity::following_error:
      return sample.reference_m - trusted(sample.quality, sample.y_m);
    case SampleQuantity::supply_pressure:
      return sample.pressures.supply_Pa;
    case SampleQuantity::pressure_in:
      return sample.pressures.in_Pa;
    case SampleQuantity::pressure_out:
      return sample.pressures.out_Pa;
    case SampleQuantity::rod_in_charge:
      return sample.rod_count > 0 ? sample.rod_in_charge + 1.0 : kNaN;
    default:
      break;
  }
  const std::size_t rod = index_of(quantity);
  return rod < sample.rod_count && rod < config::signals::kMaxRods
             ? trusted(sample.rod_quality[rod], sample.rod_m[rod])
             : kNaN;
}

}  // namespace estimator::fdi
