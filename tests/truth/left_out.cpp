#include "tests/truth/left_out.h"

#include <algorithm>
#include <cmath>

namespace truth {
namespace {

using Kind = LeftOut::Kind;

constexpr double kCentre_m = 0.305;
constexpr double kRecord_s = 30.0;
constexpr double kFull_V = 4.0;
constexpr double kTwoPi = 6.283185307179586;

double square(double x) { return x * x; }

}  // namespace

double LeftOut::force_N(double y_m, double v_mps, double t_s) const {
  switch (kind) {
    case Kind::cubic_damping:
      return size * v_mps * v_mps * v_mps;
    case Kind::stiffening_spring:
      return size * std::pow(y_m - kCentre_m, 3);
    case Kind::position_damping:
      return size * v_mps * square((y_m - kCentre_m) / 0.05);
    case Kind::direction_damping:
      return size * std::abs(v_mps);
    case Kind::power_damping:
      return std::copysign(size * std::pow(std::abs(v_mps), 1.5), v_mps);
    case Kind::load_step:
      return t_s >= where ? size : 0.0;
    default:
      return 0.0;
  }
}

double LeftOut::opening_m(double open_m, double gain_m_per_V, double y_m, double t_s) const {
  switch (kind) {
    case Kind::gain_drift:
      return open_m * (1.0 + size * t_s / kRecord_s);
    case Kind::gain_curvature:
      return open_m * std::max(0.2, 1.0 - size * square(open_m / (gain_m_per_V * kFull_V)));
    case Kind::gain_saturation:
      return open_m / std::hypot(1.0, open_m / (gain_m_per_V * size));
    case Kind::one_way_saturation:
      return open_m / (1.0 + size * std::max(open_m, 0.0) / (gain_m_per_V * kFull_V));
    case Kind::underlap: {
      const double lap_m = size * gain_m_per_V;
      return std::abs(open_m) < lap_m ? 2.0 * open_m : open_m + std::copysign(lap_m, open_m);
    }
    case Kind::position_gain:
      return open_m * (1.0 + size * std::sin(kTwoPi * (y_m - kCentre_m) / 0.12));
    default:
      return open_m;
  }
}

double LeftOut::supply_factor(double t_s) const {
  return kind == Kind::supply_step && t_s >= where ? 1.0 - size : 1.0;
}

double LeftOut::leakage_m3ps_per_Pa(double y_m) const {
  if (kind != Kind::position_leakage) return 0.0;
  return size * std::exp(-square((y_m - where) / 0.01));
}

double LeftOut::command_V(double u_V, double t_s) const {
  return kind == Kind::null_drift ? u_V + size * (2.0 * t_s / kRecord_s - 1.0) : u_V;
}

double LeftOut::reading_m(double y_m, double acceleration_mps2, double t_s) const {
  switch (kind) {
    case Kind::scale_drift:
      return y_m + (y_m - kCentre_m - where) * size * t_s / kRecord_s;
    case Kind::mount_compliance:
      return y_m + size * acceleration_mps2;
    default:
      return y_m;
  }
}

const std::vector<LeftOutInfo>& left_out_table() {
  static const std::vector<LeftOutInfo> table{
      {Kind::cubic_damping,
       "cubic_damping",
       "F = s v^3, N s^3/m^3",
       2.5e5,
       0,
       0,
       {"force"},
       {"speed", "v"},
       {"u"}},
      {Kind::stiffening_spring,
       "stiffening_spring",
       "F = s (y - 0.305)^3, N/m^3",
       5e6,
       0,
       0,
       {"force"},
       {"y"},
       {}},
      {Kind::position_damping,
       "position_damping",
       "F = s v ((y - 0.305)/0.05)^2, N s/m",
       3e3,
       0,
       0,
       {"force", "gain"},
       {"y"},
       {"v", "speed", "u"}},
      {Kind::gain_drift,
       "gain_drift",
       "opening x (1 + s t/30 s)",
       0.04,
       0,
       0,
       {"gain", "flow"},
       {"time"},
       {}},
      {Kind::gain_curvature,
       "gain_curvature",
       "opening x (1 - s (opening/4 V)^2)",
       0.15,
       0,
       0,
       {"gain", "flow"},
       {"u"},
       {"v", "speed"}},
      {Kind::position_leakage,
       "position_leakage",
       "s exp(-((y - w)/10 mm)^2) (Pi - Po), m3/s/Pa",
       4e-11,
       0.285,
       0.325,
       {"flow", "gain"},
       {"y"},
       {}},
      {Kind::scale_drift,
       "scale_drift",
       "reading = y + s (y - 0.305) t/30 s",
       0.004,
       0,
       0,
       {"measurement"},
       {"time"},
       {"y"}},
      {Kind::mount_compliance,
       "mount_compliance",
       "reading = y + s y'', s^2",
       1e-5,
       0,
       0,
       {"measurement"},
       {"acceleration"},
       {}},
      {Kind::direction_damping,
       "direction_damping",
       "F = s |v|, N s/m",
       1e3,
       0,
       0,
       {"force", "gain"},
       {"direction", "v"},
       {"speed", "u"}},
      {Kind::supply_step,
       "supply_step",
       "Ps x (1 - s) from w on",
       0.06,
       10,
       20,
       {"gain", "flow"},
       {"time"},
       {}},
      {Kind::null_drift,
       "null_drift",
       "u + s (2 t/30 s - 1), V",
       0.05,
       0,
       0,
       {"flow"},
       {"time"},
       {}},
      {Kind::underlap,
       "underlap",
       "slope 2 while |u| < s, V",
       0.12,
       0,
       0,
       {"flow", "gain"},
       {"u"},
       {"v", "speed", "direction"}},
      {Kind::position_gain,
       "position_gain",
       "opening x (1 + s sin(2 pi (y - 0.305)/0.12))",
       0.03,
       0,
       0,
       {"gain", "flow"},
       {"y"},
       {}},
      {Kind::load_step,
       "load_step",
       "F = s from w on, N",
       300,
       10,
       20,
       {"force", "flow"},
       {"time"},
       {}},
      {Kind::power_damping,
       "power_damping",
       "F = s v sqrt|v|, N (s/m)^1.5",
       8e3,
       0,
       0,
       {"force"},
       {"v", "speed"},
       {"u"}},
      {Kind::gain_saturation,
       "gain_saturation",
       "opening x / sqrt(1 + (opening/s)^2), V",
       7,
       0,
       0,
       {"gain", "flow"},
       {"u"},
       {"v", "speed"}},
      {Kind::one_way_saturation,
       "one_way_saturation",
       "opening x / (1 + s opening/4 V) where it extends",
       0.15,
       0,
       0,
       {"gain", "flow"},
       {"u", "direction"},
       {"v", "speed"}},
  };
  return table;
}

const std::vector<LeftOutInfo>& axis_left_out_table() {
  static const std::vector<LeftOutInfo> table{
      {Kind::elastic_shaft,
       "elastic_shaft",
       "motor and load apart, a spring of s between them, N/m",
       3e5,
       0,
       0,
       {"force", "measurement"},
       {"acceleration"},
       {"u"}},
  };
  return table;
}

const std::vector<LeftOutInfo>& library_law_table() {
  static const std::vector<LeftOutInfo> table{
      {Kind::open_centre,
       "open_centre",
       "underlap of the library: four edges, each open by s at null, V",
       0.12,
       0,
       0,
       {"flow", "gain"},
       {"u"},
       {"v", "speed", "direction"}},
      {Kind::leaking_laps,
       "leaking_laps",
       "lap_leakage of the library: s at null, V, halved 0.3 V beside it",
       0.03,
       0,
       0,
       {"flow", "gain"},
       {"u"},
       {"v", "speed", "direction"}},
  };
  return table;
}

namespace {

template <class Matches>
const LeftOutInfo* find_where(const Matches& matches) {
  for (const auto* table : {&left_out_table(), &axis_left_out_table(), &library_law_table()}) {
    for (const LeftOutInfo& info : *table) {
      if (matches(info)) return &info;
    }
  }
  return nullptr;
}

}  // namespace

const LeftOutInfo* find_left_out(const std::string& name) {
  return find_where([&](const LeftOutInfo& info) { return info.name == name; });
}

const LeftOutInfo* find_left_out(LeftOut::Kind kind) {
  return find_where([&](const LeftOutInfo& info) { return info.kind == kind; });
}

}  // namespace truth
