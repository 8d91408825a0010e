#include "estimator/recursive.h"

#include <cmath>
#include <string>

#include "config/schema/error.h"
#include "estimator/regressor.h"
#include "estimator/solve.h"
#include "estimator/ud_filter.h"

namespace estimator {
namespace {

/// Open while u and y moved within the last one to two windows of samples.
class Gate {
 public:
  explicit Gate(int window) noexcept : window_(window) {}

  void add(double u_V, double y_m) noexcept {
    if (count_ == window_) {
      before_ = now_;
      now_ = {};
      count_ = 0;
    }
    now_.add(u_V, y_m);
    ++count_;
  }
  [[nodiscard]] bool open(const Limits& limits) const noexcept {
    ExcitationRange both = now_;
    both.add(before_);
    return both.excited(limits);
  }

 private:
  int window_;
  int count_ = 0;
  ExcitationRange now_;
  ExcitationRange before_;
};

void refuse_unless(bool good, const std::string& what) {
  if (!good) throw config::schema::UsageError(what);
}

}  // namespace

struct Recursive::State {
  explicit State(const RecursiveConfig& c)
      : config(c),
        size(c.structure.size()),
        update(ud_update(size)),
        regressor(c.structure),
        gate(c.gate_window) {
    reset();
  }

  void reset() noexcept {
    regressor.reset();
    gate = Gate(config.gate_window);
    warming = config.warmup;
    batch().clear();
    p = {};
    theta.fill(0.0);
    for (int i = 0; i < size; ++i) p.d[i] = config.prior_variance;
    next_informed = 0;
    error_m = kNaN;
    cost_m2 = weights = weights_squared = 0.0;
    prior_weight = 1.0 / config.prior_variance;
  }

  SquareRootInformation batch() noexcept { return {size + 1, batch_memory.values.data()}; }

  bool take_row() noexcept {
    if (warming > 0) {
      batch().absorb(regressor.row());
      if (--warming == 0) start_from_batch();
      return warming == 0;
    }
    double prediction_m = 0.0;
    for (int i = 0; i < size; ++i) prediction_m += regressor.row()[i] * theta[i];
    const double error = regressor.target_m() - prediction_m;
    const double lambda = config.forgetting;
    if (!std::isfinite(error * error)) return false;
    alignas(16) double gain[padded(kMaxCoefficients)];
    const double alpha = update.measure(p, regressor.row(), lambda, lambda, gain);
    if (!std::isfinite(alpha)) return false;
    const double per_alpha = error / alpha;
    for (int i = 0; i < size; ++i) theta[i] += gain[i] * per_alpha;
    error_m = error;
    cost_m2 = lambda * (cost_m2 + error * per_alpha);
    prior_weight *= lambda;
    weights = lambda * weights + 1.0;
    weights_squared = lambda * lambda * weights_squared + 1.0;
    if (lambda < 1.0) {
      update.add_information(p, next_informed, (1.0 - lambda) * size / config.prior_variance);
      next_informed = next_informed + 1 == size ? 0 : next_informed + 1;
    }
    return true;
  }

  /// theta = R^-1 z and P = R^-1 R^-T; directions the batch left open get the prior.
  void start_from_batch() noexcept {
    const auto factor = triangle(batch());
    const Small r = factor.topLeftCorner(size, size);
    prior_weight = 0.0;
    if (!(scaled_condition(r) <= config.limits.max_condition)) {
      prior_weight = 1.0 / config.prior_variance;
      for (int i = 0; i < size; ++i) {
        double prior[kMaxColumns] = {};
        prior[i] = 1.0 / std::sqrt(config.prior_variance);
        batch().absorb(prior);
      }
    }
    const auto whole = triangle(batch());
    batch().solve(theta.data());
    const Small root = inverse(whole.topLeftCorner(size, size));
    for (int j = 0; j < size; ++j) {
      p.d[j] = root(j, j) * root(j, j);
      for (int i = 0; i < j; ++i) p.unit[padded(size) * j + i] = root(i, j) / root(j, j);
    }
    cost_m2 = whole(size, size) * whole(size, size);
    weights = weights_squared = config.warmup;
  }

  /// Sum of w e^2 of the current coefficients.
  double residual_m2() const noexcept {
    double square = 0.0;
    for (int i = 0; i < size; ++i) square += theta[i] * theta[i];
    const double out = cost_m2 - prior_weight * square;
    return out > 0.0 ? out : 0.0;
  }

  /// U D^(1/2), so that P is its square.
  Small root() const noexcept {
    Small out = Small::Zero(size, size);
    for (int j = 0; j < size; ++j) {
      out(j, j) = std::sqrt(p.d[j]);
      for (int i = 0; i < j; ++i) out(i, j) = p.unit[padded(size) * j + i] * out(j, j);
    }
    return out;
  }

  RecursiveConfig config;
  int size;
  const UdUpdate& update;
  Regressor regressor;
  Gate gate;
  UdFactor p{};
  SquareRootInformationMemory batch_memory{};
  std::array<double, kMaxCoefficients> theta{};
  int warming = 0;
  int next_informed = 0;
  double error_m = kNaN;
  double cost_m2 = 0.0;          // sum of w e^2 of the current coefficients + prior's share
  double prior_weight = 0.0;     // that share per theta' theta
  double weights = 0.0;          // sum of w
  double weights_squared = 0.0;  // sum of w^2
};

Recursive::Recursive(const RecursiveConfig& config) {
  refuse_unless(
      config.forgetting > 0.0 && config.forgetting <= 1.0,
      "recursive: forgetting " + std::to_string(config.forgetting) + "; allowed: above 0, to 1");
  refuse_unless(std::isfinite(config.prior_variance) && config.prior_variance > 0.0,
                "recursive: prior_variance " + std::to_string(config.prior_variance) +
                    "; allowed: above 0, finite");
  refuse_unless(config.warmup == 0 || config.warmup > config.structure.size(),
                "recursive: warmup " + std::to_string(config.warmup) +
                    " rows; allowed: 0 or more than " + std::to_string(config.structure.size()));
  refuse_unless(config.gate_window >= 1, "recursive: gate_window " +
                                             std::to_string(config.gate_window) +
                                             " samples; allowed: at least 1");
  state_ = std::make_unique<State>(config);
}
Recursive::~Recursive() = default;
Recursive::Recursive(Recursive&&) noexcept = default;
Recursive& Recursive::operator=(Recursive&&) noexcept = default;

bool Recursive::push(double u_V, double y_m) noexcept {
  State& s = *state_;
  const bool ready = s.regressor.push(u_V, y_m);
  if (std::isfinite(u_V) && std::isfinite(y_m)) s.gate.add(u_V, y_m);
  return ready && s.gate.open(s.config.limits) && s.take_row();
}

void Recursive::gap() noexcept { state_->regressor.reset(); }

void Recursive::reset() noexcept { state_->reset(); }

void Recursive::serialize(StateArchive& archive) {
  State& s = *state_;
  archive.value(s.regressor);
  archive.value(s.gate);
  archive.value(s.p);
  archive.value(s.batch_memory);
  archive.value(s.theta);
  archive.value(s.warming);
  archive.value(s.next_informed);
  for (double* number : {&s.error_m, &s.cost_m2, &s.prior_weight, &s.weights, &s.weights_squared}) {
    archive.value(*number);
  }
  if (s.next_informed < 0 || s.next_informed >= s.size) {
    archive.fail();
    reset();
  }
}

const double* Recursive::coefficients() const noexcept { return state_->theta.data(); }

Estimate Recursive::estimate() const noexcept {
  const State& s = *state_;
  Estimate out;
  out.size = s.size;
  out.value.fill(kNaN);
  out.std_error.fill(kNaN);
  out.samples = static_cast<int>(std::lround(s.weights));
  const auto refuse = [&out](Reason reason) {
    out.valid = false;
    out.reason = reason;
    return out;
  };
  if (s.warming > 0 || s.weights == 0.0) {
    return refuse(s.gate.open(s.config.limits) ? Reason::too_short : Reason::not_excited);
  }
  std::copy_n(s.theta.begin(), s.size, out.value.begin());
  const double residual_m2 = s.residual_m2();
  out.residual_rms_m = std::sqrt(residual_m2 / s.weights);
  const Small root = s.root();
  if (!root.allFinite() || !(root.diagonal().minCoeff() > 0.0)) return refuse(Reason::not_finite);
  out.condition = scaled_condition(inverse(root));
  // Weights lambda^i count twice in the noise and once in the information.
  const double repeat = s.weights_squared / s.weights;
  const double freedom = s.weights - s.size * repeat;
  if (!(freedom > 0.0)) return refuse(Reason::too_short);
  const double deviation_m = std::sqrt(residual_m2 / freedom * repeat);
  for (int i = 0; i < s.size; ++i) {
    out.std_error[i] = deviation_m * root.row(i).tail(s.size - i).norm();
  }
  if (!s.gate.open(s.config.limits)) return refuse(Reason::not_excited);
  if (!(out.condition <= s.config.limits.max_condition)) return refuse(Reason::rank_deficient);
  out.valid = true;
  out.reason = Reason::none;
  return out;
}

}  // namespace estimator
