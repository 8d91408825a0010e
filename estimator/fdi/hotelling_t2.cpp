#include "estimator/fdi/hotelling_t2.h"

#include <cmath>
#include <cstdio>

#include "config/schema/error.h"
#include "estimator/fdi/block_method.h"
#include "estimator/residual/distributions.h"

namespace estimator::fdi {
namespace {

using config::schema::bad_config;

class HotellingT2Method final : public BlockMethod {
 public:
  HotellingT2Method(const HotellingT2Config& config, const MethodContext& context)
      : BlockMethod(config.features, config.block_s, context, config.where()),
        config_(config),
        healthy_(config.healthy.mean, config.healthy.covariance,
                 static_cast<double>(config.healthy.blocks), config.where()) {
    const double p = interval_s() / config.false_alarm_time_s;
    if (!(p > 0.0 && p < 0.5)) {
      throw bad_config(config.where() + ": false_alarm_time_s",
                       "is no multiple of a block, or block_s is missing", "many blocks");
    }
    limit_ = healthy_.limit(p);
  }
  [[nodiscard]] std::vector<std::string> names() const override { return {"distance2", "limit"}; }
  [[nodiscard]] std::vector<Alarm> declared_alarms() const override {
    return {config_.naming.alarm("outside")};
  }
  [[nodiscard]] AlarmInput alarm_input(std::size_t /*number*/) const noexcept override {
    AlarmInput input;
    input.value = t2_;
    if (!(t2_ > limit_)) {
      input.reason = "inside the healthy region";
      return input;
    }
    input.severity = config_.naming.level();
    input.direction = 1;
    std::snprintf(reason_, sizeof reason_,
                  "%.4g away from the healthy region, %.4g is its edge; most by %s", std::sqrt(t2_),
                  std::sqrt(limit_), config_.features[main_contributor_].c_str());
    input.reason = reason_;
    return input;
  }

 private:
  void take(std::span<const double> means) noexcept override {
    t2_ = healthy_.statistic(means);
    main_contributor_ = healthy_.main_contributor();
  }
  void show(std::span<EstimatedValue> values) const noexcept override {
    values[0].value = valid() ? t2_ : kNaN;
    values[1].value = limit_;
  }
  void forget() noexcept override { t2_ = 0.0, main_contributor_ = 0; }
  void serialize_state(StateArchive& archive) override {
    archive.value(t2_);
    archive.value(main_contributor_);
    if (main_contributor_ >= config_.features.size()) main_contributor_ = 0, archive.fail();
  }

  HotellingT2Config config_;
  HotellingT2 healthy_;
  double limit_ = 0.0;
  double t2_ = 0.0;
  std::size_t main_contributor_ = 0;
  mutable char reason_[200] = "";
};

}  // namespace

HotellingT2::HotellingT2(std::span<const double> mean, std::span<const double> covariance,
                         double blocks, const std::string& where)
    : mean_(Eigen::Map<const Eigen::VectorXd>(mean.data(), static_cast<Eigen::Index>(mean.size()))),
      x_(mean_.size()),
      solved_(mean_.size()),
      blocks_(blocks) {
  const Eigen::Index d = mean_.size();
  if (covariance.size() != mean.size() * mean.size() || d == 0) {
    throw bad_config(where, "covariance has not a number for each pair of values");
  }
  if (!(blocks > static_cast<double>(d) + 1.0)) {
    throw bad_config(where, "was learned from fewer blocks than values",
                     std::to_string(d + 2) + " or more");
  }
  Eigen::MatrixXd s = Eigen::Map<const Eigen::MatrixXd>(covariance.data(), d, d);
  scale_ = s.diagonal().cwiseSqrt();
  if (!(scale_.minCoeff() > 0.0) || !scale_.allFinite()) {
    throw bad_config(where, "has a value that does not vary");
  }
  s = scale_.cwiseInverse().asDiagonal() * s * scale_.cwiseInverse().asDiagonal();
  // Regularisation: values that depend on others would make the covariance singular.
  constexpr double kLeast = 1e-9;
  s.diagonal().array() += kLeast;
  const Eigen::LLT<Eigen::MatrixXd> factor(s);
  if (factor.info() != Eigen::Success || !s.allFinite()) {
    throw bad_config(where, "covariance is not positive definite");
  }
  inverse_ = factor.solve(Eigen::MatrixXd::Identity(d, d));
  const Eigen::MatrixXd l = factor.matrixL();
  log_det_ = 2.0 * (l.diagonal().array().log().sum() + scale_.array().log().sum());
}

double HotellingT2::statistic(std::span<const double> x) noexcept {
  for (Eigen::Index i = 0; i < mean_.size(); ++i) {
    x_(i) = (x[static_cast<std::size_t>(i)] - mean_(i)) / scale_(i);
  }
  solved_.noalias() = inverse_ * x_;
  t2_ = x_.dot(solved_);
  double greatest = -1.0;
  for (Eigen::Index i = 0; i < mean_.size(); ++i) {
    const double own = solved_(i) * solved_(i) / inverse_(i, i);
    if (own <= greatest) continue;
    greatest = own;
    main_contributor_ = static_cast<std::size_t>(i);
  }
  return t2_;
}

double HotellingT2::limit(double p) const {
  const auto d = static_cast<double>(mean_.size());
  const double n = blocks_;
  return d * (n + 1.0) * (n - 1.0) / (n * (n - d)) * residual::f_quantile_upper(p, d, n - d);
}

void HotellingT2Config::visit(config::schema::Visitor& v) {
  visit_trained(v);
  v.texts({"features", "values tested together", true}, features);
  v.number({"false_alarm_time_s", "mean time between false alarms"}, false_alarm_time_s,
           {1e-3, 1e10});
  naming.visit(v);
  bool trained = !healthy.mean.empty();
  v.optional_table({"healthy", "distribution of the healthy values"}, trained,
                   [this](config::schema::Visitor& t) {
                     healthy.name = TrainedFile::kHealthy;
                     healthy.visit(t);
                   });
}

std::unique_ptr<DetectionMethod> HotellingT2Config::make(const MethodContext& context) const {
  if (features.empty()) throw bad_config(where() + ": features", "is empty");
  if (healthy.mean.size() != features.size()) {
    throw bad_config(where(), "is not trained", "file, from spoolwatch train");
  }
  return std::make_unique<HotellingT2Method>(*this, context);
}

}  // namespace estimator::fdi
