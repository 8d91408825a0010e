#include "estimator/greybox/free_parameter.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace estimator::greybox {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// Range of an effect's parameter, in typical sizes.
constexpr double kLargest = 200.0;

}  // namespace

double FreeParameter::to_physical(double theta) const {
  switch (scale) {
    case ParameterScale::logarithmic:
      return unit * std::exp(theta);
    case ParameterScale::reciprocal:
      return theta > 0.0 ? unit / theta : kInfinite;
    case ParameterScale::square:
      return unit * std::sqrt(std::max(theta, 0.0));
    case ParameterScale::linear:
      break;
  }
  return origin + unit * theta;
}

double FreeParameter::to_theta(double value) const {
  switch (scale) {
    case ParameterScale::logarithmic:
      return std::log(value / unit);
    case ParameterScale::reciprocal:
      return unit / value;
    case ParameterScale::square:
      return value * value / (unit * unit);
    case ParameterScale::linear:
      break;
  }
  return (value - origin) / unit;
}

double FreeParameter::slope(double theta) const {
  switch (scale) {
    case ParameterScale::logarithmic:
      return unit * std::exp(theta);
    case ParameterScale::reciprocal:
      return unit / (theta * theta);
    case ParameterScale::square:
      return unit / (2.0 * std::sqrt(theta));
    case ParameterScale::linear:
      break;
  }
  return std::abs(unit);
}

std::vector<FreeParameter> plant_parameters(const plant_sim::ModelFile& model) {
  std::vector<FreeParameter> found;
  const plant_sim::PlantInfo& plant = *plant_sim::find_plant(model.plant);
  for (std::size_t i = 0; i < plant.parameters.size(); ++i) {
    const plant_sim::ParameterInfo& info = plant.parameters[i];
    const double value = model.parameters[i].value;
    const double sd = model.uncertainty_ratio(i);
    if (sd <= 0.0 || value <= 0.0) continue;
    const double least = info.min > 0.0 ? std::log(info.min / value) : -kInfinite;
    found.push_back({info.name, ParameterScale::logarithmic, value,
                     std::max(least, -kPriorRange_sds * sd),
                     std::min(std::log(info.max / value), kPriorRange_sds * sd), 0.0, sd});
  }
  return found;
}

std::vector<FreeParameter> effect_parameters(const plant_sim::EffectInfo& effect, int refinement) {
  std::vector<FreeParameter> found;
  for (const plant_sim::ParameterInfo& info : effect.parameters) {
    if (info.refinement > refinement) continue;
    FreeParameter p;
    p.name = effect.name + "." + info.name;
    p.unit = info.typical;
    p.prior_sd = kInfinite;
    p.refinement = info.refinement;
    p.instead_of = info.instead_of;
    if (std::isinf(info.neutral)) {
      p.scale = ParameterScale::reciprocal;
      p.lower = 0.0;
      p.upper = info.min > 0.0 ? std::min(info.typical / info.min, kLargest) : kLargest;
    } else {
      if (info.order == 2) p.scale = ParameterScale::square;
      const double largest = info.order == 2 ? kLargest * kLargest : kLargest;
      p.lower = std::max(p.to_theta(info.min), -largest);
      p.upper = std::min(p.to_theta(info.max), largest);
    }
    found.push_back(p);
  }
  return found;
}

bool is_given(const plant_sim::ModelFile& model, const std::string& effect,
              const plant_sim::ParameterInfo& info) {
  for (const plant_sim::ModelFile::Effect& one : model.effects) {
    if (!one.present || one.name != effect) continue;
    for (const plant_sim::NamedValue& p : one.parameters) {
      if (p.name == info.name) return p.value != info.neutral;
    }
  }
  return false;
}

std::vector<FreeParameter> present_parameters(const plant_sim::ModelFile& model) {
  std::vector<FreeParameter> found;
  for (const plant_sim::EffectInfo& info : plant_sim::effects_of(model)) {
    const std::vector<FreeParameter> all = effect_parameters(info, kEveryRefinement);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!is_given(model, info.name, info.parameters[i])) continue;
      found.push_back(all[i]);
      found.back().in_model = true;
    }
  }
  return found;
}

Eigen::VectorXd start_of(const plant_sim::ModelFile& model,
                         const std::vector<FreeParameter>& parameters) {
  plant_sim::ModelFile copy = model;
  Eigen::VectorXd theta(static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double* value = copy.value(parameters[i].name);
    const double start = value == nullptr ? 0.0 : parameters[i].to_theta(*value);
    theta[static_cast<Eigen::Index>(i)] =
        std::clamp(start, parameters[i].lower, parameters[i].upper);
  }
  return theta;
}

}  // namespace estimator::greybox
