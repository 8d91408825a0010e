#include "estimator/greybox/selection/change_scores.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "estimator/greybox/held_scale.h"
#include "estimator/greybox/selection/innovation_trials.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Times at which a step is looked for, and what they keep from the record's ends.
constexpr Index kTimes = 400;
constexpr double kFromEnds_s = 1.0;
/// Time constants of warming up, as shares of the record.
constexpr double kShares[] = {0.03, 0.1, 0.3};
constexpr double kFromStart[] = {0.0};
/// Where courses begin within the record, and how long ramps last there, as shares of it.
constexpr double kBegins[] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
constexpr double kLasts[] = {0.1, 0.2, 0.3, 0.4, 0.6, 0.8};
/// Size of an absent effect, in typical sizes, for the difference quotient.
constexpr double kSmall = 0.05;
/// Share of a column that must remain beside the model's own freedom.
constexpr double kVisible = 1e-6;
/// Range of a held gain about the file's value, in logarithms.
constexpr double kHeldRange = 2.3;

/// Sensitivities to parameters, in standard deviations: of the innovations, and beneath them of the
/// distances that the model's own parameters keep from their priors.
struct Columns {
  std::vector<FreeParameter> parameters;
  std::vector<bool> unfitted;     ///< the model has no freedom of this parameter
  std::vector<bool> zero_before;  ///< as in ChangeScore
  MatrixXd values;
  VectorXd rest;  ///< the innovations, and the distances from the priors

  /// True for the size of an effect that the model does not have.
  [[nodiscard]] bool absent(std::size_t i) const {
    return unfitted[i] && parameters[i].name.find('.') != std::string::npos;
  }
};

/// The gain of the drive, where it is held because the forces scale with it: it may fade
/// nevertheless. Areas, which are held for the same reason, do not.
std::optional<FreeParameter> held_gain(const plant_sim::ModelFile& model,
                                       const FitSummary& fitted) {
  std::vector<std::string> names;
  for (const FreeParameter& own : fitted.parameters) names.push_back(own.name);
  const std::string name = held_scale(model, names).parameter;
  if (!name.starts_with("gain_")) return {};
  plant_sim::ModelFile copy = model;
  FreeParameter gain{name, ParameterScale::logarithmic, *copy.value(name), -kHeldRange, kHeldRange};
  gain.prior_sd = std::numeric_limits<double>::infinity();
  return gain;
}

/// Sizes of absent effects, and a held gain, by difference quotients.
void add_unfitted(const InnovationStage& stage, Columns& columns) {
  const SearchContext& context = stage.context;
  const FitSummary& fitted = stage.model.fitted;
  const double floor_m = context.problem.data.noise_floor_m;
  std::vector<FreeParameter> all = fitted.parameters;
  std::vector<FreeParameter> sizes;
  for (const plant_sim::EffectInfo& effect : context.problem.candidate_effects) {
    const std::vector<FreeParameter> own = effect_parameters(effect, 0);
    const bool present = std::any_of(fitted.parameters.begin(), fitted.parameters.end(),
                                     [&](const auto& p) { return effect_of(p) == effect.name; });
    if (own.empty() || own.front().scale != ParameterScale::linear || present) continue;
    sizes.push_back(own.front());
  }
  if (const auto gain = held_gain(context.problem.model, fitted)) sizes.push_back(*gain);
  all.insert(all.end(), sizes.begin(), sizes.end());
  const auto own = static_cast<Index>(fitted.parameters.size());
  const auto count = static_cast<Index>(sizes.size());
  DatasetSimulation run(context.problem.model, context.problem.data, all);
  VectorXd base = VectorXd::Zero(own + count);
  base.head(own) = fitted.theta;
  const Index samples = fitted.residual_m.size();
  columns.values.conservativeResize(Eigen::NoChange, own + count);
  columns.values.rightCols(count).setZero();
  constexpr Index kBatch = ObserverSimulation::kLanes;
  MatrixXd residuals_m;
  for (Index from = 0; from < count && !context.cancelled(); from += kBatch) {
    const Index lanes = std::min(kBatch, count - from);
    MatrixXd points = base.replicate(1, lanes);
    for (Index i = 0; i < lanes; ++i) points(own + from + i, i) = kSmall;
    run.residuals(points, residuals_m);
    for (Index i = 0; i < lanes; ++i) {
      columns.values.col(own + from + i).head(samples) =
          (residuals_m.col(i) - fitted.residual_m) / (kSmall * floor_m);
    }
  }
  const std::vector<std::string>& by_change = context.problem.shown_by_change;
  for (const FreeParameter& size : sizes) {
    columns.parameters.push_back(size);
    columns.unfitted.push_back(true);
    columns.zero_before.push_back(std::find(by_change.begin(), by_change.end(), effect_of(size)) !=
                                  by_change.end());
  }
}

Columns columns_of(const InnovationStage& stage) {
  const FitSummary& fitted = stage.model.fitted;
  const double floor_m = stage.context.problem.data.noise_floor_m;
  const Index samples = fitted.residual_m.size();
  const Index own = fitted.jacobian.cols();
  const std::vector<bool> none(fitted.parameters.size(), false);
  Columns columns{fitted.parameters, none, none, MatrixXd::Zero(samples + own, own),
                  VectorXd::Zero(samples + own)};
  columns.values.topRows(samples) = fitted.jacobian / floor_m;
  columns.rest.head(samples) = fitted.residual_m / floor_m;
  for (Index i = 0; i < own; ++i) {
    const FreeParameter& p = fitted.parameters[static_cast<std::size_t>(i)];
    if (!std::isfinite(p.prior_sd)) continue;
    columns.values(samples + i, i) = 1.0 / p.prior_sd;
    columns.rest[samples + i] = (fitted.theta[i] - p.prior_mean) / p.prior_sd;
  }
  add_unfitted(stage, columns);
  return columns;
}

/// Orthonormal basis of the model's own freedom.
MatrixXd basis_of(const MatrixXd& jacobian) {
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(jacobian);
  const Index rank = qr.rank();
  return MatrixXd(qr.householderQ() * MatrixXd::Identity(jacobian.rows(), rank));
}

/// One parameter's column with the basis that its course has to leave.
class Course {
 public:
  Course(const MatrixXd& basis, const VectorXd& rest, const VectorXd& column, bool unfitted)
      : column_(column), basis_(basis), rest_(rest) {
    if (!unfitted) return;
    // another value throughout is no change: it belongs to the model's freedom here
    VectorXd own = column - basis * (basis.transpose() * column);
    const double norm = own.norm();
    if (!(norm > kVisible * column.norm())) return;
    own /= norm;
    basis_.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis_.rightCols(1) = own;
    const double along = own.dot(rest_);
    throughout_nats_ = 0.5 * along * along;
    rest_ -= own * along;
  }

  [[nodiscard]] double throughout_nats() const { return throughout_nats_; }

  /// `course`: one value a sample.
  void score(const VectorXd& course, ChangeScore& score) const {
    VectorXd x = VectorXd::Zero(column_.size());
    x.head(course.size()) = column_.head(course.size()).cwiseProduct(course);
    take(rest_.dot(x), x.squaredNorm(), basis_.transpose() * x, score);
  }

  /// The likeliest step; `grid`: its possible samples, ascending, of `samples` in all.
  Index score_steps(const std::vector<Index>& grid, Index samples, ChangeScore& best) const {
    double product = 0.0;
    double square = 0.0;
    VectorXd along = VectorXd::Zero(basis_.cols());
    Index end = samples;
    Index chosen = -1;
    for (auto at = grid.rbegin(); at != grid.rend(); ++at) {
      const Index count = end - *at;
      const auto part = column_.segment(*at, count);
      product += rest_.segment(*at, count).dot(part);
      square += part.squaredNorm();
      along += basis_.middleRows(*at, count).transpose() * part;
      end = *at;
      ChangeScore now = best;
      take(product, square, along, now);
      if (now.gain_nats > best.gain_nats) {
        best = now;
        chosen = *at;
      }
    }
    return chosen;
  }

 private:
  static void take(double product, double square, const VectorXd& along, ChangeScore& score) {
    const double left = square - along.squaredNorm();
    if (!(left > kVisible * square) || !(square > 0.0)) return;
    score.gain_nats = 0.5 * product * product / left;
    score.by = -product / left;
  }

  const VectorXd& column_;
  MatrixXd basis_;
  VectorXd rest_;
  double throughout_nats_ = 0.0;
};

void sort_by_gain(std::vector<ChangeScore>& scores) {
  std::stable_sort(scores.begin(), scores.end(), [](const ChangeScore& a, const ChangeScore& b) {
    return a.gain_nats > b.gain_nats;
  });
}

/// A course from 0 to 1.
struct CourseTimes {
  ChangeKind kind;
  double at_s;
  double duration_s;  ///< a ramp's length, an exponential's time constant
};

ChangeScore course_score(const Course& course, const VectorXd& t_s, const CourseTimes& times,
                         ChangeScore score) {
  const auto since = (t_s.array() - times.at_s) / times.duration_s;
  score.kind = times.kind;
  score.at_s = times.at_s;
  score.duration_s = times.duration_s;
  course.score(times.kind == ChangeKind::ramp
                   ? VectorXd(since.cwiseMax(0.0).cwiseMin(1.0).matrix())
                   : VectorXd((-(-since.cwiseMax(0.0)).expm1()).matrix()),
               score);
  return score;
}

/// The likeliest course of a kind that begins and lasts such shares of the record; a ramp ends
/// within it.
ChangeScore best_course(const Course& course, const VectorXd& t_s, ChangeKind kind,
                        std::span<const double> begins, std::span<const double> lasts,
                        const ChangeScore& score) {
  const double begin_s = t_s[0];
  const double length_s = t_s[t_s.size() - 1] - begin_s;
  ChangeScore best = score;
  best.kind = kind;
  for (const double begins_at : begins) {
    for (const double share : lasts) {
      if (kind == ChangeKind::ramp && begins_at + share > 1.0) break;
      const ChangeScore one = course_score(
          course, t_s, {kind, begin_s + begins_at * length_s, share * length_s}, score);
      if (one.gain_nats > best.gain_nats) best = one;
    }
  }
  return best;
}

std::vector<Index> step_times(const Dataset& record) {
  std::vector<Index> grid;
  const auto samples = static_cast<Index>(record.size());
  const auto margin = static_cast<Index>(std::ceil(kFromEnds_s / record.sample_time_s));
  const Index step = std::max<Index>(1, samples / kTimes);
  for (Index k = margin; k < samples - margin; k += step) grid.push_back(k);
  return grid;
}

}  // namespace

std::vector<ChangeScore> change_scores(const InnovationStage& stage) {
  const FitDataset& data = stage.context.problem.data;
  if (data.records.size() != 1 || stage.model.fitted.jacobian.size() == 0) return {};
  const Dataset& record = data.records.front();
  const std::vector<Index> grid = step_times(record);
  if (grid.empty()) return {};
  const Columns columns = columns_of(stage);
  const auto own = static_cast<Index>(stage.model.fitted.parameters.size());
  const MatrixXd basis = basis_of(columns.values.leftCols(own));
  const VectorXd rest = columns.rest - basis * (basis.transpose() * columns.rest);
  const VectorXd t_s =
      Eigen::Map<const VectorXd>(record.t_s.data(), static_cast<Index>(record.size()));
  const double begin_s = record.t_s.front();
  const double length_s = record.t_s.back() - begin_s;
  std::vector<ChangeScore> scores;
  for (Index c = 0; c < columns.values.cols(); ++c) {
    if (stage.context.cancelled()) break;
    const auto i = static_cast<std::size_t>(c);
    if (columns.parameters[i].name.starts_with("change."))
      continue;  // part of a change found before
    const VectorXd column = columns.values.col(c);
    const bool zero_before = columns.zero_before[i];
    const Course course(basis, rest, column, columns.unfitted[i] && !zero_before);
    ChangeScore score{columns.parameters[i], columns.absent(i), zero_before, {}};
    score.throughout_nats = course.throughout_nats();
    ChangeScore step = score;
    const Index at = course.score_steps(grid, t_s.size(), step);
    if (at >= 0) {
      step.at_s = record.t_s[static_cast<std::size_t>(at)];
      scores.push_back(step);
    }
    const ChangeScore throughout =
        course_score(course, t_s, {ChangeKind::ramp, begin_s, length_s}, score);
    scores.push_back(throughout);
    const ChangeScore warming =
        best_course(course, t_s, ChangeKind::exponential, kFromStart, kShares, score);
    scores.push_back(warming);
    // a course that begins later has a parameter more, and has to be worth it
    for (const ChangeScore& plain : {throughout, warming}) {
      const bool is_ramp = plain.kind == ChangeKind::ramp;
      const ChangeScore later = is_ramp
                                    ? best_course(course, t_s, plain.kind, kBegins, kLasts, score)
                                    : best_course(course, t_s, plain.kind, kBegins, kShares, score);
      if (later.gain_nats > plain.gain_nats + kEvidence_nats) scores.push_back(later);
    }
  }
  sort_by_gain(scores);
  return scores;
}

std::vector<ChangeScore> record_scores(const InnovationStage& stage) {
  const FitDataset& data = stage.context.problem.data;
  std::vector<std::string> names;
  for (const Dataset& record : data.records) {
    if (std::find(names.begin(), names.end(), record.name) == names.end())
      names.push_back(record.name);
  }
  if (names.size() < 2 || stage.model.fitted.jacobian.size() == 0) return {};
  const Columns columns = columns_of(stage);
  const auto own = static_cast<Index>(stage.model.fitted.parameters.size());
  const MatrixXd basis = basis_of(columns.values.leftCols(own));
  const VectorXd rest = columns.rest - basis * (basis.transpose() * columns.rest);
  std::vector<ChangeScore> scores;
  for (Index c = 0; c < columns.values.cols() && !stage.context.cancelled(); ++c) {
    const auto i = static_cast<std::size_t>(c);
    if (columns.parameters[i].name.find(kInRecord) != std::string::npos) continue;
    const VectorXd column = columns.values.col(c);
    const Course course(basis, rest, column, columns.unfitted[i]);
    for (const std::string& name : names) {
      VectorXd within = VectorXd::Zero(data.size());
      for (std::size_t r = 0; r < data.records.size(); ++r) {
        if (data.records[r].name != name) continue;
        within
            .segment(static_cast<Index>(data.starts[r]), static_cast<Index>(data.records[r].size()))
            .setOnes();
      }
      ChangeScore score{columns.parameters[i], columns.absent(i), false, {}, ChangeKind::record};
      score.record = name;
      course.score(within, score);
      scores.push_back(std::move(score));
    }
  }
  sort_by_gain(scores);
  return scores;
}

}  // namespace estimator::greybox::selection
