// The unit in which a parameter stands on the page: one for its whole range.
#pragma once

#include <algorithm>
#include <cmath>

#include "config/units/printed_scale.h"
#include "estimator/greybox/parameter_catalogue.h"

namespace workbench::serve {

/// That of its value; an effect at rest is printed as one of typical size.
[[nodiscard]] inline config::units::PrintedScale slider_unit(
    const estimator::greybox::CatalogueParameter& parameter, double value) {
  const double usual = parameter.effect.empty() ? 0.0 : std::abs(parameter.info.typical);
  return config::units::printed_scale(parameter.name, std::max(std::abs(value), usual));
}

}  // namespace workbench::serve
