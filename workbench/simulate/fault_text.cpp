#include "workbench/simulate/fault_text.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include "config/schema/error.h"

namespace workbench::simulate {
namespace {

/// The whole of `text` as a finite number into `value`.
bool parse_number(std::string_view text, double& value) {
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  return result.ec == std::errc{} && result.ptr == text.data() + text.size() &&
         std::isfinite(value);
}

}  // namespace

plant_sim::Change parse_fault(const std::string& text) {
  const auto refuse = [&] {
    return config::schema::UsageError("--fault " + text +
                                      ": is no fault; allowed: PARAMETER=VALUE@SECONDS or "
                                      "PARAMETER*FACTOR@SECONDS, then +SECONDS for a ramp");
  };
  const std::size_t mark = text.find_first_of("=*");
  const std::size_t at = text.find('@');
  if (mark == std::string::npos || mark == 0 || at == std::string::npos || at < mark) {
    throw refuse();
  }
  const std::string_view all = text;
  std::string_view time = all.substr(at + 1);
  plant_sim::Change change;
  change.parameter = text.substr(0, mark);
  // A '+' that follows 'e' belongs to an exponent.
  std::size_t plus = time.find('+');
  if (plus != std::string_view::npos && plus > 0 && time[plus - 1] == 'e') {
    plus = time.find('+', plus + 1);
  }
  if (plus != std::string_view::npos) {
    if (!parse_number(time.substr(plus + 1), change.ramp_s)) throw refuse();
    time = time.substr(0, plus);
  }
  double& amount = text[mark] == '=' ? change.value : change.factor;
  if (!parse_number(time, change.at_s) ||
      !parse_number(all.substr(mark + 1, at - mark - 1), amount) || change.at_s < 0.0 ||
      change.ramp_s < 0.0) {
    throw refuse();
  }
  return change;
}

}  // namespace workbench::simulate
