// Operator commands on alarms: the main thread queues them, the detector executes them between two
// samples and queues the answer. Both queues are bounded.
#pragma once

#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "estimator/fdi/alarm_book.h"

namespace monitor::detection {

struct AlarmCommand {
  enum class Kind : std::uint8_t { list, acknowledge, acknowledge_all, shelve, unshelve };
  Kind kind = Kind::list;
  std::string alarm;  ///< SOURCE.NAME, or the name alone when it is unique
  std::string who;
  double time_s = 0.0;  ///< kind shelve: duration
  std::uint32_t number = 0;
};

struct AlarmAnswer {
  struct Listed {
    estimator::fdi::Alarm alarm;
    double shelved_for_s = 0.0;  ///< remaining
  };
  std::uint32_t number = 0;       ///< that of the command
  std::string reject_reason;      ///< empty: executed
  std::vector<std::string> done;  ///< SOURCE.NAME of each alarm that changed
  std::vector<Listed> alarms;     ///< kind list: all alarms
};

using AlarmCommandQueue = boost::lockfree::spsc_queue<AlarmCommand, boost::lockfree::capacity<16>>;
using AlarmAnswerQueue =
    boost::lockfree::spsc_queue<std::shared_ptr<const AlarmAnswer>, boost::lockfree::capacity<16>>;

/// The detector's end of the queues. Never blocks.
class AlarmCommandServer {
 public:
  /// `commands` and `answers` may both be null.
  AlarmCommandServer(AlarmCommandQueue* commands, AlarmAnswerQueue* answers) noexcept
      : commands_(commands), answers_(answers) {}

  /// Executes all queued commands; calls `changed` for each alarm whose state changed.
  void serve(estimator::fdi::AlarmBook& book,
             const std::function<void(const estimator::fdi::Alarm&)>& changed);

 private:
  AlarmCommandQueue* commands_;
  AlarmAnswerQueue* answers_;
};

}  // namespace monitor::detection
