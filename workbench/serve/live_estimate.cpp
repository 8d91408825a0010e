#include "workbench/serve/live_estimate.h"

#include <fmt/format.h>

#include <cmath>

#include "config/units/printed_scale.h"
#include "config/units/quantity.h"
#include "spoolwatch/estimate_t.hpp"
#include "workbench/live/listen_lines.h"
#include "workbench/present/json.h"
#include "workbench/present/text.h"
#include "workbench/serve/detectable.h"

namespace workbench::serve {
namespace {

/// "60 to 75 bar", "above 60 bar"; "" without limits.
std::string band_text(const std::string& name, double value, double low, double high) {
  const double size = std::isfinite(value) ? value : std::isfinite(high) ? high : low;
  if (!std::isfinite(low) && !std::isfinite(high)) return "";
  const config::units::PrintedScale scale = config::units::printed_scale(name, size);
  const auto number = [&](double limit) { return fmt::format("{:.4g}", limit / scale.in_si); };
  std::string text = !std::isfinite(high)  ? "above " + number(low)
                     : !std::isfinite(low) ? "below " + number(high)
                                           : number(low) + " to " + number(high);
  return scale.unit.empty() ? text : text + " " + scale.unit;
}

}  // namespace

nlohmann::ordered_json live_estimate(const spoolwatch::estimate_t& e) {
  using nlohmann::ordered_json;
  ordered_json shown = ordered_json::parse(live::json(e), nullptr, false);
  shown["reason"] = present::typeset(e.reason);
  for (const char* const column : {"words", "text", "band", "seen_down_ratio", "seen_up_ratio"}) {
    shown[column] = ordered_json::array();
  }
  for (std::size_t i = 0; i < e.value.size(); ++i) {
    shown["words"].push_back(e.source + ": " + config::units::parameter_words(e.name[i]));
    shown["text"].push_back(e.valid ? present::typeset(config::units::words(config::units::quantity(
                                          e.name[i], e.value[i], e.std_error[i])))
                                    : "-");
    shown["band"].push_back(
        present::typeset(band_text(e.name[i], e.value[i], e.low[i], e.high[i])));
    if (!e.valid) continue;
    const DetectableChange seen =
        detectable_change(e.value[i], e.std_error[i], e.low[i], e.high[i]);
    shown["seen_down_ratio"].push_back(present::number_or_null(seen.down_ratio));
    shown["seen_up_ratio"].push_back(present::number_or_null(seen.up_ratio));
  }
  return shown;
}

}  // namespace workbench::serve
