#include "workbench/present/resonance_json.h"

#include "workbench/present/json.h"

namespace workbench::present {

nlohmann::ordered_json resonance_json(const std::optional<estimator::spectra::Resonance>& found) {
  if (!found) return nullptr;
  return {{"frequency_Hz", number_or_null(found->frequency_Hz)},
          {"damping_ratio", number_or_null(found->damping_ratio)},
          {"std_error",
           {{"frequency_Hz", number_or_null(found->frequency_error_Hz)},
            {"damping_ratio", number_or_null(found->damping_error)}}}};
}

}  // namespace workbench::present
