#include "estimator/greybox/tracking/baseline_drift.h"

#include <algorithm>
#include <cmath>

#include "config/schema/error.h"
#include "config/signals/nan.h"

namespace estimator::greybox::tracking {
namespace {

using Eigen::Index;

using config::signals::kNaN;
constexpr double kHour_s = 3600.0;
/// Share of the distance at which the end counts as reached, despite rounding.
constexpr double kEnd = 1.0 - 1e-9;

std::size_t followed_index(const ParameterSet& set, const std::string& name,
                           const std::string& where) {
  std::string names;
  for (std::size_t i = 0; i < set.tracked; ++i) {
    if (set.parameters[i].name == name) return i;
    names += (i == 0 ? "" : ", ") + set.parameters[i].name;
  }
  throw config::schema::bad_config(where, "names " + name + ", which is not tracked", names);
}

}  // namespace

BaselineDrift::BaselineDrift(const ParameterSet& set, const DriftSettings& following,
                             const std::string& where)
    : rate_per_s_(following.ratio_per_h / kHour_s) {
  const double most = following.most_ratio;
  for (const std::string& name : following.parameters) {
    const std::size_t index = followed_index(set, name, where);
    const auto same = [index](const Followed& one) { return one.index == index; };
    if (std::any_of(followed_.begin(), followed_.end(), same)) continue;
    const bool ratio = set.parameters[index].scale == ParameterScale::logarithmic;
    const double below = ratio ? -std::log(std::max(0.0, 1.0 - most)) : most;
    const double above = ratio ? std::log1p(most) : most;
    followed_.push_back({index, set.file[static_cast<Index>(index)], below, above, kNaN});
  }
}

void BaselineDrift::take(const Eigen::VectorXd& learnt) {
  for (Followed& one : followed_) {
    one.learnt = learnt[static_cast<Index>(one.index)];
    one.told_s = kNaN;
  }
}

void BaselineDrift::follow(const WindowResult& window, bool explained,
                           const ChangeDetector& detector, Eigen::VectorXd& baseline) {
  for (Followed& one : followed_) {
    const ParameterEstimate& found = window.estimates[one.index];
    const auto its = [&](const ParameterChange& named) { return named.parameter == one.index; };
    const bool named = std::any_of(window.named.begin(), window.named.end(), its);
    const bool quiet = explained && !named && detector.active(one.index) == nullptr;
    if (quiet && !found.valid) continue;
    const double since_s = std::isfinite(one.told_s) ? window.t_s - one.told_s : 0.0;
    one.told_s = window.t_s;
    if (!quiet) continue;
    double& at = baseline[static_cast<Index>(one.index)];
    const double most = rate_per_s_ * since_s;
    at += std::clamp(kGain * (found.theta - at), -most, most);
    at = std::clamp(at, one.learnt - one.below, one.learnt + one.above);
  }
}

int BaselineDrift::at_end(std::size_t number, const Eigen::VectorXd& baseline) const {
  const Followed& one = followed_[number];
  const double off = baseline[static_cast<Index>(one.index)] - one.learnt;
  if (off <= -kEnd * one.below) return -1;
  return off >= kEnd * one.above ? 1 : 0;
}

void BaselineDrift::serialize(estimator::StateArchive& archive) { archive.fixed(followed_); }

}  // namespace estimator::greybox::tracking
