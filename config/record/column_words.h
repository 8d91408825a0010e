// How well a column fits time, command or position, by the words and the unit of its header.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "config/record/column_roles.h"
#include "config/record/unit_text.h"

namespace config::record {

inline constexpr std::array kMainRoles{Role::time, Role::command, Role::position};
inline constexpr std::array<const char*, 3> kRoleWords{"time", "command", "position"};
inline constexpr std::array<const char*, 3> kRoleKeys{"t", "u", "y"};

[[nodiscard]] constexpr std::size_t index_of(Role role) noexcept {
  return static_cast<std::size_t>(role);
}

/// A file's column, read as words and a unit.
struct ReadColumn {
  std::string header;  ///< for messages: as in the file, or its number
  HeaderText text;
  std::string conflict;  ///< the two units that header and line of units name; empty: one or none
  std::string scale;     ///< "has a scale ...": a factor that a mapping has to state; empty: none
  std::vector<std::string> words;
  bool named = false;  ///< the file names it
  bool numbers = true;
  bool clock = false;
  bool setting = false;
  const std::vector<double>* sample = nullptr;
};

/// Name and unit in a column's header. The letter of a port or a phase is no unit: p_A, i_V beside
/// i_U, and any where another quantity's unit stands `beside` the name. `headers`: all columns'.
[[nodiscard]] HeaderText column_header(const std::vector<std::string>& headers, std::size_t column,
                                       const UnitText& beside);

/// Refers to `head`.
[[nodiscard]] std::vector<ReadColumn> read_columns(const FileHead& head);

[[nodiscard]] bool increases(const std::vector<double>& values);

/// True for the SI units that a role may have.
[[nodiscard]] bool fits(Role role, std::string_view si);

/// True for "t", "u" and "y", the role's own name.
[[nodiscard]] bool has_stem_of(Role role, const ReadColumn& column);
/// True for the name of a set point.
[[nodiscard]] bool names_reference(std::string_view name);
/// True for a column whose name is that of a set point.
[[nodiscard]] bool is_reference(const ReadColumn& column);
/// True where no word speaks of a set point or another quantity.
[[nodiscard]] bool is_plain(const ReadColumn& column);

/// True for the measured position of a valve's spool, which is neither the rod's nor a command.
[[nodiscard]] bool is_spool(const ReadColumn& column);
/// True for a set point in a drive's unit, which may be the command: "Set voltage [V]".
[[nodiscard]] bool is_drive_set_point(const ReadColumn& column);
/// True where no word speaks of a supply, a brake, a load, a relief valve or a sensor.
[[nodiscard]] bool may_drive(const ReadColumn& column);
/// True for a force or torque whose name does not say that it is commanded: a load cell's.
[[nodiscard]] bool may_be_measured_force(const ReadColumn& column);
/// True for a signal that may be the command where a force stands beside it: "Servo [V]", or a
/// commanded position.
[[nodiscard]] bool may_drive_besides(const ReadColumn& column);
/// True where a word speaks of a command: a commanded position is no measured one.
[[nodiscard]] bool is_commanded(const ReadColumn& column);
/// True where a word speaks of an angle.
[[nodiscard]] bool is_angle(const ReadColumn& column);
/// True where a word speaks of a measurement.
[[nodiscard]] bool is_measured(const ReadColumn& column);

/// How many of time, command and position the words of headers name.
[[nodiscard]] std::size_t roles_named(const std::vector<std::string>& headers);

/// How well a column's words and unit fit a role: 100 for t_s, u_A, y_rad and their like; 0: not at
/// all. A setting fits less than any measurement of the same words.
[[nodiscard]] int score(Role role, const ReadColumn& column);

}  // namespace config::record
