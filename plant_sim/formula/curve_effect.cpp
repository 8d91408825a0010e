#include "plant_sim/formula/curve_effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/schema/error.h"
#include "plant_sim/formula/curve_evaluator.h"

namespace plant_sim::formula {
namespace {

using config::schema::bad_config;

constexpr std::size_t kMostPoints = 40;
/// Largest value over the size of a curve's values.
constexpr double kReach = 1e3;

std::string value_name(std::size_t i) { return fmt::format("f{}", i + 1); }

/// Slope of the curve at point i, an expression of its values.
std::string slope(const std::vector<double>& x, std::size_t i) {
  const SlopeWeights weights = slope_weights<double>(x.data(), x.size(), i);
  const auto part = [](double weight, std::size_t from) {
    return fmt::format("{}*({} - {})", weight, value_name(from + 1), value_name(from));
  };
  if (i == 0) return part(weights.after, 0);
  const std::string before = part(weights.before, i - 1);
  return i + 1 == x.size() ? before : fmt::format("({} + {})", before, part(weights.after, i));
}

/// A number as an operand.
std::string operand(double value) {
  return value < 0.0 ? fmt::format("({})", value) : fmt::format("{}", value);
}

/// The curve between points i and i + 1 less its value at the first; 0 below, all of it above.
std::string piece(const CurveTable& shape, std::size_t i) {
  const double from = shape.x[i];
  const double way = shape.x[i + 1] - from;
  const std::string t = fmt::format("max(min(({} - {})/{}, 1), 0)", shape.over, operand(from), way);
  const std::string d = fmt::format("({} - {})", value_name(i + 1), value_name(i));
  const std::string g = fmt::format("({}*{})", way, slope(shape.x, i));
  const std::string e = fmt::format("({}*{})", way, slope(shape.x, i + 1));
  return fmt::format("{0}*({2} + {0}*((3*{1} - 2*{2} - {3}) + {0}*({2} + {3} - 2*{1})))", t, d, g,
                     e);
}

}  // namespace

void derive_formula(FormulaEffect& effect) {
  const CurveTable& curve = *effect.curve;
  double size = 0.0;
  for (const double value : curve.f) size = std::max(size, std::abs(value));
  if (!(size > 0.0)) size = 1.0;
  effect.parameters.clear();
  std::string sum = curve.x.empty() ? "0" : value_name(0);
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (i + 1 < curve.x.size()) sum += " + " + piece(curve, i);
    effect.parameters.push_back({value_name(i), fmt::format("value at {}", curve.x[i]),
                                 -kReach * size, kReach * size, size, 0.0});
  }
  if (!curve.times.empty()) sum = curve.times + "*(" + sum + ")";
  const FormulaSite* const place = find_formula_site(effect.site);
  const bool chained = place != nullptr && place->chained;
  effect.formula = chained ? std::string(kSignalNames[place->first]) + " + " + sum : sum;
}

void check_points(const FormulaEffect& effect, const std::string& where) {
  const std::vector<double>& x = effect.curve->x;
  if (x.size() < 2 || x.size() > kMostPoints) {
    throw bad_config(where + " x", fmt::format("has {} points", x.size()),
                     fmt::format("2 to {}", kMostPoints));
  }
  if (effect.curve->f.size() != x.size()) {
    throw bad_config(where + " f", fmt::format("has {} values", effect.curve->f.size()),
                     fmt::format("one for each of the {} points x", x.size()));
  }
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    if (!(x[i] < x[i + 1])) throw bad_config(where + " x", "does not ascend", "ascending numbers");
  }
}

}  // namespace plant_sim::formula
