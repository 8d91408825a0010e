#include "daemon/detection/alarm_command_queue.h"

namespace monitor::detection {

using estimator::fdi::Alarm;
using estimator::fdi::AlarmActionResult;
using estimator::fdi::AlarmBook;

namespace {

using Changed = std::function<void(const Alarm&)>;

std::string id_of(const Alarm& alarm) { return alarm.source + "." + alarm.name; }

void act_on_one(const AlarmOrder& order, AlarmBook& book, const Changed& changed,
                AlarmAnswer& answer) {
  const std::size_t number = book.find(order.alarm);
  if (number == AlarmBook::kNone) {
    answer.refusal = "there is no alarm \"" + order.alarm +
                     "\", or more than one; allowed: SOURCE.NAME as `spoolwatch alarms` lists it";
    return;
  }
  const AlarmActionResult outcome =
      order.kind == AlarmOrder::Kind::acknowledge ? book.acknowledge(number, order.who)
      : order.kind == AlarmOrder::Kind::shelve    ? book.shelve(number, order.time_s, order.who)
                                                  : book.unshelve(number);
  if (outcome.changed == nullptr) {
    answer.refusal = id_of(book.alarm(number)) + ": " + outcome.refusal;
    return;
  }
  answer.done.push_back(id_of(*outcome.changed));
  changed(*outcome.changed);
}

void acknowledge_all(const AlarmOrder& order, AlarmBook& book, const Changed& changed,
                     AlarmAnswer& answer) {
  for (std::size_t i = 0; i < book.alarms().size(); ++i) {
    const AlarmActionResult outcome = book.acknowledge(i, order.who);
    if (outcome.changed == nullptr) continue;
    answer.done.push_back(id_of(*outcome.changed));
    changed(*outcome.changed);
  }
}

}  // namespace

void AlarmDesk::serve(AlarmBook& book, const Changed& changed) {
  if (orders_ == nullptr) return;
  AlarmOrder order;
  while (orders_->pop(order)) {
    auto answer = std::make_shared<AlarmAnswer>();
    answer->number = order.number;
    switch (order.kind) {
      case AlarmOrder::Kind::list:
        for (const Alarm& alarm : book.alarms()) {
          answer->alarms.push_back({alarm, book.shelved_for_s(alarm)});
        }
        break;
      case AlarmOrder::Kind::acknowledge_all:
        acknowledge_all(order, book, changed, *answer);
        break;
      default:
        act_on_one(order, book, changed, *answer);
    }
    answers_->push(std::move(answer));
  }
}

}  // namespace monitor::detection
