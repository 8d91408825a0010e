// Publishes samples, estimates, alarms and health over LCM and passes the same bytes to the
// recorder.
//
// Channels PREFIX_SAMPLE, PREFIX_RODS, PREFIX_PRESSURES, PREFIX_ESTIMATE, PREFIX_ALARM,
// PREFIX_HEALTH (types: config/messages).
// Each message is encoded once into a preallocated buffer. A message that LCM cannot send is still
// recorded; status() reports the number of failures. One thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "config/messages/channels.h"
#include "config/schema/visitor.h"

namespace lcm {
class LCM;
}
namespace spoolwatch {
class health_t;
}
namespace config::signals {
struct Sample;
}
namespace estimator::fdi {
struct Alarm;
struct EstimateEvent;
}  // namespace estimator::fdi

namespace monitor::io {

class Evidence;
class Recorder;

struct PublisherConfig {
  std::string url = config::messages::kDefaultUrl;  // "" sends nothing (records only)
  std::string prefix = config::messages::kDefaultPrefix;

  /// Fields of the table [lcm].
  void visit(config::schema::Visitor& v);
};

/// Creation time of a message: wall clock and monotonic clock (both virtual in virtual time).
struct Stamp {
  std::int64_t utc_us = 0;
  std::int64_t mono_ns = 0;
};

struct PublisherStatus {
  std::int64_t sent = 0;
  std::int64_t send_failures = 0;
};

class Publisher {
 public:
  /// `recorder` may be null. Throws config::schema::Error when LCM cannot be started on `url`.
  Publisher(const PublisherConfig& config, std::int64_t run_id, double sample_time_s,
            Recorder* recorder);
  ~Publisher();
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  /// Passes every message to `evidence` too, which must outlive the publisher.
  void attach(Evidence& evidence) noexcept { evidence_ = &evidence; }

  /// Ids of the rod sensors, the configured one first.
  void name_rods(std::vector<std::string> rods);

  /// Enables pressures_t: the rig measures at least one of the pressures.
  void enable_pressures() noexcept { tells_pressures_ = true; }

  /// A sample carries its own stamp (utc_us, t_read_ns). rods_t and pressures_t are published
  /// first.
  void sample(const config::signals::Sample& sample);
  void estimate(const estimator::fdi::EstimateEvent& event, Stamp stamp);
  /// `repeat`: the alarm is active and unchanged.
  void alarm(const estimator::fdi::Alarm& alarm, bool repeat, Stamp stamp);
  /// Fills in run_id, seq and stamp; the caller fills in the rest.
  void health(spoolwatch::health_t& message, Stamp stamp);

  /// Any thread.
  [[nodiscard]] PublisherStatus status() const noexcept;

 private:
  struct Channel {
    std::string name;
    std::int64_t seq = 0;
  };
  template <class Message>
  void send(Channel& channel, Message& message, Stamp stamp);

  struct Messages;  // one message of each type, reused

  std::unique_ptr<lcm::LCM> lcm_;
  std::unique_ptr<Messages> messages_;
  Recorder* recorder_;
  Evidence* evidence_ = nullptr;
  std::int64_t run_id_;
  double sample_time_s_;
  Channel sample_, rods_, pressures_, estimate_, alarm_, health_;
  bool tells_pressures_ = false;
  std::vector<std::uint8_t> buffer_;
  std::atomic<std::int64_t> sent_{0};
  std::atomic<std::int64_t> failures_{0};
};

}  // namespace monitor::io
