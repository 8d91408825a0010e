#include "config/record/column_words.h"

#include <algorithm>
#include <array>
#include <utility>

#include "config/record/header_words.h"
#include "config/record/text_fields.h"
#include "config/record/unit_cells.h"

namespace config::record {
namespace {

const Words kTimeWords{"t",        "time",     "zeit",      "timestamp*", "zeitstempel*",
                       "elapsed*", "sekunden", "temps",     "tid",        "tiempo",
                       "tempo",    "tijd",     "messzeit*", "abtastzeit", "prüfzeit"};
const Words kNoTimeWords{"cycle",  "task", "exec",     "execution", "delay", "turnaround",
                         "jitter", "rise", "settling", "dead",      "step",  "sample"};
const Words kWeakPositionWords{"x",        "output", "ausgang*", "out",  "phi",
                               "measured", "ist",    "height",   "höhe", "hoehe"};
const Words kReferenceWords{
    "ref",      "reference*",  "setpoint*",    "sp",       "soll*",     "target*",   "demand*",
    "desired",  "nominal*",    "wanted",       "set",      "des",       "sollwert*", "fuehrung*",
    "führung*", "req",         "request*",     "vorgabe*", "consigne*", "consigna*", "cible",
    "objetivo", "riferimento", "börvärde*",    "gewenst*", "planned",   "profile",   "trajectory",
    "traj",     "interpolat*", "commanded",    "wunsch*",  "preset",    "virtual",   "yref",
    "xref",     "posref",      "yset",         "xset",     "posset",    "ysp",       "ydes",
    "xdes",     "posdes",      "yd",           "xd",       "deseada",   "deseado",   "desejada",
    "desejado", "theoretical", "theoretisch*", "generator"};
const Words kOtherWords{
    "error*",  "err",    "fehler*",   "deviation", "abweich*",  "velocity*", "vel",    "speed*",
    "geschw*", "accel*", "pressure*", "druck*",    "temp*",     "supply",    "limit",  "min",
    "max",     "model*", "sim*",      "estimat*",  "observer*", "offset",    "status", "tank",
    "diff*",   "delta",  "lag",       "following", "tolerance", "toleranz*", "window", "predict*",
    "pump",    "pumpe*", "pumpen*",   "swash*",    "swivel*",   "schwenk*",  "std",    "stdev",
    "stddev",  "sigma",  "variance",  "varianz",   "remaining", "verbleib*"};
/// Words of what a drive with a loop of its own is asked for.
const Words kSpeedWords{"speed*", "velocity*", "geschw*", "drehzahl*"};
const Words kMeasuredWords{"act",      "actual*", "meas", "measured",
                           "feedback", "fbk",     "ist*", "mess*"};
const Words kPressureWords{"pressure*", "press", "druck*"};
/// Words of a position that is not the rod's.
const Words kOtherPositionWords{"joystick*", "pedal*", "lever",      "hebel*",
                                "handle",    "knob",   "electrical", "elektrisch*"};
/// Words of a signal that drives no rod, unless another speaks of a command.
const Words kAddedWords{"dither"};
/// Words of the valve, whose position is not the rod's and whose reading is no command.
const Words kSpoolWords{"spool*", "schieber*", "pilot*", "vorsteuer*", "hauptstufe*", "mainstage"};
/// Words of a signal that drives no rod, whatever else its name says. "Plastic" is no "Last".
const Words kNoDriveWords{
    "battery",    "batterie*",     "zwischenkreis*", "mains",       "netz",        "netzspannung*",
    "netzstrom*", "netzteil*",     "versorg*",       "sensor*",     "brake",       "bremse*",
    "bus",        "relief",        "load*",          "last",        "lastkraft*",  "lastmoment*",
    "laststrom*", "lastspannung*", "lastmotor*",     "lastventil*", "motorlast*",  "belast*",
    "ff",         "feedforward*",  "heater*",        "heiz*",       "fan",         "lüfter*",
    "cooler",     "cooling",       "kühl*",          "lamp",        "disturbance*"};
/// Words of a sensor's voltage or force, unless another word speaks of a command.
const Words kSensorWords{"bridge", "excitation", "cell"};
/// Words of a supply, unless the supplied drive is named: "DC motor voltage", "Link motor torque".
const Words kSupplyWords{"dc", "link"};
/// Words of a valve's signal that is none of its sensor's.
const Words kValveCommandWords{"u",        "command*",  "cmd",      "kommando*",  "befehl*",
                               "commande", "ansteuer*", "ctrl",     "controller", "dac",
                               "ao",       "input",     "eingang*", "stellgr*",   "mando",
                               "comando",  "control",   "output",   "out"};

const Words kAngleWords{"angle*", "winkel*", "theta", "phi", "rotation", "dreh*"};

constexpr int kCanonical = 100;
constexpr int kStrong = 50;
constexpr int kWeak = 20;

/// t_s, u_A, y_rad: the stem is the role's own and the unit fits, signals of sensors included.
bool is_canonical(Role role, const ReadColumn& column) {
  if (!column.numbers) return false;
  const std::string& si = column.text.unit.si;
  const bool signal = role == Role::position && (si == "V" || si == "A" || si == "pct");
  return has_stem_of(role, column) && (fits(role, si) || signal);
}

/// "10" of "x10 [m]", the tenth state of a model; empty: another name.
std::string_view state_number(std::string_view header) {
  if (!header.starts_with('x')) return {};
  const std::size_t end = std::min(header.find_first_not_of("0123456789", 1), header.size());
  const bool ends = end == header.size() || is_blank(header[end]) ||
                    std::string_view("[(_/,").find(header[end]) != std::string_view::npos;
  return ends ? header.substr(1, end - 1) : std::string_view{};
}

/// "x10 [m]" is a name where "x1 [m]" stands beside, else a scale.
HeaderText without_state_number(const std::vector<std::string>& headers, const std::string& header,
                                const HeaderText& scaled) {
  const std::string number(state_number(header));
  const bool counted = std::any_of(headers.begin(), headers.end(), [&](const std::string& each) {
    const std::string other = clean_text(each);
    return !state_number(other).empty() && state_number(other) != number;
  });
  if (number.empty() || !counted) return scaled;
  HeaderText text = parse_header("x" + header.substr(1 + number.size()));
  if (text.scaled || text.name != "x") return scaled;
  text.name += number;
  return text;
}

}  // namespace

HeaderText column_header(const std::vector<std::string>& headers, std::size_t column,
                         const UnitText& beside) {
  const std::string header = clean_text(headers[column]);
  HeaderText text = parse_header(header);
  if (text.scaled) return without_state_number(headers, header, text);
  const std::string& letter = text.unit.text;
  const bool may = letter == "A" || letter == "V" || letter == "N";
  const bool own = std::find(kRoleKeys.begin(), kRoleKeys.end(), text.name) != kRoleKeys.end();
  if (!may || own || header != text.name + "_" + letter) return text;
  const auto has = [&](const char* other) {
    return std::any_of(headers.begin(), headers.end(), [&](const std::string& each) {
      return clean_text(each) == text.name + "_" + other;
    });
  };
  const std::vector<std::string> words = words_of(text.name);
  const bool pressure = has_word(words, kPressureWords) || (!words.empty() && words.back() == "p");
  const bool counted = letter == "A" ? has("B") : letter == "V" && (has("U") || has("W"));
  const bool other = beside.known() && beside.si != "1" && beside.si != text.unit.si;
  return pressure || counted || other ? HeaderText{header, {}} : text;
}

std::vector<ReadColumn> read_columns(const FileHead& head) {
  std::vector<std::string> headers;
  headers.reserve(head.columns.size());
  for (const FileColumn& column : head.columns) headers.push_back(column.header);
  std::vector<ReadColumn> columns;
  for (std::size_t i = 0; i < head.columns.size(); ++i) {
    const FileColumn& column = head.columns[i];
    ReadColumn read;
    read.header = column.header.empty() ? std::to_string(i + 1) : column.header;
    const UnitText unit = parse_unit(column.unit);
    if (!column.header.empty()) read.text = column_header(headers, i, unit);
    if (!column.unit.empty()) {
      // With a line of units the whole header is the name, unless both name the same unit.
      if (!same_unit(unit, read.text.unit)) {
        if (read.text.unit.known() && unit.known() && unit.si != "1") {
          read.conflict = read.text.unit.text + " and " + unit.text;
        } else if (unit.si != "1" || !read.text.unit.known()) {
          if (!read.text.unit.known()) read.text.name = column.header;
          read.text.unit = unit;
        }
      }
    }
    if (read.text.scaled) read.text.unit = {};
    if (read.text.scaled || (!unit.known() && is_scaled_unit(unit.text))) {
      read.scale = "has a scale that reads in two ways";
    }
    if (!column.factor.empty()) {
      read.scale += (read.scale.empty() ? "" : " and ") + column.factor;
    }
    // In a path within a model only the last part says what the signal is.
    const std::string& name = read.text.name;
    const std::size_t part = name.find_last_of("/\\:.");
    const bool path = part != std::string::npos && part + 1 < name.size() &&
                      !is_blank(name[part + 1]) && !is_digit(name[part + 1]);
    read.words = words_of(path ? name.substr(part + 1) : name);
    read.named = !column.header.empty();
    read.numbers = column.numbers;
    read.clock = column.clock;
    read.setting = column.setting;
    read.sample = &column.sample;
    columns.push_back(std::move(read));
  }
  return columns;
}

bool increases(const std::vector<double>& values) {
  if (values.size() < 3) return false;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (!(values[i] > values[i - 1])) return false;
  }
  return true;
}

bool fits(Role role, std::string_view si) {
  switch (role) {
    case Role::time:
      return si == "s";
    case Role::command:
      return si == "V" || si == "A" || si == "pct" || si == "N" || si == "Nm" || si == "mps" ||
             si == "radps";
    case Role::position:
      return si == "m" || si == "rad";
    case Role::further:
      break;
  }
  return false;
}

bool has_stem_of(Role role, const ReadColumn& column) {
  const std::string& stem = column.text.name;
  return stem == kRoleKeys[index_of(role)] || (role == Role::time && stem == "time");
}

bool names_reference(std::string_view name) { return has_word(words_of(name), kReferenceWords); }

bool is_reference(const ReadColumn& column) {
  // r alone, and w in German; y_d, x_r and q_t are set points, y(t) is a position
  constexpr std::array<std::string_view, 14> kNames{
      "r", "w", "yd", "xd", "qd", "yt", "xt", "qt", "yr", "xr", "qr", "theta_d", "phi_d", "posd"};
  const std::string& name = column.text.name;
  const bool called = name.find('(') == std::string::npos;
  const auto is_name = [&](std::string_view known) { return folded(known) == folded(name); };
  return has_word(column.words, kReferenceWords) ||
         (called && std::any_of(kNames.begin(), kNames.end(), is_name));
}

bool may_drive(const ReadColumn& column) {
  if (has_word(column.words, kNoDriveWords)) return false;
  const auto supplies =
      std::count_if(column.words.begin(), column.words.end(),
                    [](const std::string& word) { return has_word({word}, kSupplyWords); });
  // "Motor DC link voltage" is the link's
  return supplies == 0 || (supplies == 1 && (has_word(column.words, kMotorWords) ||
                                             has_word(column.words, kCommandWords)));
}

namespace {

/// The command of a valve that a closed loop within it follows: "Valve setpoint [%]", "Valve
/// position setpoint [%]". A relief valve's is a pressure, a load valve's another machine's.
bool is_valve_set_point(const ReadColumn& column) {
  const Words rod{"rod", "piston*", "kolben*", "cylinder*", "zylinder*", "stroke"};
  return is_reference(column) && has_word(column.words, kValveWords) && may_drive(column) &&
         !has_word(column.words, kOtherWords) && !has_word(column.words, rod) &&
         column.text.unit.known();
}

}  // namespace

bool is_spool(const ReadColumn& column) {
  if (is_valve_set_point(column)) return false;
  const bool stage = has_word(column.words, {"main"}) && has_word(column.words, {"stage"});
  if (stage || has_word(column.words, kSpoolWords)) return true;
  if (!has_word(column.words, kValveWords) || has_word(column.words, kValveCommandWords))
    return false;
  if (has_word(column.words, kPositionWords)) return true;
  return has_word(column.words, kMeasuredWords) && !has_word(column.words, kWeakCommandWords);
}

bool is_drive_set_point(const ReadColumn& column) {
  const std::string& si = column.text.unit.si;
  const bool electric = si == "V" || si == "A" || si == "pct";
  std::vector<std::string> words = column.words;
  std::erase_if(words,
                [&](const std::string& word) { return electric && has_word({word}, kSpeedWords); });
  const bool speed = words.size() < column.words.size();
  const bool asked = is_reference(column) || (speed && has_word(words, {"command*", "cmd"}));
  const bool drives = electric || si == "N" || si == "Nm";
  return asked && drives && may_drive(column) && !is_measured(column) &&
         !has_word(words, kOtherWords) && !has_word(words, kPositionWords);
}

bool may_be_measured_force(const ReadColumn& column) {
  const std::string& si = column.text.unit.si;
  return (si == "N" || si == "Nm") && !has_word(column.words, kCommandWords) &&
         !has_word(column.words, kMotorWords);
}

bool may_drive_besides(const ReadColumn& column) {
  const std::string& si = column.text.unit.si;
  const bool electric = si == "V" || si == "A" || si == "pct";
  const bool moves = si == "m" || si == "rad";
  return column.numbers && may_drive(column) && is_plain(column) && !is_spool(column) &&
         !is_measured(column) && !has_word(column.words, kSensorWords) &&
         ((electric && !has_word(column.words, kPositionWords)) ||
          (moves && has_word(column.words, kCommandWords)));
}

bool is_commanded(const ReadColumn& column) { return has_word(column.words, kCommandWords); }

bool is_angle(const ReadColumn& column) { return has_word(column.words, kAngleWords); }

bool is_measured(const ReadColumn& column) { return has_word(column.words, kMeasuredWords); }

bool is_plain(const ReadColumn& column) {
  return !is_reference(column) && !has_word(column.words, kOtherWords);
}

namespace {

int fit_of(Role role, const ReadColumn& column) {
  if (is_canonical(role, column)) return kCanonical;
  if (!column.numbers && !column.clock) return 0;
  const UnitText& unit = column.text.unit;
  if (role == Role::time && column.clock) return kStrong + 5;
  if (column.clock) return 0;
  if (unit.known() && !fits(role, unit.si)) return 0;
  // Oscilloscopes call the time so; with a unit of length it is an axis of a machine.
  const bool abscissa = folded(column.text.name) == "xaxis" && !unit.known();
  if (abscissa && increases(*column.sample)) return role == Role::time ? kStrong : 0;
  if (role == Role::time) {
    if (has_word(column.words, kNoTimeWords)) return 0;
    if (folded(column.text.name) == "xvalue") return kStrong;
    if (has_word(column.words, kTimeWords)) return kStrong;
    return unit.known() && increases(*column.sample) ? kWeak : 0;
  }
  if (role == Role::command && is_valve_set_point(column)) return kStrong;
  if (!is_plain(column)) return 0;
  const int measured = is_measured(column) ? 5 : 0;
  const bool spool = is_spool(column);
  if (role == Role::position && spool) return 0;
  if (role == Role::command) {
    const bool positional = has_word(column.words, kPositionWords);
    if (spool && (positional || measured > 0)) return 0;
    if (positional && !unit.known()) return 0;
    if (!may_drive(column)) return 0;
    if (has_word(column.words, kCommandWords)) return kStrong;
    const bool drives = !positional && !has_word(column.words, kAddedWords) &&
                        !has_word(column.words, kSensorWords);
    return drives && has_word(column.words, kWeakCommandWords) ? kWeak : 0;
  }
  if (has_word(column.words, kOtherPositionWords)) return 0;
  if (!unit.known() && has_word(column.words, kCommandWords)) return 0;
  if (has_word(column.words, kCommandWords)) return 0;  // a commanded position is a reference
  if (has_word(column.words, kPositionWords)) return kStrong + measured;
  return has_word(column.words, kWeakPositionWords) ? kWeak + measured : 0;
}

}  // namespace

int score(Role role, const ReadColumn& column) {
  constexpr int kLessForSetting = 15;
  const int points = fit_of(role, column);
  return points > 0 && column.setting ? points - kLessForSetting : points;
}

std::size_t roles_named(const std::vector<std::string>& headers) {
  const std::vector<double> sample;
  return static_cast<std::size_t>(
      std::count_if(kMainRoles.begin(), kMainRoles.end(), [&](Role role) {
        return std::any_of(headers.begin(), headers.end(), [&](const std::string& header) {
          ReadColumn column;
          column.text = parse_header(header);
          column.words = words_of(column.text.name);
          column.sample = &sample;
          return score(role, column) > 0;
        });
      }));
}

}  // namespace config::record
