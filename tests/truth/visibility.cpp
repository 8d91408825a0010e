#include "tests/truth/visibility.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/truth/case.h"

namespace truth {
namespace {

constexpr int kCoarseSteps = 100;
constexpr double kDrift_per_s = 2.0;
/// Ratio of an effect without which the rod does not stay within its stroke.
constexpr double kLeavesStroke_ratio = 1e6;
constexpr double kNudge = 0.01;  ///< relative change for the sensitivities

using Column = std::vector<double>;

Column without_drift(const Column& of, const Column& from, double sample_s) {
  const double keep = std::exp(-kDrift_per_s * sample_s);
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

/// The rest after the best bounded combination of the columns is taken off `rest`; by turns over
/// the coordinates, which converges as the problem is convex.
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
  const bool coarse = lacking.kind == Kind::actuator && lacking.hidden.coulomb_N <= 0.0;
  const int steps = coarse ? kCoarseSteps : 0;
  const double sample_s = lacking.sample_s;
  const Column base = replay(lacking, record.u_V, steps);
  std::vector<Column> columns;
  Column bounds;
  for (const PlantField& field : plant_fields(lacking.kind)) {
    if (field.reach <= 0.0) continue;
    Case changed = lacking;
    *field.at(changed) *= 1.0 + kNudge;
    columns.push_back(without_drift(replay(changed, record.u_V, steps), base, sample_s));
    bounds.push_back(field.reach / kNudge);
  }
  const Column rest = left_after(without_drift(record.reading_m, base, sample_s), columns, bounds);
  const double left_m = std::sqrt(dot(rest, rest) / static_cast<double>(rest.size()));
  return std::isfinite(left_m) ? std::hypot(1.0, left_m / record.floor_m) : kLeavesStroke_ratio;
}

}  // namespace truth
