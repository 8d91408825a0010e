#include "tests/soak/fault_plan.h"

#include <fstream>
#include <iomanip>
#include <random>
#include <sstream>
#include <stdexcept>

namespace soak {
namespace {

constexpr double kFirst_s = 30.0;
constexpr double kLastEnds_s = 30.0;  // before the end

}  // namespace

std::vector<Fault> random_faults(std::uint64_t seed, double duration_s) {
  std::mt19937_64 random(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto ramp_s = [&] { return random() % 2 == 0 ? 0.0 : between(1.0, 20.0); };
  std::vector<Fault> faults;
  for (double t_s = kFirst_s + between(0.0, 60.0);;) {
    Fault fault{};
    fault.at_s = t_s;
    fault.ramp_s = ramp_s();
    fault.factor = random() % 2 == 0 ? 1.25 : 0.75;
    fault.back_s = fault.at_s + fault.ramp_s + between(6.0, 60.0);
    fault.back_ramp_s = ramp_s();
    const double healthy_s = fault.back_s + fault.back_ramp_s;
    if (healthy_s > duration_s - kLastEnds_s) return faults;
    faults.push_back(fault);
    t_s = healthy_s + between(70.0, 200.0);
  }
}

std::string as_toml(const std::vector<Fault>& faults) {
  std::ostringstream out;
  out << std::setprecision(17);
  const auto change = [&](double at_s, double factor, double ramp_s) {
    out << "\n[[sim.fault]]\nparameter = \"supply_pressure_Pa\"\nat_s = " << std::fixed << at_s
        << "\nfactor = " << factor << "\nramp_s = " << ramp_s << '\n';
  };
  for (const Fault& fault : faults) {
    change(fault.at_s, fault.factor, fault.ramp_s);
    change(fault.back_s, 1.0, fault.back_ramp_s);
  }
  return out.str();
}

std::string configuration(const std::filesystem::path& file, const std::vector<Fault>& faults) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  std::string text;
  bool fault = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('[')) fault = line.starts_with("[[sim.fault]]");
    if (!fault) text += line + '\n';
  }
  return text + as_toml(faults);
}

}  // namespace soak
