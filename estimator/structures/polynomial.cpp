#include "estimator/structures/polynomial.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "config/schema/error.h"
#include "config/signals/nan.h"
#include "estimator/linear_algebra/decompositions.h"
#include "estimator/structure.h"

namespace estimator::structures {
namespace {

using config::signals::kNaN;

/// (1 + p1 q^-1 + ...) x at t, x = 0 before `first`.
double apply(const std::vector<double>& p, const std::vector<double>& x, int t, int first) {
  double sum = x[static_cast<std::size_t>(t)];
  const int most = std::min(static_cast<int>(p.size()), t - first);
  for (int i = 1; i <= most; ++i) sum += p[i - 1] * x[t - i];
  return sum;
}

/// x(t) <- x(t) - p1 x(t-1) - ..., the filter 1 / P in place from `from` on, x before taken as is.
void divide(const std::vector<double>& p, std::vector<double>& x, int from, int first) {
  const int n = static_cast<int>(p.size());
  for (int t = from; t < static_cast<int>(x.size()); ++t) {
    double value = x[t];
    const int most = std::min(n, t - first);
    for (int i = 1; i <= most; ++i) value -= p[i - 1] * x[t - i];
    x[t] = value;
  }
}

/// B u(t-k) + constant.
double input_at(const Polynomial& model, std::span<const double> u_V, int t) {
  double sum = model.constant_m;
  for (std::size_t i = 0; i < model.b.size(); ++i) {
    sum += model.b[i] * u_V[static_cast<std::size_t>(t - model.k - static_cast<int>(i))];
  }
  return sum;
}

/// D/C of v, v = 0 before `first`.
std::vector<double> whitened(const Polynomial& model, const std::vector<double>& v, int first) {
  if (model.c.empty() && model.d.empty()) return v;
  std::vector<double> e(v.size(), 0.0);
  for (int t = first; t < static_cast<int>(v.size()); ++t) e[t] = apply(model.d, v, t, first);
  divide(model.c, e, first, first);
  return e;
}

/// w, v = A y - w and e, named as in the equations; before the first error w is the fitted start, v
/// is 0 and e is NaN.
struct Signals {
  std::vector<double> w;
  std::vector<double> v;
  std::vector<double> e;
};

Signals signals_of(const Polynomial& model, const Stretch& stretch) {
  const int n = stretch.size();
  const int first = model.orders(false).history();
  const auto size = static_cast<std::size_t>(n);
  Signals out{std::vector<double>(size, 0.0), std::vector<double>(size, 0.0),
              std::vector<double>(size, kNaN)};
  if (n <= first) return out;
  const int nf = static_cast<int>(model.f.size());

  // w from the input alone, w = 0 before `first`; the unknown initial values are added later.
  for (int t = first; t < n; ++t) out.w[t] = input_at(model, stretch.u_V, t);
  divide(model.f, out.w, first, first);
  for (int t = first; t < n; ++t) {
    double value = stretch.y_m[static_cast<std::size_t>(t)];
    for (std::size_t i = 0; i < model.a.size(); ++i) {
      value += model.a[i] * stretch.y_m[static_cast<std::size_t>(t - 1) - i];
    }
    out.v[t] = value - out.w[t];
  }
  const std::vector<double> e = whitened(model, out.v, first);
  Eigen::Map<Eigen::VectorXd> result(out.e.data() + first, n - first);
  result = Eigen::Map<const Eigen::VectorXd>(e.data() + first, n - first);
  if (nf == 0 || !result.allFinite()) return out;

  std::vector<std::vector<double>> responses;
  Eigen::MatrixXd filtered(n - first, nf);
  for (int j = 0; j < nf; ++j) {
    std::vector<double> h(size, 0.0);
    h[first - 1 - j] = 1.0;
    divide(model.f, h, first, first - nf);
    responses.push_back(h);
    std::fill(h.begin(), h.begin() + first, 0.0);
    const std::vector<double> white = whitened(model, h, first);
    filtered.col(j) = Eigen::Map<const Eigen::VectorXd>(white.data() + first, n - first);
  }
  if (!filtered.allFinite()) {
    result.setConstant(kNaN);
    return out;
  }
  const Eigen::VectorXd found = linear_algebra::pivoted_least_squares(filtered, result);
  result -= filtered * found;
  for (int j = 0; j < nf; ++j) {
    for (int t = 0; t < n; ++t) out.w[t] += found[j] * responses[j][t];
    for (int t = first; t < n; ++t) out.v[t] -= found[j] * responses[j][t];
  }
  return out;
}

struct Form {
  const char* name;
  std::vector<int Orders::*> orders;
};

const std::array<Form, 5> kForms{{
    {"armax", {&Orders::a, &Orders::b, &Orders::c, &Orders::k}},
    {"arx", {&Orders::a, &Orders::b, &Orders::k}},
    {"oe", {&Orders::b, &Orders::f, &Orders::k}},
    {"bj", {&Orders::b, &Orders::c, &Orders::d, &Orders::f, &Orders::k}},
    {"poly", {&Orders::a, &Orders::b, &Orders::c, &Orders::d, &Orders::f, &Orders::k}},
}};

const Form& form_of(const Orders& o) {
  if (o.f == 0 && o.d == 0) return o.c > 0 ? kForms[0] : kForms[1];
  if (o.a == 0 && o.f > 0) return o.c == 0 && o.d == 0 ? kForms[2] : kForms[3];
  return kForms[4];
}

std::vector<int> numbers_in(std::string_view text) {
  std::vector<int> out;
  if (text.empty()) return out;
  if (text.front() != '(') {
    for (const char digit : text) out.push_back(digit - '0');
    return out;
  }
  if (text.back() != ')') return {};
  const char* at = text.data() + 1;
  const char* const end = text.data() + text.size() - 1;
  while (at < end) {
    int value = -1;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc{}) return {};
    out.push_back(value);
    at = next;
    if (at < end && *at++ != ',') return {};
    while (at < end && *at == ' ') ++at;
  }
  return out;
}

}  // namespace

int Orders::history() const { return std::max({a, f, b > 0 ? k + b - 1 : 0}); }

std::string Orders::text() const {
  const Form& form = form_of(*this);
  const bool wide = &form == &kForms[4] || std::any_of(form.orders.begin(), form.orders.end(),
                                                       [&](auto of) { return this->*of > 9; });
  std::string out = form.name + std::string(wide ? "(" : "");
  for (std::size_t i = 0; i < form.orders.size(); ++i) {
    if (wide && i > 0) out += ',';
    out += std::to_string(this->*form.orders[i]);
  }
  return out + (wide ? ")" : "");
}

std::vector<std::string> Orders::names() const {
  std::vector<std::string> out;
  const auto add = [&](const char* letter, int count) {
    for (int i = 1; i <= count; ++i) out.push_back(letter + std::to_string(i));
  };
  add("a", a);
  add("b", b);
  add("c", c);
  add("d", d);
  add("f", f);
  if (constant) out.emplace_back("constant");
  return out;
}

Orders parse_orders(const std::string& text, bool constant) {
  std::string lower;
  for (const char letter : text) {
    lower.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(letter))));
  }
  for (const Form& form : kForms) {
    if (!lower.starts_with(form.name)) continue;
    const std::vector<int> numbers =
        numbers_in(std::string_view(lower).substr(std::string_view(form.name).size()));
    if (numbers.size() != form.orders.size()) break;
    Orders out;
    out.constant = constant;
    bool good = true;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      out.*form.orders[i] = numbers[i];
      const int most = form.orders[i] == &Orders::k ? kMaxDelay : kMaxOrder;
      good = good && numbers[i] >= 0 && numbers[i] <= most;
    }
    if (good && out.a + out.b + out.f > 0) return out;
    break;
  }
  throw config::schema::UsageError(
      "structure: unknown \"" + text +
      "\"; allowed: arxNMK, armaxNMCK, oeMFK, bjMCDFK, each order one digit 0 to 9, or "
      "in brackets with commas 0 to 10, and the delay K to 50");
}

Orders Polynomial::orders(bool constant) const {
  const auto count = [](const std::vector<double>& p) { return static_cast<int>(p.size()); };
  return {count(a), count(b), count(c), count(d), count(f), k, constant};
}

Polynomial from_values(const Orders& orders, const double* values) {
  Polynomial out;
  out.k = orders.k;
  const auto take = [&](std::vector<double>& p, int count) {
    p.assign(values, values + count);
    values += count;
  };
  take(out.a, orders.a);
  take(out.b, orders.b);
  take(out.c, orders.c);
  take(out.d, orders.d);
  take(out.f, orders.f);
  if (orders.constant) out.constant_m = *values;
  return out;
}

std::vector<double> to_values(const Polynomial& model, bool constant) {
  std::vector<double> out;
  for (const auto* p : {&model.a, &model.b, &model.c, &model.d, &model.f}) {
    out.insert(out.end(), p->begin(), p->end());
  }
  if (constant) out.push_back(model.constant_m);
  return out;
}

std::vector<double> one_step_errors(const Polynomial& model, const Stretch& stretch) {
  return signals_of(model, stretch).e;
}

int free_run_history(const Polynomial& model) {
  const int input = model.b.empty() ? 0 : model.k + static_cast<int>(model.b.size()) - 1;
  return std::max(static_cast<int>(model.a.size() + model.f.size()), input);
}

std::vector<double> free_run(const Polynomial& model, const Stretch& stretch, int start) {
  const int n = stretch.size();
  std::vector<double> y(stretch.y_m.begin(), stretch.y_m.end());
  const int least = free_run_history(model);
  const int na = static_cast<int>(model.a.size());
  const int nf = static_cast<int>(model.f.size());
  const int first = std::min(n, std::max(start, least));
  Signals known{std::vector<double>(y.size(), 0.0), std::vector<double>(y.size(), 0.0),
                std::vector<double>(y.size(), 0.0)};
  if (start > least) {
    const auto count = static_cast<std::size_t>(first);
    const Signals before = signals_of(model, {stretch.u_V.first(count), stretch.y_m.first(count)});
    std::copy(before.w.begin(), before.w.end(), known.w.begin());
    std::copy(before.v.begin(), before.v.end(), known.v.begin());
    std::transform(before.e.begin(), before.e.end(), known.e.begin(),
                   [](double e) { return std::isnan(e) ? 0.0 : e; });
  } else {
    for (int t = std::max(0, first - nf); t < first; ++t) known.w[t] = apply(model.a, y, t, 0);
  }
  for (int t = first; t < n; ++t) {
    double w = input_at(model, stretch.u_V, t);
    for (int i = 1; i <= nf; ++i) w -= model.f[i - 1] * known.w[t - i];
    known.w[t] = w;
    double v = 0.0;
    for (int i = 1; i <= std::min(t, static_cast<int>(model.c.size())); ++i) {
      v += model.c[i - 1] * known.e[t - i];
    }
    for (int i = 1; i <= std::min(t, static_cast<int>(model.d.size())); ++i) {
      v -= model.d[i - 1] * known.v[t - i];
    }
    known.v[t] = v;
    y[t] = w + v;
    for (int i = 1; i <= na; ++i) y[t] -= model.a[i - 1] * y[t - i];
  }
  return y;
}

double largest_root(const std::vector<double>& p) {
  const auto n = static_cast<Eigen::Index>(p.size());
  if (n == 0) return 0.0;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) companion(0, j) = -p[static_cast<std::size_t>(j)];
  for (Eigen::Index i = 1; i < n; ++i) companion(i, i - 1) = 1.0;
  if (!companion.allFinite()) return std::numeric_limits<double>::infinity();
  return linear_algebra::eigenvalues(companion).cwiseAbs().maxCoeff();
}

}  // namespace estimator::structures
