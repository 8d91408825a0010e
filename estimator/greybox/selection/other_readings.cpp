#include "estimator/greybox/selection/other_readings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "estimator/greybox/motion_scale.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/problem.h"

namespace estimator::greybox::selection {
namespace {

/// Least ratio of the errors that two readings leave.
constexpr double kMuchMore = 3.0;
constexpr double kThousand = 1000.0;

/// Standard deviation of all positions about each record's mean.
double motion_m(const FitDataset& data) {
  double squares = 0.0;
  double samples = 0.0;
  for (const Dataset& record : data.records) {
    double mean_m = 0.0;
    for (const double y_m : record.y_m) mean_m += y_m / static_cast<double>(record.size());
    for (const double y_m : record.y_m) squares += (y_m - mean_m) * (y_m - mean_m);
    samples += static_cast<double>(record.size());
  }
  return std::sqrt(squares / samples);
}

/// Error of the first round of a search, of the motion that there is to be explained; infinite
/// where the simulation diverges.
double left_ratio(const SearchContext& context, const SearchStart& start) {
  const double ratio = start.branch.stage.fitted.validation_rms_m / motion_m(context.problem.data);
  return std::isfinite(ratio) ? ratio : std::numeric_limits<double>::infinity();
}

/// The same of the records read otherwise, split into blocks.
template <class Reading>
double left_by(const SearchContext& context, const Reading& read) {
  SearchContext other = without_holdouts(context);
  std::vector<Dataset> records = std::move(other.problem.data.records);
  for (Dataset& record : records) read(record);
  other.problem.data = fit_dataset(std::move(records), {});
  assume_noise_floor(other.problem.data);
  return left_ratio(other, start_search(other));
}

}  // namespace

void try_other_readings(const SearchContext& context, const SearchStart& start,
                        RecordChecks& checks) {
  if (checks.misread() || is_explained(context, start.branch.stage)) return;
  const bool has_stroke = checks.stroke_m > 0.0;  // which tells by itself
  const double left = left_ratio(context, start);
  if (!std::isfinite(left)) return;
  // held-out records may move less than those that `read` is tried on
  const auto leaves_much_less = [&](double other) {
    return !context.cancelled() && kMuchMore * other < left &&
           kMuchMore * other < left_by(
                                   context, [](Dataset&) {});
  };
  if (!has_stroke && !context.problem.model.rotary() && checks.high_m - checks.low_m > kLongest_m) {
    const double scaled = left_by(context, [](Dataset& record) {
      for (double& y_m : record.y_m) y_m /= kThousand;
    });
    checks.wrong_scale = leaves_much_less(scaled);
  }
  if (checks.driven() || checks.wrong_scale) return;
  const double turned = left_by(context, [](Dataset& record) {
    for (double& u_V : record.u_V) u_V = -u_V;
  });
  const double exchanged =
      has_stroke ? left
                 : left_by(context, [](Dataset& record) { std::swap(record.u_V, record.y_m); });
  if (!leaves_much_less(std::min(turned, exchanged))) return;
  if (turned <= exchanged) {
    checks.turned_sign_ratio = left / turned;
  } else {
    checks.columns_exchanged = true;
    checks.exchanged_ratio = left / exchanged;
  }
}

std::optional<RecordChecks> checks_of_reading(const SearchContext& context,
                                              const SearchStart& start) {
  if (context.cancelled()) return {};
  RecordChecks checks = check_records(context, start.first.fitted.validation_rms_m);
  try_other_readings(context, start, checks);
  const bool is_read_rightly = is_explained(context, start.branch.stage);
  if (checks.misread() && (is_read_rightly || context.cancelled())) return {};
  return checks;
}

}  // namespace estimator::greybox::selection
