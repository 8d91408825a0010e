// A resonance that a model lacks, as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "estimator/spectra/resonance.h"

namespace workbench::present {

/// frequency_Hz and damping_ratio with their std_error; null for none.
[[nodiscard]] nlohmann::ordered_json resonance_json(
    const std::optional<estimator::spectra::Resonance>& found);

}  // namespace workbench::present
