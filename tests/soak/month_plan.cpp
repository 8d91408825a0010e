#include "tests/soak/month_plan.h"

#include <cmath>
#include <iomanip>
#include <random>
#include <sstream>

namespace soak {
namespace {

constexpr double kBefore_s = 60.0;
constexpr double kAfter_s = 200.0;
constexpr double kStep_s = 7200.0;  // of the wall clock, at most

std::int64_t ns(double s) { return std::llround(s * 1e9); }

}  // namespace

MonthPlan::MonthPlan(std::uint64_t seed, double duration_s) {
  std::mt19937_64 random(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double end_s = duration_s - kAfter_s;
  const struct {
    const char* kind;
    const char* alarm;
    double longest_s;
  } kinds[] = {{"pressure", "supply_pressure_fast", 60.0},
               {"missing", "missing", 6.0},
               {"frozen", "frozen", 4.0},
               {"stale", "stale", 4.0},
               {"jump", "jump", 6.0},
               {"deaf", "bus_lost", 6.0}};
  for (double t_s = kBefore_s;;) {
    const auto& kind = kinds[random() % std::size(kinds)];
    const double to_s = t_s + between(2.0, kind.longest_s);
    if (to_s > end_s) break;
    devices.push_back({kind.kind, kind.alarm, t_s, to_s, random() % 2 == 0 ? 1.25 : 0.75});
    t_s = to_s + between(60.0, 240.0);
  }
  // A third of them late by less than a period, and one in ten by enough for null (50 ms).
  for (double t_s = kBefore_s; t_s < end_s; t_s += between(90.0, 900.0)) {
    const double share = between(0.0, 1.0);
    const double late_s = share < 0.3   ? between(1e-4, 4.9e-3)
                          : share < 0.9 ? between(5e-3, 45e-3)
                                        : between(50e-3, 200e-3);
    late.push_back({ns(t_s), ns(late_s)});
  }
  for (double t_s = kBefore_s; t_s < end_s; t_s += between(600.0, 6000.0)) {
    steps.push_back({ns(t_s), ns(between(-kStep_s, kStep_s)) / 1000});
  }
  for (double t_s = 2.0 * kBefore_s;;) {
    const double to_s = t_s + between(5.0, 300.0);
    if (to_s > end_s) break;
    disk.push_back({static_cast<DiskTrouble>(random() % 3), ns(t_s), ns(to_s)});
    t_s = to_s + between(300.0, 3000.0);
  }
}

std::string MonthPlan::as_toml() const {
  std::ostringstream out;
  out << std::setprecision(17);
  for (const DeviceFault& fault : devices) {
    if (fault.kind == "pressure") {
      const auto change = [&](double at_s, double factor) {
        out << "\n[[sim.fault]]\nparameter = \"supply_pressure_Pa\"\nat_s = " << std::fixed << at_s
            << "\nfactor = " << factor << '\n';
      };
      change(fault.from_s, fault.factor);
      change(fault.to_s, 1.0);
      continue;
    }
    out << "\n[[sim.trouble]]\nkind = \"" << fault.kind << "\"\nfrom_s = " << std::fixed
        << fault.from_s << "\nto_s = " << fault.to_s << '\n';
    if (fault.kind == "jump") out << "size_m = 0.02\n";
  }
  return out.str();
}

}  // namespace soak
