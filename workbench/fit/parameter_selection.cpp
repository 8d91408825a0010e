#include "workbench/fit/parameter_selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "estimator/greybox/parameter_catalogue.h"
#include "estimator/greybox/selection/typical_sizes.h"

namespace workbench::fit {
namespace {

using config::schema::bad_config;
using config::schema::UsageError;
using greybox::CatalogueParameter;
using greybox::FreeParameter;
using greybox::parameter_catalogue;
using greybox::ParameterScale;
using greybox::reject_name;
using greybox::split_names;
using greybox::suggested_names;
using greybox::widen_to_full_range;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::string shown(double value) { return fmt::format("{:.6g}", value); }

/// The effects that a model has without a value, as `add` leaves them.
std::vector<plant_sim::EffectInfo> neutral_effects(const plant_sim::ModelFile& model) {
  const std::vector<FreeParameter> valued = greybox::present_parameters(model);
  std::vector<plant_sim::EffectInfo> found = plant_sim::effects_of(model);
  std::erase_if(found, [&](const plant_sim::EffectInfo& info) {
    const bool present =
        std::any_of(model.effects.begin(), model.effects.end(),
                    [&](const auto& effect) { return effect.present && effect.name == info.name; });
    return !present || std::any_of(valued.begin(), valued.end(), [&](const FreeParameter& p) {
      return p.name.starts_with(info.name + ".");
    });
  });
  return found;
}

class ParameterSelector {
 public:
  ParameterSelector(const plant_sim::ModelFile& model, const ParameterSelection& selection)
      : model_(model), selection_(selection), catalogue_(parameter_catalogue(model)) {
    for (const CatalogueParameter& k : catalogue_) {
      all_.push_back(k.name);
      if (!k.effect.empty()) all_.push_back(k.effect);
    }
    shown_ = suggested_names(model, catalogue_);
  }

  FreeParameters run() {
    pick();
    for (const std::string& text : selection_.priors) prior(text);
    for (const std::string& text : selection_.bounds) bounds(text);
    FreeParameters choice;
    for (const std::size_t i : picked_) choice.parameters.push_back(catalogue_[i].free);
    if (choice.parameters.empty()) throw UsageError("--free, --fix: leave nothing to fit");
    choice.start = greybox::start_of(model_, choice.parameters);
    return choice;
  }

 private:
  /// Indices of a parameter, or of all those of an effect.
  std::vector<std::size_t> find(const std::string& option, const std::string& name) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < catalogue_.size(); ++i) {
      if (catalogue_[i].name == name || catalogue_[i].effect == name) found.push_back(i);
    }
    if (found.empty()) reject_name(option, name, all_, shown_);
    return found;
  }

  void pick() {
    const auto add = [&](std::size_t i) {
      if (std::find(picked_.begin(), picked_.end(), i) == picked_.end()) picked_.push_back(i);
    };
    if (selection_.free.empty()) {
      std::vector<FreeParameter> usual = greybox::plant_parameters(model_);
      for (const auto& p : greybox::present_parameters(model_)) usual.push_back(p);
      for (const plant_sim::EffectInfo& effect : neutral_effects(model_)) {
        for (const auto& p : greybox::effect_parameters(effect, 0)) usual.push_back(p);
      }
      for (const FreeParameter& p : usual) {
        for (const std::size_t i : find("--free", p.name)) add(i);
      }
    }
    for (const std::string& name : split_names(selection_.free)) {
      for (const std::size_t i : find("--free", name)) add(i);
    }
    for (const std::string& name : split_names(selection_.fix)) {
      for (const std::size_t i : find("--fix", name)) {
        picked_.erase(std::remove(picked_.begin(), picked_.end(), i), picked_.end());
      }
    }
  }

  /// The fitted parameter that "name=..." is about, and what stands behind the equals sign.
  CatalogueParameter& subject(const std::string& option, const std::string& text,
                              std::string& value) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
      throw UsageError(option + " " + text + ": lacks an equals sign; allowed: name=" +
                       (option == "--prior" ? "mean+-sd" : "low:high"));
    }
    const std::string name = plant_sim::library_name(text.substr(0, equals));
    value = text.substr(equals + 1);
    std::vector<std::string> fitted;
    for (const std::size_t i : picked_) {
      if (catalogue_[i].name == name) return catalogue_[i];
      fitted.push_back(catalogue_[i].name);
    }
    const auto same = [&](const CatalogueParameter& k) { return k.name == name; };
    if (std::any_of(catalogue_.begin(), catalogue_.end(), same)) {
      throw bad_config(option + " " + name, "is not fitted; name it with --free",
                       config::schema::joined(fitted));
    }
    reject_name(option, name, fitted, fitted);
  }

  void prior(const std::string& text) {
    std::string value;
    CatalogueParameter& known = subject("--prior", text, value);
    if (value == "none") {
      widen_to_full_range(known);
      return;
    }
    std::size_t sign = value.rfind("+-");
    if (sign == std::string::npos) sign = value.find("\xc2\xb1");  // a plus-minus sign
    const double mean = sign == std::string::npos ? std::nan("") : number_in(value.substr(0, sign));
    std::string spread = sign == std::string::npos ? "" : value.substr(sign + 2);
    const bool relative = !spread.empty() && spread.back() == '%';
    if (relative) spread.pop_back();
    const double sd = number_in(spread) * (relative ? 0.01 * std::abs(mean) : 1.0);
    if (!std::isfinite(mean) || !(sd > 0.0)) {
      throw UsageError("--prior " + text +
                       ": is not a prior; allowed: name=mean+-sd with sd above 0 (or "
                       "in %), name=none");
    }
    FreeParameter& p = known.free;
    const bool positive = p.scale != ParameterScale::linear;
    if (mean < known.info.min || mean > known.info.max || (positive && mean <= 0.0)) {
      throw bad_config("--prior " + known.name, "has the mean " + shown(mean) + ", out of range",
                       shown(known.info.min) + " to " + shown(known.info.max));
    }
    widen_to_full_range(known);
    p.prior_mean = p.to_theta(mean);
    p.prior_sd = sd / p.slope(p.prior_mean);
  }

  void bounds(const std::string& text) {
    std::string value;
    CatalogueParameter& known = subject("--bounds", text, value);
    const std::size_t colon = value.find(':');
    const auto end = [&](const std::string& word, double open) {
      return word.empty() ? open : number_in(word);
    };
    const double low =
        colon == std::string::npos ? std::nan("") : end(value.substr(0, colon), known.info.min);
    const double high =
        colon == std::string::npos ? std::nan("") : end(value.substr(colon + 1), known.info.max);
    if (!(low < high)) {
      throw UsageError("--bounds " + text +
                       ": are not bounds; allowed: name=low:high with low below "
                       "high (--fix name holds a value)");
    }
    if (low < known.info.min || high > known.info.max) {
      throw bad_config("--bounds " + known.name, "are wider than the parameter's range",
                       shown(known.info.min) + " to " + shown(known.info.max));
    }
    FreeParameter& p = known.free;
    const double infinite = p.scale == ParameterScale::logarithmic ? -20.0 : kInfinite;
    const double a = low > 0.0 || p.scale == ParameterScale::linear ? p.to_theta(low) : infinite;
    const double b = p.to_theta(high);
    p.lower = std::min(a, b);
    p.upper = std::max(a, b);
  }

  const plant_sim::ModelFile& model_;
  const ParameterSelection& selection_;
  std::vector<CatalogueParameter> catalogue_;
  std::vector<std::string> all_;
  std::vector<std::string> shown_;
  std::vector<std::size_t> picked_;
};

}  // namespace

double number_in(std::string_view text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, failed] = std::from_chars(text.data(), end, value);
  return failed == std::errc() && rest == end && std::isfinite(value) ? value : std::nan("");
}

FreeParameters select_parameters(const plant_sim::ModelFile& model,
                                 const ParameterSelection& selection) {
  return ParameterSelector(model, selection).run();
}

void start_neutral_effects(const plant_sim::ModelFile& model, const greybox::FitDataset& data,
                           FreeParameters& choice) {
  std::vector<plant_sim::EffectInfo> effects = neutral_effects(model);
  greybox::selection::scale_typical_sizes(model, data, effects);
  for (const plant_sim::EffectInfo& effect : effects) {
    for (const plant_sim::ParameterInfo& info : effect.parameters) {
      for (std::size_t i = 0; i < choice.parameters.size(); ++i) {
        const FreeParameter& p = choice.parameters[i];
        if (p.name != effect.name + "." + info.name) continue;
        choice.start[static_cast<Eigen::Index>(i)] =
            std::clamp(p.to_theta(info.typical), p.lower, p.upper);
      }
    }
  }
}

}  // namespace workbench::fit
