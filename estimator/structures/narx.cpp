#include "estimator/structures/narx.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "config/signals/nan.h"
#include "estimator/linear_algebra/decompositions.h"
#include "estimator/nonlinear/minimize.h"

namespace estimator::structures {
namespace {

using config::signals::kNaN;

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStep = 1e-6;
constexpr double kFirstOutput = 1e-3;  // v at the start: the ARX all but alone
constexpr int kRowsPerWeight = 3;

struct NarxSamples {
  MatrixXd phi;  ///< inputs x rows
  VectorXd y;
  std::vector<bool> fitted;  ///< false: for early stopping
};

/// phi of y(t); `y` and `u` anything indexable.
template <class Y, class U>
void fill(const NarxOptions& o, const Y& y, const U& u, int t, VectorXd& phi) {
  for (int i = 0; i < o.n; ++i) phi[i] = y[static_cast<std::size_t>(t - 1 - i)];
  for (int i = 0; i < o.m; ++i) phi[o.n + i] = u[static_cast<std::size_t>(t - o.k - i)];
}

NarxSamples samples_of(const NarxFit& fit, const Stretches& data) {
  const NarxOptions& o = fit.options;
  const int first = fit.history();
  Index rows = 0;
  for (const Stretch& stretch : data) rows += std::max(0, stretch.size() - first);
  NarxSamples out{MatrixXd(o.n + o.m, rows), VectorXd(rows), {}};
  VectorXd phi(o.n + o.m);
  Index row = 0;
  for (const Stretch& stretch : data) {
    const int stop = static_cast<int>(stretch.size() * (1.0 - o.stop_share));
    for (int t = first; t < stretch.size(); ++t, ++row) {
      fill(o, stretch.y_m, stretch.u_V, t, phi);
      out.phi.col(row) = phi;
      out.y[row] = stretch.y_m[static_cast<std::size_t>(t)];
      out.fitted.push_back(t < stop);
    }
  }
  return out;
}

void choose_scales(NarxFit& fit, const NarxSamples& samples) {
  const auto spread = [](const auto& values, double mean) {
    const double sd = std::sqrt((values.array() - mean).square().mean());
    return sd > 0.0 ? sd : 1.0;
  };
  fit.mean = samples.phi.rowwise().mean();
  fit.scale.resize(fit.mean.size());
  for (Index i = 0; i < fit.mean.size(); ++i) {
    fit.scale[i] = spread(samples.phi.row(i), fit.mean[i]);
  }
  fit.y_mean_m = samples.y.mean();
  fit.y_scale_m = spread(samples.y, fit.y_mean_m);
}

/// The network in scaled units.
double output(const NarxOptions& o, const VectorXd& x, const VectorXd& phi) {
  const Index inputs = o.n + o.m;
  double y = x.head(inputs).dot(phi) + x[inputs];
  for (Index j = 0; j < o.hidden; ++j) {
    const Index at = inputs + 1 + j * (inputs + 2);
    y += x[at] * std::tanh(x[at + 1] + x.segment(at + 2, inputs).dot(phi));
  }
  return y;
}

VectorXd random_start(const NarxFit& fit, const VectorXd& arx, std::mt19937_64& random) {
  const Index inputs = arx.size() - 1;
  std::normal_distribution<double> normal;
  VectorXd x(inputs + 1 + fit.options.hidden * (inputs + 2));
  x.head(inputs + 1) = arx;
  for (Index j = 0; j < fit.options.hidden; ++j) {
    const Index at = inputs + 1 + j * (inputs + 2);
    x[at] = kFirstOutput * (j % 2 == 0 ? 1.0 : -1.0);
    for (Index i = 1; i < inputs + 2; ++i) x[at + i] = normal(random);
  }
  return x;
}

double jacobian_condition(MatrixXd jacobian) {
  for (Index j = 0; j < jacobian.cols(); ++j) {
    const double length = jacobian.col(j).norm();
    if (!(length > 0.0)) return std::numeric_limits<double>::infinity();
    jacobian.col(j) /= length;
  }
  const VectorXd s = linear_algebra::singular_values(linear_algebra::upper_triangle(jacobian));
  return s[0] / s[s.size() - 1];
}

nonlinear::Problem problem_of(const NarxFit& fit, const MatrixXd& phi, const VectorXd& y,
                              Index unknowns) {
  nonlinear::Problem out;
  out.residuals = y.size();
  const Index inputs = fit.options.n + fit.options.m;
  for (Index j = 0; j < unknowns; ++j) {
    nonlinear::Unknown unknown;
    unknown.step = kStep;
    unknown.relative_step = kStep;
    if (j > inputs) {
      unknown.prior_mean = 0.0;
      unknown.prior_sd = fit.options.decay_sd;
    }
    out.unknowns.push_back(unknown);
  }
  out.evaluate = [&fit, &phi, &y](const MatrixXd& points, MatrixXd& residuals) {
    const NarxOptions& o = fit.options;
    const Index width = o.n + o.m;
    for (Index c = 0; c < points.cols(); ++c) {
      const VectorXd x = points.col(c);
      VectorXd out_y = phi.transpose() * x.head(width) - y;
      out_y.array() += x[width];
      for (Index j = 0; j < o.hidden; ++j) {
        const Index at = width + 1 + j * (width + 2);
        out_y.array() +=
            x[at] * ((phi.transpose() * x.segment(at + 2, width)).array() + x[at + 1]).tanh();
      }
      residuals.col(c) = out_y;
    }
  };
  return out;
}

}  // namespace

int NarxFit::history() const {
  return std::max(options.n, options.m > 0 ? options.k + options.m - 1 : 0);
}

double NarxFit::predict_m(const VectorXd& phi) const {
  return y_mean_m + y_scale_m * output(options, x, (phi - mean).cwiseQuotient(scale));
}

std::vector<double> NarxFit::linearised() const {
  const Index inputs = options.n + options.m;
  VectorXd slope = x.head(inputs);
  for (Index j = 0; j < options.hidden; ++j) {
    const Index at = inputs + 1 + j * (inputs + 2);
    const double value = std::tanh(x[at + 1]);
    slope += x[at] * (1.0 - value * value) * x.segment(at + 2, inputs);
  }
  slope = y_scale_m * slope.cwiseQuotient(scale);
  slope.head(options.n) *= -1.0;
  return {slope.begin(), slope.end()};
}

std::string NarxFit::text() const {
  return "narx" + std::to_string(options.n) + std::to_string(options.m) +
         std::to_string(options.k) + "/" + std::to_string(options.hidden);
}

NarxFit fit_narx(const NarxOptions& options, const Stretches& data) {
  NarxFit out;
  out.options = options;
  const Index inputs = options.n + options.m;
  const Index unknowns = inputs + 1 + options.hidden * (inputs + 2);
  const NarxSamples samples = samples_of(out, data);
  const Index rows = samples.y.size();
  const auto fitted =
      static_cast<Index>(std::count(samples.fitted.begin(), samples.fitted.end(), true));
  if (fitted < kRowsPerWeight * unknowns) {
    out.why = "too few samples";
    return out;
  }
  choose_scales(out, samples);
  MatrixXd phi(inputs, fitted);
  VectorXd y(fitted);
  MatrixXd stop_phi(inputs, rows - fitted);
  VectorXd stop_y(rows - fitted);
  Index at = 0;
  Index stop_at = 0;
  for (Index t = 0; t < rows; ++t) {
    const VectorXd scaled = (samples.phi.col(t) - out.mean).cwiseQuotient(out.scale);
    const double target = (samples.y[t] - out.y_mean_m) / out.y_scale_m;
    const bool fits = samples.fitted[static_cast<std::size_t>(t)];
    (fits ? phi : stop_phi).col(fits ? at : stop_at) = scaled;
    (fits ? y : stop_y)[fits ? at : stop_at] = target;
    ++(fits ? at : stop_at);
  }
  MatrixXd linear(fitted, inputs + 1);
  linear << phi.transpose(), VectorXd::Ones(fitted);
  const VectorXd arx = linear_algebra::shortest_least_squares(linear, y).x;
  const double noise = (y - linear * arx).norm() / std::sqrt(static_cast<double>(fitted));

  nonlinear::Problem problem = problem_of(out, phi, y, unknowns);
  problem.sigma = noise > 0.0 ? noise : 1.0;
  nonlinear::Problem stopping = problem_of(out, stop_phi, stop_y, unknowns);
  const auto stop_energy = [&](const VectorXd& x) {
    if (stop_y.size() == 0) return 0.0;
    MatrixXd residual(stop_y.size(), 1);
    stopping.evaluate(x, residual);
    return residual.squaredNorm();
  };
  std::mt19937_64 random(options.seed);
  double best = std::numeric_limits<double>::infinity();
  for (int start = 0; start < options.starts; ++start) {
    const VectorXd x = random_start(out, arx, random);
    VectorXd kept = x;
    double least = stop_energy(x);
    nonlinear::MinimizeOptions search;
    search.max_iterations = options.max_iterations;
    search.cost_tolerance = 1e-6;
    search.cancel = options.cancel;
    search.progress = [&](const nonlinear::MinimizeProgress& progress) {
      const double now = stop_energy(*progress.x);
      if (now < least || stop_y.size() == 0) {
        least = now;
        kept = *progress.x;
      }
    };
    const nonlinear::Solution solution = nonlinear::minimize(problem, x, search);
    if (stop_y.size() == 0) {
      kept = solution.x;
      least = solution.cost;
    }
    if (!(least < best)) continue;
    best = least;
    out.x = kept;
    out.condition = jacobian_condition(solution.jacobian);
  }
  if (out.x.size() == 0 || !out.x.allFinite()) {
    out.why = "the search did not stay finite";
    return out;
  }
  MatrixXd residual(fitted, 1);
  problem.evaluate(out.x, residual);
  const double energy = residual.squaredNorm() + stop_energy(out.x);
  out.residual_rms_m = out.y_scale_m * std::sqrt(energy / static_cast<double>(rows));
  out.stop_rms_m =
      out.y_scale_m *
      std::sqrt(stop_energy(out.x) / static_cast<double>(std::max<Index>(1, stop_y.size())));
  out.samples = static_cast<int>(rows);
  out.valid = true;
  return out;
}

std::vector<double> one_step_errors(const NarxFit& model, const Stretch& stretch) {
  std::vector<double> out(static_cast<std::size_t>(stretch.size()), kNaN);
  VectorXd phi(model.options.n + model.options.m);
  for (int t = model.history(); t < stretch.size(); ++t) {
    fill(model.options, stretch.y_m, stretch.u_V, t, phi);
    out[t] = stretch.y_m[static_cast<std::size_t>(t)] - model.predict_m(phi);
  }
  return out;
}

std::vector<double> free_run(const NarxFit& model, const Stretch& stretch, int start) {
  std::vector<double> y(stretch.y_m.begin(), stretch.y_m.end());
  VectorXd phi(model.options.n + model.options.m);
  for (int t = std::max(start, model.history()); t < stretch.size(); ++t) {
    fill(model.options, y, stretch.u_V, t, phi);
    y[t] = model.predict_m(phi);
  }
  return y;
}

}  // namespace estimator::structures
