// Where people's acts on alarms reach the book: commands come from the main thread through a
// bounded queue, the detector carries them out between two samples, and an answer goes back the
// same way.
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
  double time_s = 0.0;  ///< of kind shelve
  std::uint32_t number = 0;
};

struct AlarmAnswer {
  struct Listed {
    estimator::fdi::Alarm alarm;
    double shelved_for_s = 0.0;  ///< still
  };
  std::uint32_t number = 0;       ///< of the command
  std::string reject_reason;      ///< empty: done
  std::vector<std::string> done;  ///< SOURCE.NAME of each alarm that changed
  std::vector<Listed> alarms;     ///< of kind list: all of them
};

using AlarmCommandQueue = boost::lockfree::spsc_queue<AlarmCommand, boost::lockfree::capacity<16>>;
using AlarmAnswerQueue =
    boost::lockfree::spsc_queue<std::shared_ptr<const AlarmAnswer>, boost::lockfree::capacity<16>>;

/// The detector's end. Nothing here waits.
class AlarmCommandServer {
 public:
  /// `commands` and `answers` may be null: then there are none.
  AlarmCommandServer(AlarmCommandQueue* commands, AlarmAnswerQueue* answers) noexcept
      : commands_(commands), answers_(answers) {}

  /// Carries out what is queued; `changed` for each alarm whose state changed.
  void serve(estimator::fdi::AlarmBook& book,
             const std::function<void(const estimator::fdi::Alarm&)>& changed);

 private:
  AlarmCommandQueue* commands_;
  AlarmAnswerQueue* answers_;
};

}  // namespace monitor::detection
