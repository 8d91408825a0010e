#include "estimator/greybox/tracking/change_detector.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace estimator::greybox::tracking {
namespace {

constexpr double kBack = 2.0;  ///< standard errors

double confidence_of(const Named& named, double least) {
  const double z = (std::abs(named.deviation) - least) / named.std_error;
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

}  // namespace

AlarmBook::AlarmBook(const Choice& choice, const Thresholds& thresholds)
    : thresholds_(thresholds), tracks_(choice.tracked) {
  for (std::size_t i = 0; i < choice.tracked; ++i) {
    tracks_[i].least = least_of(choice, i, thresholds);
  }
}

void AlarmBook::raise(double t_s, Track& track, const Named& named, bool whole) {
  const double confidence = confidence_of(named, track.least);
  if (track.active < 0) {
    track.active = static_cast<int>(alarms_.size());
    alarms_.push_back({named, t_s, std::numeric_limits<double>::quiet_NaN(), confidence});
  } else if (whole || !track.whole) {
    Alarm& alarm = alarms_[static_cast<std::size_t>(track.active)];
    alarm.named = named;
    alarm.confidence = confidence;
  }
  track.whole = whole;
}

const Alarm* AlarmBook::active(std::size_t parameter) const {
  const int at = tracks_[parameter].active;
  return at < 0 ? nullptr : &alarms_[static_cast<std::size_t>(at)];
}

void AlarmBook::forget_cleared() {
  std::vector<Alarm> kept;
  for (Track& track : tracks_) {
    if (track.active < 0) continue;
    kept.push_back(alarms_[static_cast<std::size_t>(track.active)]);
    track.active = static_cast<int>(kept.size()) - 1;
  }
  alarms_.swap(kept);
}

void AlarmBook::serialize(estimator::StateArchive& archive, const Choice& choice) {
  archive.fixed(tracks_);
  auto count = static_cast<std::uint64_t>(alarms_.size());
  archive.value(count);
  if (count > choice.tracked) archive.fail();
  if (!archive.good()) return;
  alarms_.resize(static_cast<std::size_t>(count));
  for (Alarm& alarm : alarms_) {
    std::vector<Named> one{alarm.named};
    tracking::serialize(archive, one, choice);
    if (one.size() != 1) archive.fail();
    if (!archive.good()) return;
    alarm.named = one.front();
    archive.value(alarm.raised_s);
    archive.value(alarm.cleared_s);
    archive.value(alarm.confidence);
  }
  for (const Track& track : tracks_) {
    if (track.active >= static_cast<int>(alarms_.size())) archive.fail();
  }
}

void AlarmBook::update(double t_s, const std::vector<Named>& named, const std::vector<Seen>& seen,
                       const Eigen::VectorXd& healthy, bool whole) {
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    Track& track = tracks_[i];
    const auto found = std::find_if(named.begin(), named.end(),
                                    [&](const Named& one) { return one.parameter == i; });
    if (found != named.end()) {
      const int direction = found->deviation > 0.0 ? 1 : -1;
      if (track.active >= 0) {
        Alarm& alarm = alarms_[static_cast<std::size_t>(track.active)];
        if ((alarm.named.deviation > 0.0 ? 1 : -1) != direction) {
          alarm.cleared_s = t_s;
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
    const double off = std::abs(seen[i].x - healthy[static_cast<Eigen::Index>(i)]);
    // The change of another cause may show here: then nothing is known of this one.
    const bool back = named.empty() || off < track.least;
    if (track.active >= 0 && back && off + kBack * seen[i].std_error < track.least) {
      alarms_[static_cast<std::size_t>(track.active)].cleared_s = t_s;
      track = {track.least, 0, -1, false};
    }
  }
}

}  // namespace estimator::greybox::tracking
