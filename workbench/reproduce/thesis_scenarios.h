// The simulated stand as the experiments use it: shipped models, constant conditions, fault
// schedules, ideal or real instruments; and records of it.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "workbench/simulate/scenario.h"

namespace workbench::reproduce {

using simulate::Scenario;

/// Samples in one period of the reference (0.5 Hz at 200 Hz).
inline constexpr std::size_t kPeriod = 400;
/// The rod's middle position, taken out of y before estimation.
inline constexpr double kOffset_m = 0.305;
/// The source's conversion: 1,000 psi = 6.89e6 Pa.
inline constexpr double kPa_per_psi = 6890.0;

/// A model of config/models by its file name without ".toml", with ideal instruments.
[[nodiscard]] Scenario shipped(std::string_view model);
/// The model that cases I to III run on.
[[nodiscard]] Scenario calibrated();

/// The scenario with one parameter at another value, from the start.
[[nodiscard]] Scenario with(Scenario scenario, std::string_view parameter, double value);
/// The scenario with a further change at at_s, ramp_s long.
[[nodiscard]] Scenario with_fault(Scenario scenario, std::string_view parameter, double value,
                                  double at_s, double ramp_s = 0.0);
/// 5 um encoder, 12-bit D/A of +-10 V, 2 um noise.
[[nodiscard]] Scenario with_real_instruments(Scenario scenario);

struct ScenarioRecord {
  std::vector<double> u_V;
  std::vector<double> y_m;  ///< offset removed

  [[nodiscard]] std::span<const double> u(std::size_t from, std::size_t count) const {
    return std::span(u_V).subspan(from, count);
  }
  [[nodiscard]] std::span<const double> y(std::size_t from, std::size_t count) const {
    return std::span(y_m).subspan(from, count);
  }
};

[[nodiscard]] ScenarioRecord run(const Scenario& scenario, double duration_s,
                                 std::uint64_t seed = 1);

/// The test stand's preset: 2.5 um encoder, 0.2 um noise, 12-bit D/A of +-10 V.
[[nodiscard]] inline Scenario with_rig_instruments(Scenario scenario) {
  scenario.instruments = {2.5e-6, 0.2e-6, 12, 10.0};
  return scenario;
}

/// TOML text of a file of config/models or of config/thesis_case*.toml, as built in; the name is
/// without folder. Asserts that there is such a file.
[[nodiscard]] std::string_view shipped_model_text(std::string_view name);

}  // namespace workbench::reproduce
