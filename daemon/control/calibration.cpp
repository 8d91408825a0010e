#include "daemon/control/calibration.h"

#include <fmt/format.h>

#include <cmath>

#include "config/schema/document.h"
#include "config/schema/error.h"

namespace monitor::control {

void Calibration::visit(config::schema::Visitor& v) {
  v.text({"rig_id", "[rig] id at commissioning", true}, rig_id);
  v.text({"date", "date of commissioning", true}, date);
  v.text({"wiring", "hash of the wiring at commissioning"}, wiring);
  v.number({"latency_s", "time from command to motion: dead time and lag", true}, latency_s,
           {0.0, 10.0});
  v.table({"valve", "properties of the valve"}, [this](config::schema::Visitor& t) {
    t.integer({"sign", "1: a higher voltage extends the rod; -1", true}, valve_sign, {-1, 1});
    t.number({"null_V", "voltage at which the rod does not move", true}, null_V, {-100.0, 100.0});
    t.number({"dead_zone_V", "width of the range of voltages without motion", true}, dead_zone_V,
             {0.0, 100.0});
    t.number({"gain_mps_per_V", "speed per voltage outside the dead zone"}, gain_mps_per_V,
             {0.0, 1e3});
  });
  v.table({"rod", "properties of the rod sensor"}, [this](config::schema::Visitor& t) {
    t.integer({"sign", "1: the reading grows as the rod extends; -1", true}, rod_sign, {-1, 1});
    t.number({"scale", "true metres per metre of reading", true}, rod_scale, {1e-12, 1e3});
    t.number({"noise_m", "standard deviation at rest", true}, noise_m, {0.0, 1.0});
  });
  v.table({"home", "reference position"}, [this](config::schema::Visitor& t) {
    t.choice({"kind", "kind of reference position"}, home,
             {"none", "stop_above", "stop_below", "index"});
    if (home != "none")
      t.number({"position_m", "reading at the reference position", true}, home_m, {-1e3, 1e3});
  });
  v.table({"limits", "limits during commissioning"}, [this](config::schema::Visitor& t) {
    t.number({"authority_V", "largest deviation of a command from null"}, authority_V, {0.0, 1e3});
    t.number({"max_travel_m", "limit of rod travel"}, max_travel_m, {0.0, 1e3});
    t.number({"max_speed_mps", "limit of rod speed"}, max_speed_mps, {0.0, 1e3});
  });
}

Calibration load_calibration(const std::filesystem::path& file, const std::string& rig_id) {
  using config::schema::bad_config;
  Calibration calibration;
  config::schema::Document::load(file).read(
      [&](config::schema::Visitor& v) { calibration.visit(v); });
  for (const auto& [where, sign] :
       {std::pair{"[valve] sign", calibration.valve_sign}, {"[rod] sign", calibration.rod_sign}}) {
    if (sign == 0) throw bad_config(file.string() + ": " + where, "is 0", "1, -1");
  }
  if (calibration.rig_id != rig_id) {
    throw bad_config(file.string() + ": rig_id", "is \"" + calibration.rig_id + "\"",
                     "\"" + rig_id + "\", the [rig] id of the configuration");
  }
  return calibration;
}

std::string contradiction(const Calibration& calibration, double null_V, double limit_V,
                          const std::string& wiring) {
  constexpr double kNullShare = 0.01;
  constexpr double kScaleShare = 0.01;
  if (calibration.valve_sign < 0) return "the valve is reversed: a positive command retracts";
  if (calibration.rod_sign < 0) {
    return "the rod sensor is reversed: the reading falls as the rod extends";
  }
  if (std::abs(calibration.rod_scale - 1.0) > kScaleShare) {
    return fmt::format("1 m of reading is {:.4g} m of travel: correct the rod sensor's scale",
                       calibration.rod_scale);
  }
  const double allowed_V = 0.5 * calibration.dead_zone_V + kNullShare * limit_V;
  if (!(std::abs(null_V - calibration.null_V) <= allowed_V)) {
    return fmt::format("[valve] null_V is {:.4g}; the rod stands still at {:.4g} +- {:.2g}", null_V,
                       calibration.null_V, allowed_V);
  }
  if (!calibration.wiring.empty() && calibration.wiring != wiring) {
    return "the configuration of valve or rod sensor has changed since commissioning: commission "
           "again";
  }
  return "";
}

std::string print_calibration(Calibration calibration) {
  return config::schema::print_toml([&](config::schema::Visitor& v) { calibration.visit(v); });
}

}  // namespace monitor::control
