// Questions of a stand with a quadrature encoder and switches on GPIO lines, and the valve and
// pressures on a comedi board.
#include "workbench/stand/answers.h"

namespace workbench::stand {
namespace {

using questions::kMust;
using When = std::function<bool(const Answers&)>;

constexpr const char* kEncoder = "Encoder and lines";
constexpr const char* kBoard = "Comedi board";
constexpr const char* kLines = "wiring plan; `gpioinfo` lists the lines";
constexpr const char* kBoardInfo = "wiring plan; `comedi_board_info` lists subdevices and ranges";
constexpr double kLast = 65535.0;

bool on_board(const Answers& a) { return a.comedi(); }
bool board_drives(const Answers& a) { return a.comedi() && a.driven(); }
bool watched(const Answers& a) { return a.comedi() && !a.driven(); }
bool board_supply(const Answers& a) { return a.comedi() && a.measures_supply(); }
bool board_chambers(const Answers& a) { return a.comedi() && a.measures_chambers(); }
bool board_inputs(const Answers& a) { return board_supply(a) || watched(a); }

StandQuestion whole(const char* group, const char* flag, const char* what, const char* where,
                    double min, double max, double usual, When when) {
  return {questions::whole_question(flag, what, where, min, max, usual), std::move(when), nullptr,
          group};
}

StandQuestion choice(const char* group, const char* flag, const char* what, const char* where,
                     std::vector<std::string> choices, When when) {
  const std::string usual = choices.front();
  return {questions::choice_question(flag, what, where, std::move(choices), usual), std::move(when),
          nullptr, group};
}

StandQuestion line(const char* flag, const char* what, When when) {
  return whole(kEncoder, flag, what, "wiring plan; `gpioinfo` lists the lines; -1: none", -1.0,
               kLast, -1.0, std::move(when));
}

std::vector<StandQuestion> encoder_questions() {
  return {
      {questions::text_question("chip", "GPIO chip of the encoder",
                                "path, name or label; `gpiodetect`", "gpiochip0"),
       on_board, nullptr, kEncoder},
      whole(kEncoder, "line-a", "line of track A", kLines, 0.0, kLast, kMust, on_board),
      whole(kEncoder, "line-b", "line of track B", kLines, 0.0, kLast, kMust, on_board),
      line("line-index", "line of the index pulse", on_board),
      choice(kEncoder, "bias", "resistor inside the chip", "encoder's sheet: its outputs",
             {"as_is", "pull_up", "pull_down", "disabled"}, on_board),
      choice(kEncoder, "mode", "counts per cycle of the tracks", "as the resolution is counted",
             {"x4", "x2", "x1"}, on_board),
      {{"resolution-um", "travel per count", "encoder's sheet: pitch over counts per cycle", 1e-6,
        1e6, kMust},
       on_board,
       nullptr,
       kEncoder},
      choice(kEncoder, "a-leads", "motion in which track A leads B",
             "try by hand; commissioning "
             "finds it",
             {"extends", "retracts"}, on_board),
      {{"reference-mm", "position at the index; without one, at the start",
        "drawing, or measured once", -1e6, 1e6, 0.0},
       on_board,
       nullptr,
       kEncoder},
      {{"edges-per-s", "edge rate that this machine follows without loss",
        "measured on this machine; 20000 is a guess for a PC", 1.0, 1e8, 2e4},
       on_board,
       nullptr,
       kEncoder},
      line("e-stop-line", "line of the e-stop, 1 while released", board_drives),
      line("enable-line", "line of the enable switch, 1 while motion is allowed", board_drives),
      line("permit-line", "line that every good period toggles, for a watchdog relay",
           board_drives),
      choice(kEncoder, "accept-no-watchdog",
             "drive the valve though nothing takes a command away "
             "when this process dies",
             "your risk assessment", {"no", "yes"},
             [](const Answers& a) { return board_drives(a) && !a.has("permit-line"); }),
  };
}

std::vector<StandQuestion> output_questions() {
  return {
      whole(kBoard, "output-subdevice", "subdevice of the valve; -1: the first analogue output",
            kBoardInfo, -1.0, 255.0, -1.0, board_drives),
      whole(kBoard, "output-channel", "channel of the valve", kBoardInfo, 0.0, kLast, 0.0,
            board_drives),
      whole(kBoard, "output-range", "number of its range", kBoardInfo, 0.0, 255.0, 0.0,
            board_drives),
      {{"output-V-per-V", "voltage at the terminal per volt of command",
        "sheet of the amplifier between; 1: none", 1e-6, 1e6, 1.0},
       board_drives,
       nullptr,
       kBoard},
      {{"output-offset-V", "voltage at the terminal for command 0", "the same sheet", -100.0, 100.0,
        0.0},
       board_drives,
       nullptr,
       kBoard},
      choice(kBoard, "positive-voltage", "motion under a positive voltage at the terminal",
             "try with small steps; commissioning finds it", {"extends", "retracts"}, board_drives),
      {{"delay-ms", "time from the write to the voltage at the valve", "board's sheet", 0.0, 1000.0,
        0.0},
       board_drives,
       nullptr,
       kBoard},
  };
}

std::vector<StandQuestion> input_questions() {
  return {
      whole(kBoard, "command-channel", "channel that reads the other controller's command",
            kBoardInfo, 0.0, kLast, kMust, watched),
      {{"command-V-per-V", "command per volt at that terminal", "1, or the divider's ratio", -1e6,
        1e6, 1.0},
       watched,
       nullptr,
       kBoard},
      whole(kBoard, "supply-channel", "channel of the supply pressure", kBoardInfo, 0.0, kLast,
            kMust, board_supply),
      whole(kBoard, "pressure-in-channel", "channel of the pressure that extends", kBoardInfo, 0.0,
            kLast, kMust, board_chambers),
      whole(kBoard, "pressure-out-channel", "channel of the pressure that retracts", kBoardInfo,
            0.0, kLast, kMust, board_chambers),
      {{"pressure-bar-per-V", "pressure per volt", "transducer's sheet: full scale over its volts",
        -1e6, 1e6, kMust},
       board_supply,
       nullptr,
       kBoard},
      {{"pressure-offset-bar", "pressure at 0 V",
        "transducer's sheet; -62.5 of 1 to 5 V for 250 bar", -1e4, 1e4, 0.0},
       board_supply,
       nullptr,
       kBoard},
      whole(kBoard, "input-subdevice", "subdevice of the inputs; -1: the first analogue input",
            kBoardInfo, -1.0, 255.0, -1.0, board_inputs),
      whole(kBoard, "input-range", "number of their range", kBoardInfo, 0.0, 255.0, 0.0,
            board_inputs),
      choice(kBoard, "aref", "voltage reference of the board's channels", "wiring plan",
             {"ground", "common", "diff", "other"},
             [](const Answers& a) { return board_drives(a) || board_inputs(a); }),
  };
}

}  // namespace

std::vector<StandQuestion> board_questions() {
  std::vector<StandQuestion> all = encoder_questions();
  all.push_back({questions::text_question("device", "file of the comedi board", "`ls /dev/comedi*`",
                                          "/dev/comedi0"),
                 [](const Answers& a) { return board_drives(a) || board_inputs(a); }, nullptr,
                 kBoard});
  for (const auto& part : {output_questions(), input_questions()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

}  // namespace workbench::stand
