#include "config/record/command_doubt.h"

#include <algorithm>

#include "config/record/header_words.h"
#include "config/record/text_fields.h"

namespace config::record {
namespace {

/// Words beside "voltage", "current", "torque" or "force" that say nothing against a command.
const Words kNeutralWords{
    "actuator",   "aktor",    "aktuator",  "servo",     "servomotor",  "coil",     "coils",
    "spule",      "spulen",   "solenoid*", "magnet*",   "axis",        "achse",    "achsen",
    "axe",        "joint*",   "gelenk*",   "signal*",   "output",      "out",      "ausgang*",
    "input",      "in",       "channel",   "ch",        "kanal",       "armature", "anker",
    "iq",         "rms",      "eff",       "applied",   "amplifier*",  "amp",      "amps",
    "analog",     "total",    "cylinder*", "zylinder*", "thrust",      "schub",    "vorschub",
    "dreh",       "electro*", "elektro*",  "electric*", "elektrisch*", "torquer",  "rotor",
    "spindel",    "spindle",  "generated", "raw",       "filtered",    "cycle",    "phase",
    "winding",    "windings", "wicklung*", "voice",     "duty",        "to",       "of",
    "the",        "at",       "an",        "am",        "the",         "function", "generator",
    "verstärker", "joystick*"};
/// Words of what is asked for, of what comes in, and of what a position loop answers with.
const Words kAskingWords{"command*", "cmd", "kommando*", "befehl*", "mando", "comando"};
const Words kInputWords{"input", "eingang*"};
const Words kLoopOutputWords{"controller", "ctrl", "output", "out",        "regler*", "stell*",
                             "dac",        "ao",   "valve",  "servovalve", "ventil*", "u"};
/// Words of positions that say as well what moves: "Rod command", "Opening command" are a drive's.
const Words kDrivenWords{"rod",     "stroke",  "opening*", "öffnung*",
                         "piston*", "kolben*", "extension"};
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
    std::vector<std::string> places = words;
    std::erase_if(places, [](const std::string& word) { return has_word({word}, kDrivenWords); });
    if (!has_word(places, kPositionWords) || has_word(words, kLoopOutputWords)) return "";
    if (has_word(words, kAskingWords))
      return "may be the command, or what a position loop is asked for";
    return has_word(words, kInputWords) ? "may be the command, or a sensor's signal" : "";
  }
  if (has_word(words, kCommandWords) || has_word(words, kMotorWords)) return "";
  const bool unknown = is_measured(column) ||
                       std::any_of(words.begin(), words.end(),
                                   [](const std::string& word) { return !thing_of(word).empty(); });
  return unknown ? "may be the command, or a measurement beside it" : "";
}

}  // namespace config::record
