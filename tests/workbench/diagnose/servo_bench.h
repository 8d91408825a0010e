// A bench for the command: a servo v = gain (u + offset), stepped exactly, read through an encoder
// with noise, and the model file that knows nothing of the offset.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "config/record/record.h"
#include "tests/workbench/run_command.h"

namespace workbench::diagnose {

class ServoBench {
 public:
  ServoBench()
      : folder_(std::filesystem::temp_directory_path() /
                ("spoolwatch_diagnose_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    std::ofstream(file("servo.toml")) << "schema_version = 1\nname = \"servo\"\n"
                                         "plant = \"velocity_servo\"\nstep_s = 0.005\n"
                                         "[parameters]\ngain_mps_per_V = 0.05\n";
  }
  ~ServoBench() { std::filesystem::remove_all(folder_); }
  ServoBench(const ServoBench&) = delete;
  ServoBench& operator=(const ServoBench&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::string model() const { return file("servo.toml"); }

  struct Motion {
    double offset_V = 0.0;
    double gain_mps_per_V = 0.0505;
    double duration_s = 10.0;
    double sample_time_s = 0.005;
    double amplitude_V = 1.0;
    unsigned seed = 1;
  };

  /// Random steps of the command, 0.2 s each, and a pull back to the middle.
  std::string record(const std::string& name, const Motion& motion) const {
    constexpr double kEncoder_m = 5e-6;
    std::mt19937 random(motion.seed);
    std::normal_distribution<double> noise_m(0.0, 2e-6);
    std::uniform_real_distribution<double> level(-1.0, 1.0);
    config::record::Record record;
    double y_m = 0.3;
    double step_V = 0.0;
    const auto samples = std::lround(motion.duration_s / motion.sample_time_s);
    const long hold = std::max(1L, std::lround(0.2 / motion.sample_time_s));
    for (long k = 0; k < samples; ++k) {
      const double read_m = kEncoder_m * std::round((y_m + noise_m(random)) / kEncoder_m);
      if (k % hold == 0) step_V = motion.amplitude_V * level(random);
      const double u_V = motion.amplitude_V == 0.0 ? 0.0 : step_V - 20.0 * (read_m - 0.3);
      record.t_s.push_back(static_cast<double>(k) * motion.sample_time_s);
      record.u_V.push_back(u_V);
      record.y_m.push_back(read_m);
      y_m += motion.gain_mps_per_V * (u_V + motion.offset_V) * motion.sample_time_s;
    }
    config::record::write_csv(record, file(name));
    return file(name);
  }

 private:
  std::filesystem::path folder_;
};

inline std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

inline nlohmann::json json_of(const std::string& file) {
  return nlohmann::json::parse(text_of(file));
}

inline int diagnose_with(std::vector<std::string> arguments) {
  arguments.emplace_back("--quiet");
  return workbench_test::run_command(workbench::cli::add_diagnose, std::move(arguments));
}

}  // namespace workbench::diagnose
