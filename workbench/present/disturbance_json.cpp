#include "workbench/present/disturbance_json.h"

#include <cmath>

#include "workbench/present/json.h"

namespace workbench::present {

namespace selection = estimator::greybox::selection;

nlohmann::ordered_json disturbance_json(const std::optional<selection::Disturbance>& found) {
  if (!found) return nullptr;
  nlohmann::ordered_json json;
  json["rms_m"] = number_or_null(found->rms_m);
  json["share"] = number_or_null(found->share);
  json["as"] = found->as;
  json["value"] = number_or_null(found->value);
  json["corner_Hz"] = number_or_null(found->corner_Hz);
  json["lines"] = nlohmann::ordered_json::array();
  for (const selection::DisturbanceLine& line : found->lines) {
    nlohmann::ordered_json rivals = nlohmann::ordered_json::array();
    for (const selection::LineRival& rival : line.rivals)
      rivals.push_back({{"as", rival.as}, {"amplitude", number_or_null(rival.amplitude)}});
    json["lines"].push_back({{"frequency_Hz", number_or_null(line.frequency_Hz)},
                             {"as", line.as},
                             {"amplitude", number_or_null(line.amplitude)},
                             {"amplitude_m", number_or_null(std::sqrt(2.0) * line.rms_m)},
                             {"rivals", std::move(rivals)}});
  }
  return json;
}

}  // namespace workbench::present
