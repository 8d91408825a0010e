// The words of a column's header, and those that several questions about a column look for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace config::record {

/// Words to look for, in lower case; one that ends in * may be a part of a longer word.
using Words = std::vector<std::string_view>;

/// "Valve cmdVoltage_1" as "valve", "cmd", "voltage", "1".
[[nodiscard]] std::vector<std::string> words_of(std::string_view name);

/// True where any of `wanted` is among the words.
[[nodiscard]] bool has_word(const std::vector<std::string>& words, const Words& wanted);

inline const Words kCommandWords{"u",           "ao",           "cmd",           "dac",
                                 "ctrl",        "drive",        "valve",         "input",
                                 "mando",       "styr*",        "stell*",        "befehl*",
                                 "control",     "ventil*",      "regler*",       "comando",
                                 "command*",    "commande",     "eingang*",      "kommando*",
                                 "ansteuer*",   "controller",   "servovalve",    "sterownik*",
                                 "manipulated", "steuerstrom*", "steuersignal*", "steuerspannung*"};

inline const Words kWeakCommandWords{"voltage*", "spannung*", "volt",    "volts",
                                     "current*", "strom*",    "torque*", "moment*",
                                     "force*",   "kraft*",    "pwm",     "duty"};

inline const Words kPositionWords{
    "y",        "pos",       "position*", "displacement*", "stroke",   "weg*",     "hub",
    "lage",     "rod",       "piston*",   "kolben*",       "angle",    "winkel*",  "theta",
    "encoder*", "lvdt",      "travel",    "extension",     "istwert",  "rotation", "posicion",
    "posición", "posizione", "corsa",     "stellung*",     "opening*", "öffnung*", "läge",
    "lageist*", "positie",   "course",    "déplacement"};

inline const Words kValveWords{"valve*", "servovalve", "ventil*", "sv"};

inline const Words kMotorWords{"motor*", "drive", "antrieb*"};

}  // namespace config::record
