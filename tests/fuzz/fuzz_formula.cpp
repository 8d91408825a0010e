// A user's own effect: site, names of two parameters and formula, one a line; compiled, checked and
// evaluated.
#include <cmath>
#include <string>

#include "plant_sim/formula/formula.h"
#include "tests/fuzz/input.h"

namespace {

std::string take_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  std::string line(rest.substr(0, end));
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return line;
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it by this name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest = fuzz::text_of(data, size);
  plant_sim::formula::FormulaEffect effect;
  effect.name = "fuzzed";
  effect.site = take_line(rest);
  for (int i = 0; i < 2; ++i) {
    plant_sim::formula::FormulaEffect::Parameter parameter;
    parameter.name = take_line(rest);
    parameter.max = 10.0;
    parameter.typical = 1.0;
    if (!parameter.name.empty()) effect.parameters.push_back(parameter);
  }
  effect.formula = rest;
  fuzz::allow_errors([&] {
    const plant_sim::formula::PlausibleRanges ranges{.opening_m = {-1e-3, 1e-3},
                                                     .flow_m3ps = {-1e-3, 1e-3},
                                                     .pressure_Pa = {0.0, 2e7},
                                                     .position_m = {0.0, 0.6}};
    const plant_sim::formula::Formula formula = plant_sim::formula::compile(effect, ranges, "fuzz");
    plant_sim::formula::ExpressionEvaluator<double> run(view_of(formula.program));
    const double values[] = {1.0, 2.0};
    run.set_parameters(values);
    const plant_sim::formula::Signals<double> at{0.1, 0.2};
    (void)run(at.data());
    plant_sim::formula::check(effect, formula, "fuzz");
  });
  return 0;
}
