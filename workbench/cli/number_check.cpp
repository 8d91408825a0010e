#include "workbench/cli/number_check.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <sstream>
#include <string>

namespace workbench::cli {
namespace {

/// Refuses text that is no number or a number that `good` refuses.
template <class Good>
CLI::Validator check(const std::string& allowed, Good good) {
  const auto refuse = [allowed, good](const std::string& text) {
    double value = 0.0;
    const bool taken = CLI::detail::lexical_cast(text, value) && good(value);
    return taken ? std::string() : "is " + text + "; allowed: " + allowed;
  };
  return CLI::Validator(refuse, "");
}

}  // namespace

CLI::Validator positive_number() {
  return check("above 0, finite", [](double x) { return x > 0.0 && std::isfinite(x); });
}

CLI::Validator number_within(double low, double high) {
  std::ostringstream allowed;
  allowed << low << " to " << high;
  return check(allowed.str(), [low, high](double x) { return x >= low && x <= high; });
}

CLI::Validator finite_number() {
  return check("a finite number", [](double x) { return std::isfinite(x); });
}

}  // namespace workbench::cli
