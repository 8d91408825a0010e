#include "daemon/control/calibration.h"

#include "config/schema/document.h"
#include "config/schema/error.h"

namespace monitor::control {

void Calibration::visit(config::schema::Visitor& v) {
  v.text({"rig_id", "[rig] id of the configuration it was made with", true}, rig_id);
  v.text({"date", "of the commissioning", true}, date);
  v.number({"latency_s", "from a command to the first motion", true}, latency_s, {0.0, 10.0});
  v.table({"valve", "as found"}, [this](config::schema::Visitor& t) {
    t.integer({"sign", "1: a higher voltage extends the rod; -1", true}, valve_sign, {-1, 1});
    t.number({"null_V", "where the rod stands still", true}, null_V, {-100.0, 100.0});
    t.number({"dead_zone_V", "width of the range in which it does", true}, dead_zone_V,
             {0.0, 100.0});
  });
  v.table({"rod", "as found"}, [this](config::schema::Visitor& t) {
    t.integer({"sign", "1: the raw reading grows as the rod extends; -1", true}, rod_sign, {-1, 1});
    t.number({"scale", "metres a raw unit", true}, rod_scale, {1e-12, 1e3});
    t.number({"noise_m", "standard deviation at rest", true}, noise_m, {0.0, 1.0});
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

std::string print_calibration(Calibration calibration) {
  return config::schema::print_toml([&](config::schema::Visitor& v) { calibration.visit(v); });
}

}  // namespace monitor::control
