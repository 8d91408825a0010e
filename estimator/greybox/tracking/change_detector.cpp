#include "estimator/greybox/tracking/change_detector.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace estimator::greybox::tracking {
namespace {

constexpr double kBack = 2.0;  ///< standard errors

double confidence_of(const ParameterChange& named, double least) {
  const double z = (std::abs(named.deviation) - least) / named.std_error;
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

}  // namespace

ChangeDetector::ChangeDetector(const ParameterSet& set, const Thresholds& thresholds)
    : thresholds_(thresholds), tracks_(set.tracked) {
  for (std::size_t i = 0; i < set.tracked; ++i) tracks_[i].least = least_change(set, i, thresholds);
}

void ChangeDetector::raise(double t_s, Track& track, const ParameterChange& named, bool whole) {
  const double confidence = confidence_of(named, track.least);
  if (track.active < 0) {
    track.active = static_cast<int>(changes_.size());
    changes_.push_back({named, t_s, std::numeric_limits<double>::quiet_NaN(), confidence});
  } else if (whole || !track.whole) {
    DetectedChange& change = changes_[static_cast<std::size_t>(track.active)];
    change.named = named;
    change.confidence = confidence;
  }
  track.whole = whole;
}

const DetectedChange* ChangeDetector::active(std::size_t parameter) const {
  const int at = tracks_[parameter].active;
  return at < 0 ? nullptr : &changes_[static_cast<std::size_t>(at)];
}

void ChangeDetector::forget_cleared() {
  std::vector<DetectedChange> kept;
  for (Track& track : tracks_) {
    if (track.active < 0) continue;
    kept.push_back(changes_[static_cast<std::size_t>(track.active)]);
    track.active = static_cast<int>(kept.size()) - 1;
  }
  changes_.swap(kept);
}

void ChangeDetector::serialize(estimator::StateArchive& archive, const ParameterSet& set) {
  archive.fixed(tracks_);
  auto count = static_cast<std::uint64_t>(changes_.size());
  archive.value(count);
  if (count > set.tracked) archive.fail();
  if (!archive.good()) return;
  changes_.resize(static_cast<std::size_t>(count));
  for (DetectedChange& change : changes_) {
    std::vector<ParameterChange> one{change.named};
    tracking::serialize(archive, one, set);
    if (one.size() != 1) archive.fail();
    if (!archive.good()) return;
    change.named = one.front();
    archive.value(change.raised_s);
    archive.value(change.cleared_s);
    archive.value(change.confidence);
  }
  for (const Track& track : tracks_) {
    if (track.active >= static_cast<int>(changes_.size())) archive.fail();
  }
}

void ChangeDetector::update(double t_s, const std::vector<ParameterChange>& named,
                            const std::vector<TrackedValue>& seen, const Eigen::VectorXd& baseline,
                            bool whole) {
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    Track& track = tracks_[i];
    const auto found = std::find_if(named.begin(), named.end(),
                                    [&](const ParameterChange& one) { return one.parameter == i; });
    if (found != named.end()) {
      const int direction = found->deviation > 0.0 ? 1 : -1;
      if (track.active >= 0) {
        DetectedChange& change = changes_[static_cast<std::size_t>(track.active)];
        if ((change.named.deviation > 0.0 ? 1 : -1) != direction) {
          change.cleared_s = t_s;
          track = {track.least, 0, -1, false};
        }
      }
      const bool sure = std::abs(found->deviation) > thresholds_.at_once * found->std_error;
      if (track.active >= 0 || sure || track.direction == direction) {
        raise(t_s, track, *found, whole);
      }
      track.direction = direction;
      continue;
    }
    track.direction = 0;
    const double off = std::abs(seen[i].theta - baseline[static_cast<Eigen::Index>(i)]);
    // Another change may hide this one: without a named change the return is certain.
    const double least =
        track.active < 0
            ? track.least
            : std::max(
                  track.least,
                  thresholds_.back_share *
                      std::abs(changes_[static_cast<std::size_t>(track.active)].named.deviation));
    const bool back = named.empty() || off < least;
    if (track.active >= 0 && back && off + kBack * seen[i].std_error < least) {
      changes_[static_cast<std::size_t>(track.active)].cleared_s = t_s;
      track = {track.least, 0, -1, false};
    }
  }
}

}  // namespace estimator::greybox::tracking
