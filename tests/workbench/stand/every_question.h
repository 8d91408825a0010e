// Stands that between them are asked every question of `spoolwatch new stand`.
#pragma once

#include <vector>

#include "tests/workbench/stand/stand_command.h"
#include "workbench/stand/answers.h"

namespace workbench_test {

namespace questions = workbench::questions;
using questions::Question;

inline std::vector<Flags> full_stands() {
  Flags tcp = pressure_flags("modbus");
  tcp.insert({{"watchdog-register", "10"}, {"e-stop-register", "20"}, {"enable-register", "21"}});
  tcp["supply-register"] = "30";
  tcp["pressure-in-register"] = "32";
  tcp["pressure-out-register"] = "34";
  Flags rtu = least_flags("modbus");
  rtu.erase("address");
  rtu.insert({{"bus", "rtu"}, {"serial", "/dev/no_such_line"}});
  rtu["watchdog-ms"] = "0";
  rtu["accept-no-watchdog"] = "yes";
  Flags watched = least_flags("modbus");
  watched.erase("watchdog-ms");
  watched["valve"] = "watched";
  Flags board = pressure_flags("comedi");
  board.insert({{"line-index", "4"}, {"e-stop-line", "6"}, {"enable-line", "7"}});
  Flags alone = least_flags("comedi");
  alone["permit-line"] = "-1";
  alone["accept-no-watchdog"] = "yes";
  Flags looking = least_flags("comedi");
  looking.erase("permit-line");
  looking.insert({{"valve", "watched"}, {"command-channel", "1"}});
  return {pressure_flags("sim"), tcp, rtu, watched, board, alone, looking};
}

/// The questions that these answers lead to.
inline std::vector<Question> asked_with(const Flags& flags) {
  std::vector<Question> asked;
  const workbench::stand::Answers answers = workbench::stand::answers_of(flags, nullptr, nullptr);
  for (const workbench::stand::StandQuestion& one : workbench::stand::stand_questions()) {
    if (!one.when || one.when(answers)) asked.push_back(one.question);
  }
  return asked;
}

}  // namespace workbench_test
