#include "estimator/fdi/observer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "config/schema/error.h"
#include "estimator/fdi/detection_method.h"

namespace estimator::fdi {
namespace {

using config::schema::bad_config;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd matrix(const std::vector<double>& numbers, Index rows, Index columns,
                const std::string& where) {
  if (static_cast<Index>(numbers.size()) != rows * columns) {
    throw bad_config(where, "has " + std::to_string(numbers.size()) + " numbers",
                     std::to_string(rows) + " x " + std::to_string(columns) + ", row by row");
  }
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(numbers.data(), rows, columns);
}

/// One observer of the bank; allocates at construction only.
class ObserverState {
 public:
  ObserverState(const UnknownInputObserver& design, std::vector<Index> outputs, std::size_t window)
      : design_(design),
        outputs_(std::move(outputs)),
        z_(VectorXd::Zero(design.f.rows())),
        next_(z_.size()),
        y_(static_cast<Index>(outputs_.size())),
        r_(y_.size()),
        squares_(window, 0.0) {}

  void update(const VectorXd& u, const VectorXd& y) noexcept {
    for (Index i = 0; i < y_.size(); ++i) y_(i) = y(outputs_[static_cast<std::size_t>(i)]);
    r_.noalias() = design_.l1 * z_;
    r_.noalias() += design_.l2 * y_;
    squares_[at_] = r_.squaredNorm() / static_cast<double>(r_.size());
    at_ = at_ + 1 == squares_.size() ? 0 : at_ + 1;
    next_.noalias() = design_.f * z_;
    next_.noalias() += design_.j * u;
    next_.noalias() += design_.g * y_;
    z_.swap(next_);
  }
  [[nodiscard]] double rms() const noexcept {
    double sum = 0.0;
    for (const double square : squares_) sum += square;
    return std::sqrt(sum / static_cast<double>(squares_.size()));
  }
  void reset() noexcept {
    z_.setZero();
    std::fill(squares_.begin(), squares_.end(), 0.0);
    at_ = 0;
  }
  void serialize(StateArchive& archive) {
    for (Index i = 0; i < z_.size(); ++i) archive.value(z_(i));
    archive.fixed(squares_);
    archive.value(at_);
    if (at_ >= squares_.size()) at_ = 0, archive.fail();
  }

 private:
  UnknownInputObserver design_;
  std::vector<Index> outputs_;
  VectorXd z_, next_, y_, r_;
  std::vector<double> squares_;  ///< a ring
  std::size_t at_ = 0;
};

class Observer final : public DetectionMethod {
 public:
  Observer(const ObserverConfig& config, const MethodContext& context)
      : config_(config),
        u_(static_cast<Index>(config.u.size())),
        y_(static_cast<Index>(config.y.size())) {
    const std::string where = "[[observer]] " + config.id;
    for (const std::string& each : config.u) u_in_.push_back(context.inputs.find(each, where));
    for (const std::string& each : config.y) y_in_.push_back(context.inputs.find(each, where));
    const auto samples = [&](double time_s) {
      return std::max<std::int64_t>(1, std::llround(time_s / context.sample_time_s));
    };
    window_ = samples(config.window_s);
    stride_ = samples(config.stride_s);
    interval_s_ = static_cast<double>(stride_) * context.sample_time_s;
    StateSpaceModel model = config.model();
    for (Index i = 0; i < model.c.rows(); ++i) {
      model.c.row(i) /= config.output_std[static_cast<std::size_t>(i)];
    }
    const std::size_t observers = config.bank ? config.y.size() : 1;
    for (std::size_t left_out = 0; left_out < observers; ++left_out) {
      StateSpaceModel part = model;
      std::vector<Index> used;
      for (Index i = 0; i < model.c.rows(); ++i) {
        if (!config.bank || i != static_cast<Index>(left_out)) used.push_back(i);
      }
      part.c.resize(static_cast<Index>(used.size()), model.c.cols());
      for (std::size_t i = 0; i < used.size(); ++i) {
        part.c.row(static_cast<Index>(i)) = model.c.row(used[i]);
      }
      const std::string which = config.bank ? where + " without " + config.y[left_out] : where;
      bank_.emplace_back(
          unknown_input_observer(part, which, config.process_std * config.process_std),
          std::move(used), static_cast<std::size_t>(window_));
    }
    rms_.assign(bank_.size(), 0.0);
  }
  [[nodiscard]] std::vector<std::string> names() const override {
    std::vector<std::string> names;
    for (std::size_t i = 1; i <= bank_.size(); ++i) names.push_back("r" + std::to_string(i));
    return names;
  }
  [[nodiscard]] std::vector<Alarm> declared_alarms() const override {
    if (std::isinf(config_.limit)) return {};
    return {config_.naming.alarm("sensor_out")};
  }
  /// The state is unknown after a gap.
  bool on_gap(std::int64_t /*periods*/) noexcept override {
    restart();
    return false;
  }
  bool push(const config::signals::Sample& /*sample*/, double /*y_m*/) noexcept override {
    if (++since_ >= stride_) since_ = 0;
    missing_ = false;
    for (Index i = 0; i < u_.size(); ++i) {
      u_(i) = value(u_in_, i) - config_.input_offset[static_cast<std::size_t>(i)];
    }
    for (Index i = 0; i < y_.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      y_(i) = (value(y_in_, i) - config_.output_offset[at]) / config_.output_std[at];
    }
    if (missing_) {
      restart();
      missing_ = true;
    } else {
      for (ObserverState& each : bank_) each.update(u_, y_);
      settled_ = std::min(settled_ + 1, 2 * window_);
    }
    return since_ == 0;
  }
  MethodOutput evaluate(std::span<EstimatedValue> values) noexcept override {
    MethodOutput found;
    found.warming_up = settled_ < 2 * window_ && !missing_;
    found.valid = !missing_ && !found.warming_up;
    found.reason = missing_ ? "an input or output is missing" : found.valid ? "" : "settling";
    for (std::size_t i = 0; i < bank_.size(); ++i) {
      rms_[i] = bank_[i].rms();
      values[i].value = found.valid ? rms_[i] : kNaN;
    }
    valid_ = found.valid;
    return found;
  }
  [[nodiscard]] AlarmInput alarm_input(std::size_t /*number*/) const noexcept override {
    AlarmInput input;
    std::size_t above = 0;
    std::size_t fits = 0;
    for (std::size_t i = 0; i < rms_.size(); ++i) {
      if (rms_[i] > config_.limit) {
        ++above;
      } else {
        fits = i;
      }
      if (std::isnan(input.value) || rms_[i] > input.value) input.value = rms_[i];
    }
    fault_ = {};
    input.fault = &fault_;
    if (!valid_) {
      input.severity = Severity::invalid;
      input.reason = "an input or output is missing";
    } else if (above == rms_.size()) {
      input.severity = config_.naming.level();
      input.direction = 1;
      input.reason = rms_.size() > 1
                         ? "no observer fits: the model, or more than one sensor, is wrong"
                         : "the observer does not fit";
    } else if (above > 0 && above + 1 == rms_.size()) {
      input.severity = config_.naming.level();
      input.direction = 1;
      fault_.parameter = config_.y[fits];
      std::snprintf(reason_, sizeof reason_, "all fits without %s, and nothing with it",
                    config_.y[fits].c_str());
      input.reason = reason_;
    } else {
      input.reason = "the observers fit";
    }
    return input;
  }
  void reset() override {
    restart();
    since_ = 0;
  }
  void serialize(StateArchive& archive) override {
    for (ObserverState& each : bank_) each.serialize(archive);
    archive.fixed(rms_);
    archive.value(since_);
    archive.value(settled_);
    archive.value(missing_);
    archive.value(valid_);
  }
  [[nodiscard]] double interval_s() const noexcept override { return interval_s_; }

 private:
  double value(const std::vector<MethodInput>& inputs, Index i) noexcept {
    const MethodInput& input = inputs[static_cast<std::size_t>(i)];
    missing_ = missing_ || !input.usable();
    return input.usable() ? input.value() : 0.0;
  }
  void restart() noexcept {
    for (ObserverState& each : bank_) each.reset();
    settled_ = 0;
    missing_ = false;
  }

  ObserverConfig config_;
  std::vector<MethodInput> u_in_, y_in_;
  VectorXd u_, y_;
  std::vector<ObserverState> bank_;
  std::vector<double> rms_;
  std::int64_t window_ = 1, stride_ = 1;
  double interval_s_ = 0.0;
  std::int64_t since_ = 0;
  std::int64_t settled_ = 0;
  bool missing_ = false;
  bool valid_ = false;
  mutable FaultName fault_;
  mutable char reason_[160] = "";
};

}  // namespace

void ObserverConfig::visit(config::schema::Visitor& v) {
  v.text({"id", "name; prefix of its values: ID.r1", true}, id);
  v.texts({"u", "quantities that drive the model", true}, u);
  v.texts({"y", "quantities that it gives", true}, y);
  v.numbers({"a", "row by row", true}, a);
  v.numbers({"b", "row by row", true}, b);
  v.numbers({"c", "row by row", true}, c);
  v.numbers({"e", "input matrix of the unknown inputs, row by row"}, e);
  v.numbers({"input_offset", "u at the operating point"}, input_offset);
  v.numbers({"output_offset", "y at the operating point"}, output_offset);
  v.numbers({"output_std", "noise of each y", true}, output_std, {1e-300, 1e300});
  v.number({"process_std", "noise of each state a sample; the more, the faster it follows", true},
           process_std, {1e-150, 1e150});
  v.number({"window_s", "averaging time of the residuals"}, window_s, {1e-4, 1e4});
  v.number({"stride_s", "time between outputs"}, stride_s, {1e-4, 1e4});
  v.boolean({"bank", "one observer without each output"}, bank);
  v.number({"limit", "limit of the residuals, in output_std"}, limit,
           {0.0, std::numeric_limits<double>::infinity()});
  naming.visit(v);
}

std::vector<std::string> ObserverConfig::inputs() const {
  std::vector<std::string> all = u;
  all.insert(all.end(), y.begin(), y.end());
  return all;
}

StateSpaceModel ObserverConfig::model() const {
  const std::string where = "[[observer]] " + id;
  const auto n = static_cast<Index>(std::llround(std::sqrt(static_cast<double>(a.size()))));
  if (n == 0) throw bad_config(where + ": a", "is empty", "n x n numbers");
  StateSpaceModel out;
  out.a = matrix(a, n, n, where + ": a");
  out.b = matrix(b, n, static_cast<Index>(u.size()), where + ": b");
  out.c = matrix(c, static_cast<Index>(y.size()), n, where + ": c");
  const Index unknown = static_cast<Index>(e.size()) / n;
  out.e = matrix(e, n, unknown, where + ": e");
  return out;
}

std::unique_ptr<DetectionMethod> ObserverConfig::make(const MethodContext& context) const {
  const std::string where = "[[observer]] " + id;
  if (y.empty() || (bank && y.size() < 2)) {
    throw bad_config(where + ": y", "has too few outputs", bank ? "two or more" : "one or more");
  }
  ObserverConfig whole = *this;
  if (whole.input_offset.empty()) whole.input_offset.assign(u.size(), 0.0);
  if (whole.output_offset.empty()) whole.output_offset.assign(y.size(), 0.0);
  if (whole.input_offset.size() != u.size() || whole.output_offset.size() != y.size() ||
      output_std.size() != y.size()) {
    throw bad_config(where, "offsets and output_std have not a number for each quantity");
  }
  return std::make_unique<Observer>(whole, context);
}

}  // namespace estimator::fdi
