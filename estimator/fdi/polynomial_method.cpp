#include "estimator/fdi/polynomial_method.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "config/schema/error.h"
#include "estimator/fdi/detection_method.h"
#include "estimator/fdi/estimation_method.h"
#include "estimator/fdi/window_monitor.h"
#include "estimator/structure.h"
#include "estimator/structures/recursive_prediction_error.h"

namespace estimator::fdi {
namespace {

constexpr double kLongestWindow_s = 1e6;
constexpr int kLeastUpdates = 40;  ///< per coefficient, before the estimates are valid

structures::RecursiveOptions options_of(const PolynomialConfig& config) {
  const std::string where = "[[polynomial]] " + config.id;
  structures::RecursiveOptions out;
  try {
    out.orders = structures::parse_orders(config.structure, config.constant);
    out.extended = config.method == "extended-least-squares";
    out.forgetting = config.forgetting;
    out.prior_variance = config.prior_variance;
    static_cast<void>(structures::RecursivePredictionError(out));
  } catch (const config::schema::Error& error) {
    throw config::schema::bad_config(where, error.what());
  }
  return out;
}

class PolynomialMethod final : public DetectionMethod {
 public:
  PolynomialMethod(const PolynomialConfig& config, const MethodContext& context)
      : config_(config),
        options_(options_of(config)),
        filter_(options_),
        monitor_(static_cast<std::size_t>(samples_in(config.window_s, context.sample_time_s))),
        stride_(samples_in(config.stride_s, context.sample_time_s)),
        warmup_(static_cast<std::int64_t>(config.warmup_s / context.sample_time_s)),
        keep_(1.0 - 1.0 / samples_in(config.window_s, context.sample_time_s)) {}

  [[nodiscard]] std::vector<std::string> names() const override {
    std::vector<std::string> out = options_.orders.names();
    out.emplace_back("residual_rms_m");
    return out;
  }
  bool on_gap(std::int64_t periods) noexcept override {
    filter_.gap();
    const auto length = static_cast<std::int64_t>(1.0 / (1.0 - keep_)) + 1;
    for (std::int64_t i = 0; i < std::min(periods, length); ++i) monitor_.push_missing();
    return advance(periods);
  }
  bool push(const config::signals::Sample& sample, double y_m) noexcept override {
    const double u_V = sample.u_applied_V;
    if (!std::isfinite(u_V) || !std::isfinite(y_m)) return on_gap(1);
    monitor_.push(u_V, sample.saturated);
    if (now_.excited) {
      if (filter_.push(u_V, y_m - config_.offset_m)) {
        const double e = filter_.prediction_error_m();
        now_.energy_m2 = keep_ * now_.energy_m2 + e * e;
        now_.weight = keep_ * now_.weight + 1.0;
      }
    } else {
      filter_.gap();
    }
    return advance(1);
  }
  MethodOutput evaluate(std::span<EstimatedValue> values) noexcept override {
    const int size = options_.orders.size();
    std::array<double, kMaxCoefficients> errors{};
    filter_.std_error(errors.data());
    bool finite = true;
    for (int i = 0; i < size; ++i) {
      EstimatedValue& v = values[static_cast<std::size_t>(i)];
      v.value = filter_.value()[i];
      v.std_error = errors[static_cast<std::size_t>(i)];
      finite = finite && std::isfinite(v.value) && std::isfinite(v.std_error);
    }
    values[static_cast<std::size_t>(size)].value =
        now_.weight > 0.0 ? std::sqrt(now_.energy_m2 / now_.weight) : kNaN;
    MethodOutput out;
    out.reason = why_not(finite);
    out.valid = *out.reason == '\0';
    out.warming_up = now_.samples < warmup_;
    out.samples = filter_.updates();
    return out;
  }
  void reset() override {
    filter_.reset();
    monitor_.reset();
    now_ = {};
  }
  void serialize(StateArchive& archive) override {
    filter_.serialize(archive);
    monitor_.serialize(archive);
    archive.value(now_);
  }
  [[nodiscard]] double interval_s() const noexcept override { return config_.stride_s; }

 private:
  struct Moving {
    std::int64_t samples = 0;
    std::int64_t since = 0;
    double energy_m2 = 0.0;
    double weight = 0.0;
    bool excited = true;
  };

  [[nodiscard]] const char* why_not(bool finite) const noexcept {
    if (!finite) return "numbers beyond what double arithmetic carries";
    if (!now_.excited) return "not excited: coefficients are kept";
    if (monitor_.missing_share() > config_.max_missing) return "too many samples are missing";
    if (monitor_.saturated_share() > config_.max_saturated) return "the command is saturated";
    if (filter_.updates() < kLeastUpdates * options_.orders.size()) return "too few samples yet";
    return "";
  }
  bool advance(std::int64_t periods) noexcept {
    now_.samples += periods;
    now_.since += periods;
    if (now_.since < stride_) return false;
    now_.since %= stride_;
    now_.excited = !monitor_.full() || monitor_.u_rms_V() >= config_.min_u_rms_V;
    return true;
  }

  PolynomialConfig config_;
  structures::RecursiveOptions options_;
  structures::RecursivePredictionError filter_;
  WindowMonitor monitor_;
  std::int64_t stride_;
  std::int64_t warmup_;
  double keep_;
  Moving now_;
};

}  // namespace

void PolynomialConfig::visit(config::schema::Visitor& v) {
  v.text({"id", "name; prefix of its quantities: ID.b1", true}, id);
  v.text({"structure", "armaxNMCK, oeMFK, bjMCDFK, arxNMK"}, structure);
  v.choice({"method", "recursive method"}, method, {"prediction-error", "extended-least-squares"});
  v.boolean({"constant", "estimate a constant term"}, constant);
  v.number({"offset_m", "subtracted from y"}, offset_m, {-1e3, 1e3});
  v.number({"forgetting", "per sample"}, forgetting, {0.5, 1.0});
  v.number({"prior_variance", "P(0) = C I"}, prior_variance, {1e-12, 1e15});
  v.number({"window_s", "window of the validity checks"}, window_s, {1e-3, 3600.0});
  v.number({"stride_s", "time between estimates"}, stride_s, {1e-4, kLongestWindow_s});
  v.number({"warmup_s", "no band acts before"}, warmup_s, {0.0, kLongestWindow_s});
  v.number({"min_u_rms_V", "less command is not excited"}, min_u_rms_V, {0.0, 1e3});
  v.number({"max_saturated", "share of saturated samples in a window"}, max_saturated, {0.0, 1.0});
  v.number({"max_missing", "share of missing samples in a window"}, max_missing, {0.0, 1.0});
}

std::unique_ptr<DetectionMethod> PolynomialConfig::make(const MethodContext& context) const {
  return std::make_unique<PolynomialMethod>(*this, context);
}

}  // namespace estimator::fdi
