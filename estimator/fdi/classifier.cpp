#include "estimator/fdi/classifier.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "config/schema/error.h"
#include "estimator/fdi/block_method.h"
#include "estimator/fdi/fault_trajectory.h"
#include "estimator/fdi/hotelling_t2.h"

namespace estimator::fdi {
namespace {

using config::schema::bad_config;

constexpr double kLikely = 0.05;  ///< a class of this probability belongs to the ambiguity group
constexpr std::size_t kMaxClasses = 64;
constexpr int kNone = -1;

using Square = Eigen::Map<const Eigen::MatrixXd>;

Square covariance_of(const TrainedClass& each) {
  const auto size = static_cast<Eigen::Index>(each.mean.size());
  return {each.covariance.data(), size, size};
}

Eigen::MatrixXd pooled_covariance(const std::vector<TrainedClass>& classes) {
  Eigen::MatrixXd pooled = 0.0 * covariance_of(classes.front());
  double weights = 0.0;
  for (const TrainedClass& each : classes) {
    const auto weight = static_cast<double>(each.blocks - 1);
    weights += weight;
    pooled += weight * covariance_of(each);
  }
  return pooled / weights;
}

/// Mean and covariance of each class, shrunk towards the pooled one.
std::vector<ClassDistribution> distributions_of(const ClassifierConfig& config,
                                                const Eigen::MatrixXd& pooled) {
  std::vector<ClassDistribution> distributions;
  for (const TrainedClass& each : config.classes) {
    const Square own = covariance_of(each);
    distributions.push_back({Eigen::Map<const Eigen::VectorXd>(each.mean.data(), own.rows()),
                             own + config.pooling * (pooled - own),
                             static_cast<double>(each.blocks)});
  }
  return distributions;
}

class Classifier final : public BlockMethod {
 public:
  Classifier(const ClassifierConfig& config, const MethodContext& context)
      : BlockMethod(config.features, config.block_s, context, config.where()), config_(config) {
    const Eigen::MatrixXd pooled = pooled_covariance(config.classes);
    const std::vector<ClassDistribution> distributions = distributions_of(config, pooled);
    for (std::size_t i = 0; i < distributions.size(); ++i) {
      const std::string& name = config.classes[i].name;
      regions_.push_back(hotelling_t2(distributions[i], config.where() + ": class " + name));
      limits_.push_back(regions_[i].limit(config.rejection));
      if (name == TrainedFile::kHealthy) healthy_ = i;
    }
    trajectories_ = fault_trajectories(config.classes, distributions, pooled, healthy_,
                                       config.rejection, config.where());
    answer_.found = static_cast<int>(healthy_);
  }
  [[nodiscard]] std::vector<std::string> names() const override {
    return {"class", "probability", "distance2"};
  }
  [[nodiscard]] std::vector<Alarm> declared_alarms() const override {
    return {config_.naming.alarm("fault")};
  }
  [[nodiscard]] AlarmInput alarm_input(std::size_t /*number*/) const noexcept override;

 private:
  struct Answer {
    int found = kNone;  ///< class
    int nearest = 0;    ///< index with the smallest distance
    double probability = 0.0;
    double t2 = 0.0;  ///< T^2 of `nearest`
  };
  void take(std::span<const double> means) noexcept override;
  void show(std::span<EstimatedValue> values) const noexcept override {
    values[0].value = valid() ? answer_.found : kNaN;
    values[1].value = valid() && answer_.found != kNone ? answer_.probability : kNaN;
    values[2].value = valid() ? answer_.t2 : kNaN;
  }
  void forget() noexcept override {
    answer_ = {};
    answer_.found = static_cast<int>(healthy_);
    confirmed_ = answer_;
    in_a_row_ = 0;
    out_ = false;
  }
  void serialize_state(StateArchive& archive) override {
    archive.value(answer_);
    archive.value(confirmed_);
    archive.value(probabilities_);
    archive.value(confirmed_probabilities_);
    archive.value(in_a_row_);
    archive.value(out_);
    const int classes = static_cast<int>(regions_.size());
    for (Answer* each : {&answer_, &confirmed_}) {
      if (each->found < classes && each->nearest < classes && each->found >= kNone &&
          each->nearest >= 0) {
        continue;
      }
      *each = {};
      archive.fail();
    }
  }

  ClassifierConfig config_;
  std::vector<HotellingT2> regions_;
  std::vector<double> limits_;
  std::vector<std::optional<FaultTrajectory>> trajectories_;  ///< to each class
  std::size_t healthy_ = 0;
  Answer answer_;
  Answer confirmed_;  ///< the latest confirmed one
  std::array<double, kMaxClasses> probabilities_{};
  std::array<double, kMaxClasses> confirmed_probabilities_{};
  std::int64_t in_a_row_ = 0;  ///< consecutive blocks of one answer
  bool out_ = false;
  mutable FaultName fault_;
  mutable std::array<std::string_view, kMaxClasses> group_;
  mutable char reason_[200] = "";
};

void Classifier::take(std::span<const double> means) noexcept {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  Answer now;
  now.t2 = kInfinite;
  double greatest = -kInfinite;
  const auto weigh = [&](std::size_t i, double t2, double log_density) {
    probabilities_[i] = log_density;
    if (t2 < now.t2) {
      now.t2 = t2;
      now.nearest = static_cast<int>(i);
    }
    if (log_density <= greatest) return;
    greatest = log_density;
    now.found = static_cast<int>(i);
  };
  bool any = false;
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    const double t2 = regions_[i].statistic(means);
    any = any || t2 <= limits_[i];
    weigh(i, t2, regions_[i].log_density());
  }
  if (!any) {
    now.found = kNone;
    greatest = -kInfinite;
    for (std::size_t i = 0; i < regions_.size(); ++i) {
      probabilities_[i] = -kInfinite;
      if (!trajectories_[i]) continue;
      const FaultTrajectory::Nearest on_trajectory = trajectories_[i]->nearest(means);
      weigh(i, on_trajectory.t2, on_trajectory.inside ? on_trajectory.log_density : -kInfinite);
    }
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    probabilities_[i] = now.found == kNone ? 0.0 : std::exp(probabilities_[i] - greatest);
    sum += probabilities_[i];
  }
  for (std::size_t i = 0; i < regions_.size() && sum > 0.0; ++i) probabilities_[i] /= sum;
  now.probability = now.found == kNone ? 0.0 : probabilities_[static_cast<std::size_t>(now.found)];
  in_a_row_ = now.found == answer_.found ? in_a_row_ + 1 : 1;
  answer_ = now;
  if (in_a_row_ < config_.confirm) return;
  out_ = now.found != static_cast<int>(healthy_);
  confirmed_ = now;
  confirmed_probabilities_ = probabilities_;
}

AlarmInput Classifier::alarm_input(std::size_t /*number*/) const noexcept {
  AlarmInput input;
  input.value = confirmed_.t2;
  if (!out_) {
    input.reason = "as in healthy operation";
    return input;
  }
  input.severity = config_.naming.level();
  fault_ = {};
  if (confirmed_.found == kNone) {
    std::snprintf(
        reason_, sizeof reason_, "none of these: nearest is %s, %.3g away, %.3g is its edge",
        config_.classes[static_cast<std::size_t>(confirmed_.nearest)].name.c_str(),
        std::sqrt(confirmed_.t2), std::sqrt(limits_[static_cast<std::size_t>(confirmed_.nearest)]));
  } else {
    const TrainedClass& found = config_.classes[static_cast<std::size_t>(confirmed_.found)];
    std::size_t likely = 0;
    for (std::size_t i = 0; i < regions_.size(); ++i) {
      const std::string_view name = config_.classes[i].name;
      if (confirmed_probabilities_[i] < kLikely) continue;
      if (std::find(group_.begin(), group_.begin() + likely, name) == group_.begin() + likely) {
        group_[likely++] = name;
      }
    }
    input.direction = static_cast<std::int8_t>(likely > 1 ? 0 : found.direction);
    fault_.confidence = 0.0;  // several classes may have one name
    for (std::size_t i = 0; i < regions_.size(); ++i) {
      if (config_.classes[i].name == found.name) fault_.confidence += confirmed_probabilities_[i];
    }
    if (likely > 1) {
      fault_.group = std::span<const std::string_view>(group_.data(), likely);
    } else {
      fault_.parameter = found.name;
    }
    std::snprintf(reason_, sizeof reason_, "looks like %s%s, probability %.3f", found.name.c_str(),
                  found.direction > 0   ? " risen"
                  : found.direction < 0 ? " fallen"
                                        : "",
                  fault_.confidence);
  }
  input.fault = &fault_;
  input.reason = reason_;
  return input;
}

}  // namespace

void ClassifierConfig::visit(config::schema::Visitor& v) {
  visit_trained(v);
  v.texts({"features", "the values taken together", true}, features);
  v.number({"rejection", "share of a class's own blocks that is none of these"}, rejection,
           {1e-12, 0.5});
  v.number({"pooling", "share of the pooled covariance; 0: one per class, 1: one for all"}, pooling,
           {0.0, 1.0});
  v.integer({"confirm", "blocks in a row that an alarm needs"}, confirm, {1, 1000});
  naming.visit(v);
  config::schema::visit_list(v, {"class", "trained classes"}, classes);
}

std::unique_ptr<DetectionMethod> ClassifierConfig::make(const MethodContext& context) const {
  if (features.empty()) throw bad_config(where() + ": features", "is empty");
  if (classes.size() < 2 || classes.size() > kMaxClasses) {
    throw bad_config(where(), "is not trained on healthy records and on those of a fault",
                     "file, from spoolwatch train with --class");
  }
  bool healthy = false;
  for (const TrainedClass& each : classes) {
    healthy = healthy || each.name == TrainedFile::kHealthy;
    if (each.mean.size() == features.size() &&
        each.covariance.size() == features.size() * features.size()) {
      continue;
    }
    throw bad_config(where() + ": class " + each.name, "has not a number for each feature");
  }
  if (!healthy) throw bad_config(where(), "has no class healthy");
  return std::make_unique<Classifier>(*this, context);
}

}  // namespace estimator::fdi
