#include "tests/truth/visibility.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "tests/truth/case.h"

namespace truth {
namespace {

constexpr int kCoarseSteps = 100;
constexpr double kDrift_per_s = 2.0;
constexpr double kNudge = 0.01;  ///< relative change for the sensitivities

using Column = std::vector<double>;

Column without_drift(const Column& of, const Column& from) {
  const double keep = std::exp(-kDrift_per_s * kSample_s);
  Column passed(of.size());
  double held = 0.0;
  double before = 0.0;
  for (std::size_t k = 0; k < of.size(); ++k) {
    const double now = of[k] - from[k];
    held = keep * (held + now - before);
    before = now;
    passed[k] = held;
  }
  return passed;
}

double dot(const Column& a, const Column& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

/// How far the plant's own parameters may go, relative. Of gain and supply pressure only
/// gain * sqrt(Ps) is seen, so the gain stands for both.
const std::map<std::string, double>& reach() {
  static const std::map<std::string, double> of{
      {"valve_gain_m_per_V", 0.2},  {"damping_N_s_per_m", 0.6},
      {"bulk_modulus_Pa", 0.4},     {"valve_natural_frequency_rad_per_s", 0.2},
      {"valve_damping_ratio", 0.2}, {"mass_kg", 0.2},
      {"dead_volume_m3", 0.4},
  };
  return of;
}

/// What is left of `rest` after the best bounded combination of the columns; by turns over the
/// coordinates, which converges as the problem is convex.
Column left_after(Column rest, const std::vector<Column>& columns, const Column& bounds) {
  const std::size_t count = columns.size();
  std::vector<Column> gram(count, Column(count));
  Column toward(count);
  for (std::size_t i = 0; i < count; ++i) {
    toward[i] = dot(columns[i], rest);
    for (std::size_t j = 0; j < count; ++j) gram[i][j] = dot(columns[i], columns[j]);
  }
  Column share(count, 0.0);
  constexpr int kTurns = 20000;
  for (int turn = 0; turn < kTurns; ++turn) {
    for (std::size_t i = 0; i < count; ++i) {
      if (gram[i][i] <= 0.0) continue;
      double slope = toward[i];
      for (std::size_t j = 0; j < count; ++j) slope -= gram[i][j] * share[j];
      share[i] = std::clamp(share[i] + slope / gram[i][i], -bounds[i], bounds[i]);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < rest.size(); ++k) rest[k] -= share[i] * columns[i][k];
  }
  return rest;
}

}  // namespace

double visibility_ratio(const Case& lacking, const Record& record) {
  const int steps = lacking.hidden.coulomb_N > 0.0 ? 400 : kCoarseSteps;
  const Column base = replay(lacking, record.u_V, steps);
  std::vector<Column> columns;
  Column bounds;
  for (const PlantField& field : plant_fields()) {
    const auto found = reach().find(field.name);
    if (found == reach().end()) continue;
    Case changed = lacking;
    changed.plant.*field.member *= 1.0 + kNudge;
    columns.push_back(without_drift(replay(changed, record.u_V, steps), base));
    bounds.push_back(found->second / kNudge);
  }
  const Column rest = left_after(without_drift(record.reading_m, base), columns, bounds);
  const double left_m = std::sqrt(dot(rest, rest) / static_cast<double>(rest.size()));
  return std::hypot(1.0, left_m / record.floor_m);
}

}  // namespace truth
