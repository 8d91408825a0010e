#include "workbench/fit/choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "estimator/greybox/parameter_catalogue.h"

namespace workbench::fit {

namespace greybox = estimator::greybox;
namespace {

using config::schema::bad_config;
using config::schema::UsageError;
using greybox::Known;
using greybox::known_parameters;
using greybox::names_worth_showing;
using greybox::open_up;
using greybox::refuse_name;
using greybox::Scale;
using greybox::SearchParameter;
using greybox::split_names;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::string shown(double value) { return fmt::format("{:.6g}", value); }

class Chooser {
 public:
  Chooser(const plant_sim::ModelFile& model, const Wishes& wishes)
      : model_(model), wishes_(wishes), known_(known_parameters(model)) {
    for (const Known& k : known_) {
      all_.push_back(k.name);
      if (!k.effect.empty()) all_.push_back(k.effect);
    }
    shown_ = names_worth_showing(model, known_);
  }

  Choice run() {
    pick();
    for (const std::string& text : wishes_.priors) prior(text);
    for (const std::string& text : wishes_.bounds) bounds(text);
    Choice choice;
    for (const std::size_t i : picked_) choice.searched.push_back(known_[i].search);
    if (choice.searched.empty()) {
      throw UsageError("--free, --fix: leave nothing to fit");
    }
    choice.start = greybox::start_of(model_, choice.searched);
    return choice;
  }

 private:
  /// Indices of a parameter, or of all those of an effect.
  std::vector<std::size_t> find(const std::string& option, const std::string& name) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < known_.size(); ++i) {
      if (known_[i].name == name || known_[i].effect == name) found.push_back(i);
    }
    if (found.empty()) refuse_name(option, name, all_, shown_);
    return found;
  }

  void pick() {
    const auto add = [&](std::size_t i) {
      if (std::find(picked_.begin(), picked_.end(), i) == picked_.end()) picked_.push_back(i);
    };
    if (wishes_.free.empty()) {
      std::vector<SearchParameter> usual = greybox::plant_parameters(model_);
      for (const auto& p : greybox::present_parameters(model_)) usual.push_back(p);
      for (const SearchParameter& p : usual) {
        for (const std::size_t i : find("--free", p.name)) add(i);
      }
    }
    for (const std::string& name : split_names(wishes_.free)) {
      for (const std::size_t i : find("--free", name)) add(i);
    }
    for (const std::string& name : split_names(wishes_.fix)) {
      for (const std::size_t i : find("--fix", name)) {
        picked_.erase(std::remove(picked_.begin(), picked_.end(), i), picked_.end());
      }
    }
  }

  /// The fitted parameter that "name=..." is about, and what stands behind the equals sign.
  Known& subject(const std::string& option, const std::string& text, std::string& value) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
      throw UsageError(option + " " + text + ": lacks an equals sign; allowed: name=" +
                       (option == "--prior" ? "mean+-sd" : "low:high"));
    }
    const std::string name = text.substr(0, equals);
    value = text.substr(equals + 1);
    std::vector<std::string> fitted;
    for (const std::size_t i : picked_) {
      if (known_[i].name == name) return known_[i];
      fitted.push_back(known_[i].name);
    }
    const auto same = [&](const Known& k) { return k.name == name; };
    if (std::any_of(known_.begin(), known_.end(), same)) {
      throw bad_config(option + " " + name, "is not fitted; name it with --free",
                       config::schema::joined(fitted));
    }
    refuse_name(option, name, fitted, fitted);
  }

  void prior(const std::string& text) {
    std::string value;
    Known& known = subject("--prior", text, value);
    if (value == "none") {
      open_up(known);
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
                       ": is no prior; allowed: name=mean+-sd with sd above 0 (or "
                       "in %), name=none");
    }
    SearchParameter& p = known.search;
    const bool positive = p.scale != Scale::linear;
    if (mean < known.info.min || mean > known.info.max || (positive && mean <= 0.0)) {
      throw bad_config("--prior " + known.name, "has the mean " + shown(mean) + ", out of range",
                       shown(known.info.min) + " to " + shown(known.info.max));
    }
    open_up(known);
    p.prior_mean = p.search(mean);
    p.prior_sd = sd / p.slope(p.prior_mean);
  }

  void bounds(const std::string& text) {
    std::string value;
    Known& known = subject("--bounds", text, value);
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
                       ": are no bounds; allowed: name=low:high with low below "
                       "high (--fix name holds a value)");
    }
    if (low < known.info.min || high > known.info.max) {
      throw bad_config("--bounds " + known.name, "are wider than the parameter's range",
                       shown(known.info.min) + " to " + shown(known.info.max));
    }
    SearchParameter& p = known.search;
    const double infinite = p.scale == Scale::logarithmic ? -20.0 : kInfinite;
    const double a = low > 0.0 || p.scale == Scale::linear ? p.search(low) : infinite;
    const double b = p.search(high);
    p.lower = std::min(a, b);
    p.upper = std::max(a, b);
  }

  const plant_sim::ModelFile& model_;
  const Wishes& wishes_;
  std::vector<Known> known_;
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

Choice choose(const plant_sim::ModelFile& model, const Wishes& wishes) {
  return Chooser(model, wishes).run();
}

}  // namespace workbench::fit
