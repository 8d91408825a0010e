#include "estimator/structures/recursive_prediction_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "config/schema/error.h"
#include "config/signals/nan.h"
#include "estimator/structure.h"
#include "estimator/ud_filter.h"

namespace estimator::structures {
namespace {

using config::signals::kNaN;

constexpr int kLength = 64;  // capacity for delay and order
static_assert(kLength > kMaxDelay + kMaxOrder);
constexpr double kFirstForgetting = 0.95;
constexpr double kForgettingRate = 0.99;
constexpr int kHold = 20;  // updates for each coefficient, before the noise model moves
constexpr int kHalvings = 12;
constexpr double kMostRoot = 0.999;
constexpr double kVarianceMemory = 0.999;

/// The last kLength values; [0] is the newest.
struct LagBuffer {
  std::array<double, kLength> ring{};
  int newest = 0;

  void push(double x) noexcept {
    newest = (newest + kLength - 1) % kLength;
    ring[newest] = x;
  }
  [[nodiscard]] double operator[](int ago) const noexcept { return ring[(newest + ago) % kLength]; }
};

/// All roots within kMostRoot: Schur-Cohn recursion on the scaled polynomial.
bool stable(const double* p, int n) noexcept {
  std::array<double, kMaxOrder + 1> now{};
  now[0] = 1.0;
  double scale = 1.0;
  for (int i = 1; i <= n; ++i) {
    scale /= kMostRoot;
    now[i] = p[i - 1] * scale;
  }
  for (int order = n; order > 0; --order) {
    const double reflection = now[order];
    if (!(std::abs(reflection) < 1.0)) return false;
    const std::array<double, kMaxOrder + 1> old = now;
    const double divisor = 1.0 - reflection * reflection;
    for (int i = 0; i < order; ++i) now[i] = (old[i] - reflection * old[order - i]) / divisor;
  }
  return true;
}

}  // namespace

struct RecursivePredictionError::State {
  /// Everything that changes: plain values, carried as they are.
  struct Moving {
    LagBuffer y, u, w, v, e;  // named as in the equations
    LagBuffer y_dc, u_f, u_dc, w_f, w_dc, e_c, v_c, one_f, one_dc;
    std::array<double, kMaxCoefficients> theta{};
    UdFactor p{};
    double variance_m2 = 0.0;
    double weight = 0.0;
    double error_m = kNaN;
    double deficit = 1.0 - kFirstForgetting;
    int filled = 0;
    int updates = 0;
  };
  static_assert(std::is_trivially_copyable_v<Moving>);

  explicit State(const RecursiveOptions& from) : o(from), update(&ud_update(from.orders.size())) {
    start();
  }

  void start() noexcept {
    now = Moving{};
    for (int i = 0; i < o.orders.size(); ++i) now.p.d[i] = o.prior_variance;
    now.deficit = std::max(0.0, o.forgetting - kFirstForgetting);
  }
  [[nodiscard]] const double* a() const noexcept { return now.theta.data(); }
  [[nodiscard]] const double* b() const noexcept { return a() + o.orders.a; }
  [[nodiscard]] const double* c() const noexcept { return b() + o.orders.b; }
  [[nodiscard]] const double* d() const noexcept { return c() + o.orders.c; }
  [[nodiscard]] const double* f() const noexcept { return d() + o.orders.d; }
  [[nodiscard]] double constant() const noexcept {
    return o.orders.constant ? f()[o.orders.f] : 0.0;
  }

  static double past(const double* p, int n, const LagBuffer& x) noexcept {
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += p[i] * x[i];  // before the push: x[0] is t-1
    return sum;
  }
  /// Pushes (D/C) x; `x` holds the past, `value` is the new one.
  void through_noise(LagBuffer& out, const LagBuffer& x, double value) noexcept {
    out.push(value + past(d(), o.orders.d, x) - past(c(), o.orders.c, out));
  }
  /// psi(t) from data before y(t).
  void gradient(double* psi) const noexcept {
    const Orders& n = o.orders;
    const bool plain = o.extended;
    for (int i = 0; i < n.a; ++i) *psi++ = -(plain ? now.y : now.y_dc)[i];
    for (int i = 0; i < n.b; ++i) *psi++ = (plain ? now.u : now.u_dc)[n.k + i];
    const bool hold = n.f == 0 && now.updates < kHold * n.size();
    for (int i = 0; i < n.c; ++i) *psi++ = hold ? 0.0 : (plain ? now.e : now.e_c)[i];
    for (int i = 0; i < n.d; ++i) *psi++ = hold ? 0.0 : -(plain ? now.v : now.v_c)[i];
    for (int i = 0; i < n.f; ++i) *psi++ = -(plain ? now.w : now.w_dc)[i];
    if (n.constant) *psi++ = plain ? 1.0 : now.one_dc[0];
  }
  void take_step(const double* gain, double step) noexcept {
    const Orders& n = o.orders;
    const std::array<double, kMaxCoefficients> old = now.theta;
    for (int halving = 0; halving < kHalvings; ++halving, step *= 0.5) {
      for (int i = 0; i < n.size(); ++i) now.theta[i] = old[i] + step * gain[i];
      if (stable(c(), n.c) && stable(f(), n.f)) return;
    }
    now.theta = old;
  }

  RecursiveOptions o;
  const UdUpdate* update;
  Moving now;
};

RecursivePredictionError::RecursivePredictionError(const RecursiveOptions& options) {
  const auto refuse = [](const char* line) { throw config::schema::UsageError(line); };
  const int size = options.orders.size();
  if (size < 1 || size > kMaxCoefficients) refuse("recursive: 1 to 21 coefficients");
  if (!(options.forgetting > 0.0) || options.forgetting > 1.0) {
    refuse("recursive: forgetting above 0 up to 1");
  }
  if (!(options.prior_variance > 0.0)) refuse("recursive: prior variance above 0");
  if (options.extended && (options.orders.d > 0 || options.orders.f > 0)) {
    refuse("recursive: extended least squares is for ARX and ARMAX");
  }
  state_ = std::make_unique<State>(options);
}
RecursivePredictionError::~RecursivePredictionError() = default;
RecursivePredictionError::RecursivePredictionError(RecursivePredictionError&&) noexcept = default;
RecursivePredictionError& RecursivePredictionError::operator=(RecursivePredictionError&&) noexcept =
    default;

bool RecursivePredictionError::push(double u_V, double y_m) noexcept {
  State& s = *state_;
  State::Moving& now = s.now;
  const Orders& n = s.o.orders;
  if (!std::isfinite(u_V) || !std::isfinite(y_m)) {
    gap();
    return false;
  }
  const bool ready = now.filled >= n.history();
  // u(t) first: with a delay of 0 it acts on y(t).
  now.u.push(u_V);
  const double u_f = u_V - State::past(s.f(), n.f, now.u_f);
  s.through_noise(now.u_dc, now.u_f, u_f);
  now.u_f.push(u_f);
  const double one_f = 1.0 - State::past(s.f(), n.f, now.one_f);
  s.through_noise(now.one_dc, now.one_f, one_f);
  now.one_f.push(one_f);

  bool changed = false;
  double w = s.constant() - State::past(s.f(), n.f, now.w);
  for (int i = 0; i < n.b; ++i) w += s.b()[i] * now.u[n.k + i];
  double v = y_m + State::past(s.a(), n.a, now.y) - w;
  double e = v + State::past(s.d(), n.d, now.v) - State::past(s.c(), n.c, now.e);
  if (!ready) {
    if (n.f > 0) w = y_m + State::past(s.a(), n.a, now.y);  // the first values are unknown
    v = e = 0.0;
    ++now.filled;
  } else {
    now.error_m = e;
    alignas(16) std::array<double, padded(kMaxCoefficients)> psi{};
    alignas(16) std::array<double, padded(kMaxCoefficients)> gain{};
    s.gradient(psi.data());
    const double lambda = s.o.forgetting - now.deficit;
    now.deficit *= kForgettingRate;
    const double alpha = s.update->measure(now.p, psi.data(), lambda, lambda, gain.data());
    if (std::isfinite(alpha) && std::isfinite(e)) {
      s.take_step(gain.data(), e / alpha);
      ++now.updates;
      changed = true;
      // The error after the update drives the filters: it converges faster.
      w = s.constant() - State::past(s.f(), n.f, now.w);
      for (int i = 0; i < n.b; ++i) w += s.b()[i] * now.u[n.k + i];
      v = y_m + State::past(s.a(), n.a, now.y) - w;
      const double after = v + State::past(s.d(), n.d, now.v) - State::past(s.c(), n.c, now.e);
      now.variance_m2 = kVarianceMemory * now.variance_m2 + e * after;
      now.weight = kVarianceMemory * now.weight + 1.0;
      e = after;
    }
  }
  s.through_noise(now.y_dc, now.y, y_m);
  const double w_f = w - State::past(s.f(), n.f, now.w_f);
  s.through_noise(now.w_dc, now.w_f, w_f);
  now.w_f.push(w_f);
  now.e_c.push(e - State::past(s.c(), n.c, now.e_c));
  now.v_c.push(v - State::past(s.c(), n.c, now.v_c));
  now.y.push(y_m);
  now.w.push(w);
  now.v.push(v);
  now.e.push(e);
  return changed;
}

void RecursivePredictionError::gap() noexcept {
  State::Moving& now = state_->now;
  for (LagBuffer* series : {&now.y, &now.u, &now.w, &now.v, &now.e, &now.y_dc, &now.u_f, &now.u_dc,
                            &now.w_f, &now.w_dc, &now.e_c, &now.v_c, &now.one_f, &now.one_dc}) {
    *series = LagBuffer{};
  }
  now.filled = 0;
}

void RecursivePredictionError::reset() noexcept { state_->start(); }

void RecursivePredictionError::serialize(StateArchive& archive) { archive.value(state_->now); }

const double* RecursivePredictionError::value() const noexcept { return state_->now.theta.data(); }

void RecursivePredictionError::std_error(double* out) const noexcept {
  const State::Moving& now = state_->now;
  const int size = state_->o.orders.size();
  const double variance = now.weight > 0.0 ? std::max(0.0, now.variance_m2 / now.weight) : 0.0;
  for (int i = 0; i < size; ++i) {
    double sum = now.p.d[i];
    for (int j = i + 1; j < size; ++j) {
      const double unit = now.p.unit[padded(size) * j + i];
      sum += unit * unit * now.p.d[j];
    }
    out[i] = std::sqrt(variance * sum);
  }
}

double RecursivePredictionError::prediction_error_m() const noexcept { return state_->now.error_m; }

int RecursivePredictionError::updates() const noexcept { return state_->now.updates; }

}  // namespace estimator::structures
