#include "workbench/select/candidate.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "config/schema/error.h"
#include "config/signals/nan.h"
#include "estimator/structure.h"

namespace workbench::select {
namespace {

using structures::NarxOptions;
using structures::Orders;
using structures::SubspaceMethod;
using structures::SubspaceOptions;

using config::signals::kNaN;
constexpr int kMostSubspaceOrder = 9;
constexpr int kMostHidden = 20;

StructureCandidate polynomial(Orders orders) { return {orders.text(), orders}; }

StructureCandidate state_space(int order, int delay, bool constant, SubspaceMethod method) {
  SubspaceOptions options;
  options.order = order;
  options.k = delay;
  options.constant = constant;
  options.method = method;
  const char* const name = method == SubspaceMethod::n4sid ? "n4sid" : "ss";
  return {name + std::to_string(order), options};
}

StructureCandidate network(int n, int m, int delay, int hidden) {
  NarxOptions options;
  options.n = n;
  options.m = m;
  options.k = delay;
  options.hidden = hidden;
  structures::NarxFit named;
  named.options = options;
  return {named.text(), options};
}

config::schema::UsageError unknown(const std::string& name) {
  return config::schema::UsageError(
      "--structures: unknown \"" + name +
      "\"; allowed: arxNMK, armaxNMCK, oeMFK, bjMCDFK, ssN, n4sidN (N 1 to 9), "
      "narxNMK/H (H 1 to 20 neurons)");
}

/// The number after `prefix`, 1 to `most`; 0 otherwise.
int number_after(const std::string& text, std::size_t at, int most) {
  int value = 0;
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data() + at, end, value);
  return error == std::errc{} && next == end && value >= 1 && value <= most ? value : 0;
}

Fitted refused(const std::string& why) {
  Fitted out;
  out.why = why;
  return out;
}

Fitted of_polynomial(const Orders& orders, const structures::Stretches& data, const Fitted* near,
                     const std::function<bool()>& cancel) {
  structures::PredictionErrorOptions options;
  options.cancel = cancel;
  if (near != nullptr && near->valid && orders.c + orders.d + orders.f > 0) {
    options.starts = {std::get<structures::Polynomial>(near->model)};
    options.only_these_starts = true;
    options.errors = false;
  }
  structures::PolynomialFit found = structures::fit_prediction_error(orders, data, options);
  if (!found.valid) return refused(found.why);
  Fitted out;
  out.valid = true;
  out.model = found.model;
  out.parameters = orders.size();
  out.names = orders.names();
  out.value = found.value;
  out.std_error = found.std_error;
  out.condition = found.condition;
  return out;
}

Fitted of_subspace(const SubspaceOptions& options, const structures::Stretches& data) {
  const structures::SubspaceFit found = structures::fit_subspace(options, data);
  if (!found.valid) return refused(found.why);
  Fitted out;
  out.valid = true;
  out.model = found.model;
  out.names = found.model.orders(options.constant).names();
  out.value = structures::to_values(found.model, options.constant);
  out.parameters = static_cast<int>(out.value.size());
  out.std_error.assign(out.value.size(), kNaN);
  out.condition = found.condition;
  return out;
}

Fitted of_network(NarxOptions options, const structures::Stretches& data, const Fitted* near,
                  const std::function<bool()>& cancel) {
  options.cancel = cancel;
  if (near != nullptr) options.starts = 1;
  structures::NarxFit found = structures::fit_narx(options, data);
  if (!found.valid) return refused(found.why);
  found.options.cancel = nullptr;
  Fitted out;
  out.valid = true;
  out.parameters = found.parameters();
  out.condition = found.condition;
  out.value = found.linearised();
  out.names = estimator::Structure{options.n, options.m, options.k, false}.names();
  out.std_error.assign(out.value.size(), kNaN);
  out.model = std::move(found);
  return out;
}

}  // namespace

std::string StructureCandidate::family() const {
  if (std::holds_alternative<SubspaceOptions>(what)) return "state space";
  if (std::holds_alternative<NarxOptions>(what)) return "NARX network";
  const Orders& o = std::get<Orders>(what);
  if (o.f == 0 && o.d == 0) return o.c > 0 ? "ARMAX" : "ARX";
  return o.c == 0 && o.d == 0 && o.a == 0 ? "output error" : "Box-Jenkins";
}

const Orders* StructureCandidate::arx() const {
  const Orders* const orders = std::get_if<Orders>(&what);
  return orders != nullptr && orders->c + orders->d + orders->f == 0 ? orders : nullptr;
}

int StructureCandidate::least_samples() const {
  if (const Orders* orders = std::get_if<Orders>(&what)) return structures::least_samples(*orders);
  if (const auto* s = std::get_if<SubspaceOptions>(&what)) return structures::least_samples(*s);
  const NarxOptions& n = std::get<NarxOptions>(what);
  return 4 * (n.n + n.m + 1 + n.hidden * (n.n + n.m + 2)) + n.n + n.m + n.k;
}

std::vector<StructureCandidate> usual_candidates(int k, bool constant) {
  std::vector<StructureCandidate> out;
  const auto add = [&](Orders orders) {
    orders.k = k;
    orders.constant = constant;
    out.push_back(polynomial(orders));
  };
  for (int n = 1; n <= 4; ++n) add({.a = n, .b = 1});
  add({.a = 2, .b = 2});
  add({.a = 4, .b = 4});
  add({.a = 1, .b = 1, .c = 1});
  add({.a = 2, .b = 1, .c = 1});
  add({.a = 2, .b = 1, .c = 2});
  add({.a = 3, .b = 2, .c = 3});
  add({.b = 1, .f = 1});
  add({.b = 1, .f = 2});
  add({.b = 2, .f = 3});
  add({.b = 1, .c = 1, .d = 1, .f = 1});
  add({.b = 1, .c = 1, .d = 1, .f = 2});
  add({.b = 1, .c = 2, .d = 2, .f = 2});
  for (int n = 1; n <= 4; ++n) {
    out.push_back(state_space(n, k, constant, SubspaceMethod::predictor));
  }
  for (int n = 2; n <= 3; ++n) out.push_back(state_space(n, k, constant, SubspaceMethod::n4sid));
  out.push_back(network(1, 1, k, 3));
  out.push_back(network(2, 1, k, 4));
  return out;
}

StructureCandidate parse_candidate(const std::string& name, int delay, bool constant) {
  std::string lower;
  for (const char letter : name) {
    lower.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(letter))));
  }
  if (lower.starts_with("n4sid")) {
    const int order = number_after(lower, 5, kMostSubspaceOrder);
    if (order == 0) throw unknown(name);
    return state_space(order, delay, constant, SubspaceMethod::n4sid);
  }
  if (lower.starts_with("ss")) {
    const int order = number_after(lower, 2, kMostSubspaceOrder);
    if (order == 0) throw unknown(name);
    return state_space(order, delay, constant, SubspaceMethod::predictor);
  }
  if (lower.starts_with("narx")) {
    const std::size_t slash = lower.find('/');
    const int hidden = slash == std::string::npos ? 4 : number_after(lower, slash + 1, kMostHidden);
    const std::string orders = lower.substr(4, slash == std::string::npos ? slash : slash - 4);
    const bool digits = orders.size() == 3 && std::all_of(orders.begin(), orders.end(), [](char c) {
                          return std::isdigit(static_cast<unsigned char>(c)) != 0;
                        });
    if (hidden == 0 || !digits || orders[0] + orders[1] == 2 * '0') throw unknown(name);
    return network(orders[0] - '0', orders[1] - '0', orders[2] - '0', hidden);
  }
  try {
    return polynomial(structures::parse_orders(lower, constant));
  } catch (const config::schema::Error&) {
    throw unknown(name);
  }
}

std::vector<double> Fitted::one_step_errors(const structures::Stretch& stretch) const {
  return std::visit([&](const auto& m) { return structures::one_step_errors(m, stretch); }, model);
}

std::vector<double> Fitted::free_run(const structures::Stretch& stretch, int start) const {
  return std::visit([&](const auto& m) { return structures::free_run(m, stretch, start); }, model);
}

Fitted fit(const StructureCandidate& candidate, const structures::Stretches& data,
           const Fitted* near, const std::function<bool()>& cancel) {
  if (const Orders* orders = std::get_if<Orders>(&candidate.what)) {
    return of_polynomial(*orders, data, near, cancel);
  }
  if (const auto* options = std::get_if<SubspaceOptions>(&candidate.what)) {
    return of_subspace(*options, data);
  }
  return of_network(std::get<NarxOptions>(candidate.what), data, near, cancel);
}

}  // namespace workbench::select
