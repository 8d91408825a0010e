#include "estimator/greybox/estimation.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "config/signals/nan.h"
#include "estimator/greybox/fit_errors.h"
#include "estimator/greybox/interval_checks.h"
#include "estimator/greybox/multistart.h"
#include "estimator/greybox/parallel_simulation.h"
#include "estimator/greybox/pressure_scale.h"
#include "estimator/parallel.h"

namespace estimator::greybox {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using estimator::nonlinear::Covariance;
using estimator::nonlinear::Problem;
using estimator::nonlinear::Solution;
using Step = EstimationProgress::Step;

using config::signals::kNaN;
/// A lower cost by this amount restarts the fit from there.
constexpr double kBetter = 0.1;
/// Fits with a cost within this of the best and values within one standard error share a minimum.
constexpr double kSameCost = 0.5;
constexpr double kSamePlace = 1.0;
/// Difference step of the plant's parameters, logarithms: small, for nearly collinear ones.
constexpr double kFine = 2e-5;
constexpr double kCoarse = 3e-5;
constexpr int kDescent = 30;
constexpr double kSameSigma = 1.2;
/// Initial damping: nearly a Gauss-Newton step, which collinear parameters need.
constexpr double kSlight = 1e-7;
constexpr double kPolished = 1e-7;
constexpr int kPolishing = 8;

/// Effects such as dry friction or play make the cost discontinuous.
bool is_smooth(const plant_sim::ModelFile& model) {
  return std::none_of(model.effects.begin(), model.effects.end(),
                      [](const auto& effect) { return effect.present; });
}

class Estimator {
 public:
  Estimator(const EstimationProblem& question, const EstimationOptions& options)
      : question_(question),
        options_(options),
        run_(question.model, question.data, question.parameters, options.observer_per_s,
             wide(options.threads)),
        smooth_(is_smooth(question.model)),
        problem_(problem_of(question.data, question.weights, question.parameters,
                            smooth_ ? kFine : kLogarithmStep)) {
    problem_.evaluate = run_.evaluate();
    problem_.lanes = run_.lanes();
  }

  EstimationSummary run() {
    const auto begin = std::chrono::steady_clock::now();
    report({Step::identifiability, 0, {}});
    derivatives(problem_, question_.start, out_.before.residual_m, start_jacobian_);
    problem_.sigma = question_.data.noise_floor_m > 0.0
                         ? question_.data.noise_floor_m
                         : std::max(rms(out_.before.residual_m, question_.weights), 1e-12);
    out_.identifiability_before =
        identifiability_report(problem_, start_jacobian_, question_.parameters, question_.start);
    if (options_.starts > 1) {
      search();
    } else {
      descend();
    }
    polish(out_.fitted.theta, &out_.fitted);
    if (options_.starts <= 1) found_.assign(1, as_fitted());
    classify_starts();
    compute_uncertainty();
    out_.fit_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    profile();
    out_.noise_floor_m = question_.data.noise_floor_m;
    out_.evaluations += out_.fitted.evaluations;
    out_.fitted.theta = solution_.x;
    out_.fitted.sigma_m = problem_.sigma;
    out_.fitted.residual_m = solution_.residual;
    out_.fitted.jacobian = solution_.jacobian;
    out_.fitted.at_bound = solution_.at_bound;
    out_.fitted.training_rms_m = rms(solution_.residual, question_.weights);
    out_.fitted.validation_rms_m = rms(solution_.residual, question_.data.validation_mask);
    out_.better = with_values(question_.model, out_.fitted);
    out_.after.residual_m = solution_.residual;
    compute_errors(question_, solution_.x, out_.before, out_.after);
    out_.interrupted = cancelled();
    return std::move(out_);
  }

 private:
  bool cancelled() const { return options_.cancel && options_.cancel(); }
  void report(const EstimationProgress& progress) const {
    if (options_.progress) options_.progress(progress);
  }

  void search() {
    const std::vector<VectorXd> points =
        starting_points(question_.parameters, question_.start, std::max(1, options_.starts));
    found_.resize(points.size());
    report({Step::multistart, points.size(), {}});
    in_parallel(points.size(), options_.threads, [&](std::size_t i) {
      if (i > 0 && cancelled()) return;
      FitOptions fit_options;
      fit_options.final_jacobian = false;
      fit_options.tolerance = kCoarse;  // the final fit is tighter
      if (smooth_) fit_options.logarithm_step = kFine;
      fit_options.observer_per_s = options_.observer_per_s;
      fit_options.cancel = options_.cancel;
      if (points.size() == 1) fit_options.width = wide(options_.threads);
      if (i == 0) {
        fit_options.start_residual_m = out_.before.residual_m;
        fit_options.start_jacobian = start_jacobian_;
      }
      found_[i] = fit(question_.model, question_.data, question_.weights, question_.parameters,
                      points[i], fit_options);
    });
    std::size_t best = 0;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      if (found_[i].theta.size() == 0) continue;
      out_.evaluations += found_[i].evaluations;
      if (found_[i].training_rms_m < found_[best].training_rms_m) best = i;
    }
    // Costs include the priors, so the fits are compared with the sigma of the best.
    problem_.sigma = found_[best].sigma_m;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      if (found_[i].theta.size() > 0 && cost(found_[i]) < cost(found_[best])) best = i;
    }
    out_.fitted = found_[best];
    out_.evaluations -= out_.fitted.evaluations;
    problem_.sigma = out_.fitted.sigma_m;
  }

  /// Descent from the single start: after each step the residual is weighted again, until its size
  /// settles.
  void descend() {
    report({Step::descent, 0, {}});
    FitSummary& at = out_.fitted;
    at.parameters = question_.parameters;
    at.theta = question_.start;
    at.residual_m = out_.before.residual_m;
    at.jacobian = start_jacobian_;
    const auto weighed = [&] {
      return std::max(
                 {question_.data.noise_floor_m, rms(at.residual_m, question_.weights), 1e-12}) *
             std::sqrt(correlation_factor(at.residual_m, question_.weights));
    };
    at.sigma_m = weighed();
    for (int k = 0; k < kDescent && !cancelled(); ++k) {
      problem_.sigma = at.sigma_m;
      estimator::nonlinear::MinimizeOptions how;
      how.max_iterations = 1;
      if (smooth_) how.first_damping = kSlight;
      how.final_jacobian = false;
      how.start_residual = at.residual_m;
      how.start_jacobian = at.jacobian;
      solution_ = minimize(problem_, at.theta, how);
      out_.evaluations += solution_.evaluations;
      at.theta = solution_.x;
      at.residual_m = solution_.residual;
      at.jacobian = solution_.jacobian;
      at.sigma_m = weighed();
      if (at.sigma_m * kSameSigma > problem_.sigma) break;
    }
    problem_.sigma = at.sigma_m;
  }

  FitSummary as_fitted() const {
    FitSummary fitted = out_.fitted;
    fitted.theta = solution_.x;
    fitted.residual_m = solution_.residual;
    return fitted;
  }

  double cost(const FitSummary& fitted) const {
    return estimator::nonlinear::cost_of(problem_, fitted.theta, fitted.residual_m);
  }

  /// `known`: residual and Jacobian at `from`, or null.
  void polish(const VectorXd& from, const FitSummary* known) {
    estimator::nonlinear::MinimizeOptions how;
    how.cost_tolerance = kPolished;
    if (smooth_) how.first_damping = kSlight;
    how.max_iterations = kPolishing;
    how.cancel = options_.cancel;
    how.central = !smooth_;
    if (smooth_ && known != nullptr && known->jacobian.size() > 0) {
      how.start_residual = known->residual_m;
      how.start_jacobian = known->jacobian;
    }
    solution_ = minimize(problem_, from, how);
    out_.evaluations += solution_.evaluations;
    if (solution_.reason == estimator::nonlinear::StopReason::cancelled) {
      derivatives(problem_, solution_.x, solution_.residual, solution_.jacobian);
      solution_.cost = cost_of(problem_, solution_.x, solution_.residual);
    }
    FitSummary polished = as_fitted();
    polished.at_bound = solution_.at_bound;
    polished.jacobian = std::move(solution_.jacobian);
    clear_pressure_scale(question_.model, polished);
    solution_.jacobian = std::move(polished.jacobian);
  }

  void classify_starts() {
    const VectorXd std_error = covariance(problem_, solution_).std_error;
    for (const FitSummary& fitted : found_) {
      if (fitted.theta.size() == 0) continue;
      ++out_.starts.tried;
      bool near = true;
      for (Index j = 0; j < fitted.theta.size(); ++j) {
        if (std::isfinite(std_error[j])) {
          near = near && std::abs(fitted.theta[j] - solution_.x[j]) < kSamePlace * std_error[j];
        }
      }
      const bool good = cost(fitted) - solution_.cost < kSameCost;
      ++(good ? (near ? out_.starts.same : out_.starts.elsewhere) : out_.starts.worse);
    }
  }

  void compute_uncertainty() {
    known_ = covariance(problem_, solution_);
    out_.effective_samples = known_.effective_samples;
    out_.identifiability_after =
        identifiability_report(problem_, solution_.jacobian, question_.parameters, solution_.x);
    const auto n = static_cast<Index>(question_.parameters.size());
    out_.parameters.clear();
    out_.correlation.setConstant(n, n, kNaN);
    for (Index j = 0; j < n; ++j) {
      const auto i = static_cast<std::size_t>(j);
      const FreeParameter& p = question_.parameters[i];
      EstimatedParameter q;
      q.free = p;
      q.start = p.to_physical(question_.start[j]);
      q.value = p.to_physical(solution_.x[j]);
      q.std_error = known_.std_error[j] * p.slope(solution_.x[j]);
      q.low = std::min(p.to_physical(known_.low[j]), p.to_physical(known_.high[j]));
      q.high = std::max(p.to_physical(known_.low[j]), p.to_physical(known_.high[j]));
      q.at_bound = solution_.at_bound[i] * (p.scale == ParameterScale::reciprocal ? -1 : 1);
      q.record_share = out_.identifiability_after.share[j];
      out_.parameters.push_back(q);
      for (Index k = 0; k < n; ++k) {
        const double both = known_.matrix(j, j) * known_.matrix(k, k);
        if (both > 0.0) out_.correlation(j, k) = known_.matrix(j, k) / std::sqrt(both);
      }
    }
  }

  void profile() {
    if (options_.profiling == Profiling::none || cancelled()) return;
    std::vector<IntervalDoubt> why;
    std::vector<estimator::nonlinear::Profile> walked;
    for (int again = 0; again < 2; ++again) {
      why = doubts(problem_, solution_, known_, question_.parameters,
                   out_.identifiability_after.share);
      walked = profiles(question_, options_, problem_, solution_, known_, chosen(why));
      const auto least =
          std::min_element(walked.begin(), walked.end(), [](const auto& a, const auto& b) {
            return (a.least_x.size() > 0 ? a.least_cost : 1e300) <
                   (b.least_x.size() > 0 ? b.least_cost : 1e300);
          });
      if (again > 0 || least->least_x.size() == 0 || cancelled() ||
          least->least_cost > solution_.cost - kBetter) {
        break;
      }
      report({Step::restart, 0, {}});
      polish(least->least_x, nullptr);
      compute_uncertainty();
    }
    for (std::size_t i = 0; i < walked.size(); ++i) {
      out_.parameters[i].doubt = why[i];
      if (walked[i].points.size() > 1) apply_profile(walked[i], out_.parameters[i]);
    }
  }

  std::vector<char> chosen(const std::vector<IntervalDoubt>& why) const {
    std::vector<char> which(why.size(), 0);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < why.size(); ++i) {
      const std::string& name = question_.parameters[i].name;
      const bool named = std::find(options_.profiled.begin(), options_.profiled.end(), name) !=
                         options_.profiled.end();
      which[i] = options_.profiling == Profiling::named ? named : why[i] != IntervalDoubt::none;
      if (which[i] != 0) names.push_back(name);
    }
    if (!names.empty()) report({Step::profile, 0, names});
    return which;
  }

  const EstimationProblem& question_;
  const EstimationOptions& options_;
  ParallelSimulation run_;
  bool smooth_;
  Problem problem_;
  EstimationSummary out_;
  Eigen::MatrixXd start_jacobian_;
  std::vector<FitSummary> found_;
  Solution solution_;
  Covariance known_;
};

}  // namespace

EstimationSummary estimate(const EstimationProblem& problem, const EstimationOptions& options) {
  return Estimator(problem, options).run();
}

}  // namespace estimator::greybox
