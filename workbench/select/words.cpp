#include "workbench/select/words.h"

#include <fmt/format.h>

#include <cmath>

namespace workbench::select {

std::string number_words(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  const double size = std::abs(value);
  if (size != 0.0 && (size < 1e-3 || size >= 1e6)) return fmt::format("{:.{}e}", value, digits - 1);
  const int before = size >= 1.0 ? static_cast<int>(std::floor(std::log10(size))) + 1 : 1;
  int after = digits - before;
  if (size < 1.0 && size > 0.0) after = digits - 1 - static_cast<int>(std::floor(std::log10(size)));
  return fmt::format("{:.{}f}", value, after > 0 ? after : 0);
}

std::string more_words(double ratio) {
  if (ratio >= 2.0) return number_words(ratio, 2) + " times";
  return number_words(100.0 * (ratio - 1.0), 2) + " % more than";
}

std::string method_words(const std::string& method) {
  if (method == "RLS") return "recursive least squares";
  if (method == "RML") return "recursive maximum likelihood or extended least squares";
  if (method == "RPEM") return "recursive prediction error";
  return method;
}

}  // namespace workbench::select
