#include "tracking/naming.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tracking {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

class Namer {
 public:
  Namer(WindowFit& fit, const Choice& choice, const Cut& cut, const WindowEstimate& found,
        const VectorXd& healthy, double sigma_m)
      : fit_(fit),
        choice_(choice),
        cut_(cut),
        found_(found),
        healthy_(healthy),
        // The window's own noise: what is beyond it is not chance.
        sigma_m_(std::min(sigma_m, found.rms_m)),
        chi_square_(found.chi_square * sigma_m * sigma_m / (sigma_m_ * sigma_m_)) {}

  std::vector<Named> run(const Thresholds& thresholds) {
    std::vector<Named> named;
    for (std::size_t i = 0; i < choice_.tracked; ++i) {
      const auto at = static_cast<Index>(i);
      Named one{i, found_.x[at], found_.std_error[at], found_.x[at] - healthy_[at], {}};
      const double needed =
          std::max(least_of(choice_.parameters[i], thresholds), thresholds.sure * one.std_error);
      if (std::abs(one.deviation) >= needed) named.push_back(one);
    }
    if (named.size() > 1 && one_cause(named)) return named;
    for (Named& one : named) find_rivals(one, others_of(named));
    return named;
  }

 private:
  std::string name(std::size_t i) const { return choice_.parameters[i].name; }
  double value(std::size_t i, const VectorXd& x) const {
    return choice_.parameters[i].value(x[static_cast<Index>(i)]);
  }

  bool one_cause(std::vector<Named>& named) {
    std::vector<Rival> causes;
    for (std::size_t a = choice_.tracked; a < choice_.parameters.size(); ++a) {
      const WindowEstimate alone = fit_.fit(cut_, {a}, healthy_, sigma_m_);
      if (alone.chi_square < chi_square_ + kChance) causes.push_back({name(a), value(a, alone.x)});
    }
    if (causes.empty()) return false;
    std::size_t best = 0;
    double least = INFINITY;
    for (std::size_t i = 0; i < named.size(); ++i) {
      const auto one = fit_.fit(cut_, {named[i].parameter}, healthy_, sigma_m_);
      if (one.chi_square >= least) continue;
      least = one.chi_square;
      best = i;
    }
    named = {named[best]};
    named.front().rivals = causes;
    return true;
  }

  /// What has changed as it was found, all else healthy.
  VectorXd others_of(const std::vector<Named>& named) const {
    VectorXd x = healthy_;
    for (const Named& one : named) x[static_cast<Index>(one.parameter)] = one.x;
    return x;
  }

  void find_rivals(Named& one, VectorXd without) {
    const auto at = static_cast<Index>(one.parameter);
    without[at] = healthy_[at];
    const double effect = fit_.fit(cut_, {}, without, sigma_m_).chi_square - chi_square_;
    for (std::size_t a = choice_.tracked; a < choice_.parameters.size(); ++a) {
      const WindowEstimate instead = fit_.fit(cut_, {a}, without, sigma_m_);
      const double left = instead.chi_square - chi_square_;
      if (left > std::max(kChance, kLeft * effect)) continue;
      const WindowEstimate best = let_follow(a, one.parameter, instead.x);
      if (best.rms_m > kAsGood * found_.rms_m) continue;
      one.rivals.push_back({name(a), value(a, best.x)});
    }
  }

  WindowEstimate let_follow(std::size_t rival, std::size_t instead_of, const VectorXd& from) {
    VectorXd prior_sd = choice_.uncertainty;
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < choice_.parameters.size(); ++i) {
      const auto at = static_cast<Index>(i);
      const bool open = i == rival || i < choice_.tracked;
      if (open) prior_sd[at] = std::numeric_limits<double>::infinity();
      if (i != instead_of && (open || prior_sd[at] <= kMostUncertain_ratio)) free.push_back(i);
    }
    return fit_.fit(cut_, free, from, sigma_m_, prior_sd);
  }

  WindowFit& fit_;
  const Choice& choice_;
  const Cut& cut_;
  const WindowEstimate& found_;
  const VectorXd& healthy_;
  double sigma_m_;
  double chi_square_;
};

}  // namespace

double least_of(const SearchParameter& parameter, const Thresholds& thresholds) {
  return parameter.scale == Scale::logarithmic ? std::log1p(thresholds.least_ratio)
                                               : kLeastOfTypical;
}

std::vector<Named> name_changes(WindowFit& fit, const Choice& choice, const Cut& cut,
                                const WindowEstimate& found, const VectorXd& healthy,
                                double sigma_m, const Thresholds& thresholds) {
  return Namer(fit, choice, cut, found, healthy, sigma_m).run(thresholds);
}

}  // namespace tracking
