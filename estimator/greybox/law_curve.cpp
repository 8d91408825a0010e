#include "estimator/greybox/law_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/signals/nan.h"
#include "estimator/greybox/kinematics.h"
#include "estimator/linear_algebra/decompositions.h"
#include "estimator/nonlinear/covariance.h"
#include "plant_sim/formula/formula.h"
#include "plant_sim/hydraulics.h"

namespace estimator::greybox {
namespace {

using config::signals::kNaN;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using plant_sim::formula::FormulaView;
using plant_sim::formula::kAcceleration;
using plant_sim::formula::kCommand;
using plant_sim::formula::kPosition;
using plant_sim::formula::kSignalNames;
using plant_sim::formula::kSpeed;
using plant_sim::formula::Signal;
using Evaluator = plant_sim::formula::ExpressionEvaluator<double>;

constexpr std::size_t kPoints = 61;
/// Difference step of a parameter, relative to its size.
constexpr double kStep = 1e-6;

/// Samples of a variable over all records; empty: none shows it.
using Samples = std::vector<double>;

template <class F>
Samples counted(const FitDataset& data, F&& of_record) {
  Samples all;
  for (const Dataset& record : data.records) {
    const std::vector<double> values = of_record(record);
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (record.valid[k] != 0) all.push_back(values[k]);
    }
  }
  return all;
}

/// The opening that follows the command at once; the spool itself is not measured.
double opening_per_V(const plant_sim::ModelFile& model) {
  plant_sim::ModelFile copy = model;
  const std::optional<plant_sim::Hydraulics> oil = plant_sim::hydraulics_of(copy);
  if (oil) return oil->valve_gain_m_per_V;
  const double* const servo = copy.value("gain_mps_per_V");
  return servo == nullptr ? 1.0 : *servo;
}

Samples samples_of(const plant_sim::ModelFile& model, const FitDataset& data,
                   std::string_view variable) {
  if (variable == "y_m") return counted(data, [](const Dataset& r) { return r.y_m; });
  if (variable == "u_V") return counted(data, [](const Dataset& r) { return r.u_V; });
  if (variable == "v_mps") {
    const double noise_m = std::isfinite(data.noise_floor_m) ? data.noise_floor_m : 0.0;
    return counted(data, [&](const Dataset& r) { return kinematics(r, noise_m).speed_mps; });
  }
  if (variable != "x_m") return {};
  const double gain = opening_per_V(model);
  return counted(data, [&](const Dataset& r) {
    std::vector<double> opening = r.u_V;
    for (double& value : opening) value *= gain;
    return opening;
  });
}

double mean(const Samples& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size())).mean();
}

double root_mean_square(const Samples& values) {
  const Eigen::Map<const VectorXd> all(values.data(), static_cast<Index>(values.size()));
  return std::sqrt(all.squaredNorm() / static_cast<double>(values.size()));
}

const char* quantity_of(const plant_sim::ModelFile& model, plant_sim::effects::Site site) {
  using plant_sim::effects::Site;
  switch (site) {
    case Site::command:
      return "command_V";
    case Site::opening:
      return plant_sim::hydraulics_of(model) ? "opening_m" : "opening_mps";
    case Site::flow:
      return "flow_m3ps";
    case Site::leakage:
      return "leakage_m3ps";
    case Site::force:
      return "force_N";
    case Site::dry_friction:
      return "friction_ratio";
    default:
      return "reading_m";
  }
}

using Held = plant_sim::formula::Signals<double>;

/// A formula with its values, over one of its variables.
class Law {
 public:
  Law(const FormulaView& formula, std::vector<double> values, Signal over)
      : formula_(formula), values_(std::move(values)), over_(over), run_(formula.program) {
    run_.set_parameters(values_.data());
  }

  [[nodiscard]] plant_sim::formula::VariableRange range(Signal variable) const {
    return formula_.ranges[variable];
  }
  /// The law adds this at its site.
  [[nodiscard]] double operator()(double x, Held at) const {
    at[over_] = x;
    return run_(at.data()) - (formula_.place.chained ? at[formula_.place.first] : 0.0);
  }
  /// d f / d parameters over the whole grid, points x parameters.
  [[nodiscard]] MatrixXd slopes(const std::vector<double>& x, const Held& held) {
    MatrixXd all(static_cast<Index>(x.size()), static_cast<Index>(values_.size()));
    for (std::size_t p = 0; p < values_.size(); ++p) {
      const double at = values_[p];
      const double step = kStep * std::max(std::abs(at), std::abs(formula_.parameters[p].typical));
      const VectorXd above = with(p, at + step, x, held);
      const VectorXd below = with(p, at - step, x, held);
      all.col(static_cast<Index>(p)) = (above - below) / (2.0 * step);
      values_[p] = at;
    }
    run_.set_parameters(values_.data());
    return all;
  }

 private:
  VectorXd with(std::size_t p, double value, const std::vector<double>& x, const Held& held) {
    values_[p] = value;
    run_.set_parameters(values_.data());
    VectorXd f(static_cast<Index>(x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) f[static_cast<Index>(i)] = (*this)(x[i], held);
    return f;
  }

  FormulaView formula_;
  std::vector<double> values_;
  Signal over_;
  Evaluator run_;
};

std::vector<double> grid(double low, double high) {
  std::vector<double> x(kPoints);
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(kPoints - 1);
    x[i] = low + share * (high - low);
  }
  return x;
}

/// Share of the samples nearest to each point of the grid.
std::vector<double> shares(const Samples& samples, const std::vector<double>& x) {
  std::vector<double> share(x.size(), 0.0);
  const double step = (x.back() - x.front()) / static_cast<double>(x.size() - 1);
  if (!(step > 0.0)) return share;
  for (const double value : samples) {
    const auto cell = static_cast<std::size_t>(std::lround((value - x.front()) / step));
    share[std::min(cell, x.size() - 1)] += 1.0 / static_cast<double>(samples.size());
  }
  return share;
}

std::vector<double> errors_of(const MatrixXd& slopes, const VectorXd& errors,
                              const MatrixXd& covariance) {
  const VectorXd known = errors.unaryExpr([](double e) { return std::isnan(e) ? 0.0 : e; });
  std::vector<double> out(static_cast<std::size_t>(slopes.rows()), kNaN);
  if (known.maxCoeff() == 0.0) return out;
  for (Index i = 0; i < slopes.rows(); ++i) {
    const double bound = slopes.row(i).cwiseAbs().dot(known);
    const double square = covariance.size() == 0
                              ? bound * bound
                              : (slopes.row(i) * covariance * slopes.row(i).transpose()).value();
    out[static_cast<std::size_t>(i)] = std::sqrt(std::max(square, 0.0));
  }
  return out;
}

double held_value(const plant_sim::ModelFile& model, const FitDataset& data, const Law& law,
                  Signal variable) {
  const Samples samples = samples_of(model, data, kSignalNames[variable]);
  if (samples.empty()) return 0.5 * (law.range(variable).min + law.range(variable).max);
  return variable == kPosition ? mean(samples) : root_mean_square(samples);
}

/// The formula's variable for "y", "v" or "u"; that of its site for any other.
Signal variable_of(const FormulaView& formula, std::string_view over) {
  const auto reads = [&](Signal signal) {
    const auto* const end = formula.program.reads + formula.program.read_count;
    return std::find(formula.program.reads, end, signal) != end;
  };
  const bool of_speed = over == "v" || over == "speed" || over == "direction";
  if (of_speed && reads(kSpeed)) return kSpeed;
  if (over == "y" && reads(kPosition)) return kPosition;
  if (over == "acceleration" && reads(kAcceleration)) return kAcceleration;
  if (over == "u" && !reads(formula.place.first) && reads(kCommand)) return kCommand;
  return formula.place.first;
}

const FormulaView* formula_named(const plant_sim::formula::Formulas& all, std::string_view name) {
  const FormulaView* const end = all.data() + all.size();
  const FormulaView* const found =
      std::find_if(all.data(), end, [&](const FormulaView& one) { return name == one.name; });
  return found == end ? nullptr : found;
}

std::vector<double> values_of(const plant_sim::ModelFile& model, std::string_view effect) {
  std::vector<double> values;
  for (const plant_sim::ModelFile::Effect& entry : model.effects) {
    if (entry.name != effect) continue;
    for (const plant_sim::NamedValue& p : entry.parameters) values.push_back(p.value);
  }
  return values;
}

}  // namespace

MatrixXd covariance_of(const FitDataset& data, const FitSummary& fitted,
                       const std::vector<std::string>& names, const VectorXd& errors) {
  if (fitted.jacobian.cols() != fitted.theta.size() || fitted.jacobian.rows() != data.size()) {
    return {};
  }
  nonlinear::Problem problem = problem_of(data, data.final_weights(), fitted.parameters);
  problem.sigma = fitted.sigma_m;
  nonlinear::Solution solution;
  solution.x = fitted.theta;
  solution.residual = fitted.residual_m;
  solution.jacobian = fitted.jacobian;
  solution.at_bound = fitted.at_bound;
  const MatrixXd whole = nonlinear::covariance(problem, solution).matrix;
  const auto place_of = [&](const std::string& name) -> Index {
    const auto found = std::find_if(fitted.parameters.begin(), fitted.parameters.end(),
                                    [&](const FreeParameter& p) { return p.name == name; });
    return found == fitted.parameters.end() ? -1 : found - fitted.parameters.begin();
  };
  const auto count = static_cast<Index>(names.size());
  std::vector<Index> places;
  for (const std::string& name : names) places.push_back(place_of(name));
  MatrixXd scaled = MatrixXd::Zero(count, count);
  for (Index i = 0; i < count; ++i) {
    for (Index j = 0; j < count; ++j) {
      const Index from = places[static_cast<std::size_t>(i)];
      const Index to = places[static_cast<std::size_t>(j)];
      if (from < 0 || to < 0) continue;
      const double sizes = std::sqrt(whole(from, from) * whole(to, to));
      if (!(sizes > 0.0) || std::isnan(errors[i]) || std::isnan(errors[j])) continue;
      scaled(i, j) = whole(from, to) / sizes * errors[i] * errors[j];
    }
  }
  return scaled;
}

MatrixXd deviated_theta(const FitDataset& data, const FitSummary& fitted, const VectorXd& errors,
                        Index most) {
  const Index count = errors.size();
  if (count == 0 || !(errors.maxCoeff() > 0.0)) return {};
  std::vector<std::string> names;
  for (const FreeParameter& p : fitted.parameters) names.push_back(p.name);
  MatrixXd covariance = covariance_of(data, fitted, names, errors);
  if (covariance.size() == 0) covariance = errors.cwiseAbs2().asDiagonal();
  const VectorXd scale = errors.unaryExpr([](double e) { return e > 0.0 ? e : 1.0; });
  const MatrixXd relative =
      scale.cwiseInverse().asDiagonal() * covariance * scale.cwiseInverse().asDiagonal();
  const linear_algebra::SingularVectors directions =
      linear_algebra::left_singular_vectors(relative);
  const Index used = std::min(most, count);
  MatrixXd points = fitted.theta.replicate(1, used);
  for (Index k = 0; k < used; ++k) {
    points.col(k) += scale.asDiagonal() * directions.vectors.col(k) *
                     std::sqrt(std::max(directions.values[k], 0.0));
    for (Index i = 0; i < count; ++i) {
      const FreeParameter& p = fitted.parameters[static_cast<std::size_t>(i)];
      points(i, k) = std::clamp(points(i, k), p.lower, p.upper);
    }
  }
  return points;
}

LawCurve law_curve(const plant_sim::ModelFile& model, const FitDataset& data,
                   std::string_view effect, std::string_view over, const VectorXd& errors,
                   const MatrixXd& covariance) {
  LawCurve curve;
  const plant_sim::formula::Formulas formulas = model.formulas();
  const FormulaView* const formula = formula_named(formulas, effect);
  if (formula == nullptr) return curve;
  const Signal which = variable_of(*formula, over);
  Law law(*formula, values_of(model, effect), which);
  curve.variable = kSignalNames[which];
  curve.quantity = quantity_of(model, formula->place.site);
  const Samples samples = samples_of(model, data, curve.variable);
  if (samples.empty()) {
    curve.x = grid(law.range(which).min, law.range(which).max);
  } else {
    const auto [low, high] = std::minmax_element(samples.begin(), samples.end());
    curve.x = grid(*low, *high);
    curve.share = shares(samples, curve.x);
  }
  Held held{};
  for (std::size_t i = 0; i < held.size(); ++i) {
    held[i] = held_value(model, data, law, static_cast<Signal>(i));
  }
  for (const double x : curve.x) curve.f.push_back(law(x, held));
  for (std::size_t i = 0; i < held.size() && !curve.held; ++i) {
    const auto other = static_cast<Signal>(i);
    if (other == which) continue;
    Held moved = held;
    moved[i] += 0.1 * (law.range(other).max - law.range(other).min);
    for (std::size_t k = 0; k < curve.x.size() && !curve.held; ++k) {
      if (law(curve.x[k], moved) != curve.f[k]) curve.held = {kSignalNames[i], held[i]};
    }
  }
  curve.std_error = errors_of(law.slopes(curve.x, held), errors, covariance);
  return curve;
}

}  // namespace estimator::greybox
