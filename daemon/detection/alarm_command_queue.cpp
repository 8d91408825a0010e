#include "daemon/detection/alarm_command_queue.h"

namespace monitor::detection {

using estimator::fdi::Alarm;
using estimator::fdi::AlarmActionResult;
using estimator::fdi::AlarmBook;

namespace {

using Changed = std::function<void(const Alarm&)>;

std::string id_of(const Alarm& alarm) { return alarm.source + "." + alarm.name; }

void execute_one(const AlarmCommand& command, AlarmBook& book, const Changed& changed,
                 AlarmAnswer& answer) {
  const std::size_t number = book.find(command.alarm);
  if (number == AlarmBook::kNone) {
    answer.reject_reason =
        "no alarm \"" + command.alarm +
        "\", or the name is ambiguous; allowed: SOURCE.NAME as listed by `spoolwatch alarms`";
    return;
  }
  const AlarmActionResult outcome = command.kind == AlarmCommand::Kind::acknowledge
                                        ? book.acknowledge(number, command.who)
                                    : command.kind == AlarmCommand::Kind::shelve
                                        ? book.shelve(number, command.time_s, command.who)
                                        : book.unshelve(number);
  if (outcome.changed == nullptr) {
    answer.reject_reason = id_of(book.alarm(number)) + ": " + outcome.refusal;
    return;
  }
  answer.done.push_back(id_of(*outcome.changed));
  changed(*outcome.changed);
}

void acknowledge_all(const AlarmCommand& command, AlarmBook& book, const Changed& changed,
                     AlarmAnswer& answer) {
  for (std::size_t i = 0; i < book.alarms().size(); ++i) {
    const AlarmActionResult outcome = book.acknowledge(i, command.who);
    if (outcome.changed == nullptr) continue;
    answer.done.push_back(id_of(*outcome.changed));
    changed(*outcome.changed);
  }
}

}  // namespace

void AlarmCommandServer::serve(AlarmBook& book, const Changed& changed) {
  if (commands_ == nullptr) return;
  AlarmCommand command;
  while (commands_->pop(command)) {
    auto answer = std::make_shared<AlarmAnswer>();
    answer->number = command.number;
    switch (command.kind) {
      case AlarmCommand::Kind::list:
        for (const Alarm& alarm : book.alarms()) {
          answer->alarms.push_back({alarm, book.shelved_for_s(alarm)});
        }
        break;
      case AlarmCommand::Kind::acknowledge_all:
        acknowledge_all(command, book, changed, *answer);
        break;
      default:
        execute_one(command, book, changed, *answer);
    }
    answers_->push(std::move(answer));
  }
}

}  // namespace monitor::detection
