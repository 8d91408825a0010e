#include "config/record/command_doubt.h"

#include <algorithm>

#include "config/record/header_words.h"
#include "config/record/text_fields.h"

namespace config::record {
namespace {

/// Words beside "voltage", "current", "torque" or "force" that say nothing against a command.
const Words kNeutralWords{
    "actuator*",  "aktor*",  "aktuator*", "servo*",    "coil*",       "spule*",   "solenoid*",
    "magnet*",    "axis",    "achse*",    "axe",       "joint*",      "gelenk*",  "signal*",
    "output",     "out",     "ausgang*",  "input",     "in",          "channel",  "ch",
    "kanal",      "arm*",    "anker*",    "iq",        "rms",         "eff",      "applied",
    "amplifier*", "amp",     "amps",      "verst*",    "analog",      "total",    "cylinder*",
    "zylinder*",  "thrust*", "schub*",    "vorschub*", "drehmoment*", "electro*", "elektro*",
    "torquer*",   "rotor*",  "spindel*",  "spindle*",  "generated",   "raw",      "filtered"};
/// Words of what is asked for, and of what a position loop answers with.
const Words kAskingWords{"command*", "cmd", "kommando*", "befehl*", "mando", "comando"};
const Words kLoopOutputWords{"controller", "ctrl",    "control", "output", "out",
                             "regler*",    "stell*",  "dac",     "ao",     "valve",
                             "servovalve", "ventil*", "drive",   "u"};
/// Bytes of an ending such as the s of "torques".
constexpr std::size_t kEnding = 2;

bool is_neutral(const std::string& word) {
  return word.size() == 1 || is_digit(word.front()) || has_word({word}, kCommandWords) ||
         has_word({word}, kMotorWords) || has_word({word}, kValveWords) ||
         has_word({word}, kNeutralWords);
}

/// "spring" of "spring", "feder" of "federkraft"; empty where the word names no thing of its own.
std::string thing_of(const std::string& word) {
  if (is_neutral(word)) return "";
  std::string rest = word;
  for (const std::string_view weak : kWeakCommandWords) {
    const std::string_view stem = weak.substr(0, weak.find('*'));
    const std::size_t at = rest.find(stem);
    if (at == std::string::npos) continue;
    rest.erase(at, stem.size());
    return rest.size() <= kEnding || is_neutral(rest) ? "" : rest;
  }
  return rest;
}

}  // namespace

std::string doubt_of_command(const ReadColumn& column) {
  const std::vector<std::string>& words = column.words;
  if (has_stem_of(Role::command, column)) return "";
  if (has_word(words, kPositionWords)) {
    const bool asked = has_word(words, kAskingWords) && !has_word(words, kLoopOutputWords);
    return asked ? "may be the command, or what a position loop is asked for" : "";
  }
  if (has_word(words, kCommandWords) || has_word(words, kMotorWords)) return "";
  const bool unknown = is_measured(column) ||
                       std::any_of(words.begin(), words.end(),
                                   [](const std::string& word) { return !thing_of(word).empty(); });
  return unknown ? "may be the command, or a measurement beside it" : "";
}

}  // namespace config::record
