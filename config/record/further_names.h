// Names that the further columns of a file have in a record.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

namespace config::record {

/// "Supply_pressure" of "Supply pressure".
[[nodiscard]] std::string slug(std::string_view name);

/// Gives each name once.
class FurtherNames {
 public:
  /// The name itself, or "NAME_2" where it is given already.
  std::string take(const std::string& name);

  /// "Supply_pressure_Pa" of "Supply pressure" and "Pa"; "reference_m" of the first set point in m.
  std::string take_with_unit(std::string_view name, const std::string& si, bool reference);

 private:
  std::set<std::string> given_;
  std::map<std::string, int> next_;  ///< number to try for a name that is given already
};

}  // namespace config::record
