// The bench rig to be commissioned: a process of its own, and a configuration that calls it real.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "hal/hil_rig/server.h"
#include "tests/daemon/program/bench_watch.h"
#include "tests/daemon/program/subprocess.h"
#include "tests/hal/hil_rig/rig_process.h"

namespace program {

class Bench {
 public:
  explicit Bench(const std::vector<std::string>& field = {}, const std::string& model = "")
      : rig_(rig_arguments(field, model)) {
    std::ifstream in(shipped("bench_modbus.toml"));
    std::ofstream(file()) << in.rdbuf() << "[control]\nsocket = \"" << socket() << "\"\n"
                          << "[recorder]\nfolder = \"\"\n";
  }

  [[nodiscard]] std::string path(const char* name) const {
    return (folder_.path() / name).string();
  }
  [[nodiscard]] std::string file() const { return path("bench.toml"); }
  [[nodiscard]] std::string socket() const { return path("s"); }
  [[nodiscard]] std::string out() const { return path("calibration.toml"); }
  /// A rig that counts as real, so that it needs the calibration. As many missing readings in a row
  /// as the procedure itself bears (max_gap_s): a machine that runs tests stands still now and
  /// then.
  [[nodiscard]] std::vector<std::string> settings(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"--set", "modbus.address=" + rig_.address(),
                                   "--set", "modbus.bench_rig=false",
                                   "--set", "loop.auto_arm=false",
                                   "--set", "loop.max_bad_in_a_row=20"};
    for (const std::string& setting : more) {
      words.emplace_back("--set");
      words.push_back(setting);
    }
    return words;
  }
  [[nodiscard]] std::vector<std::string> arguments(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"--config", file()};
    for (const std::string& word : settings()) words.push_back(word);
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  [[nodiscard]] Result commission(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = arguments({"--commission", out(), "--yes"});
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  [[nodiscard]] bool written() const { return std::filesystem::exists(out()); }
  /// KEY of the calibration file.
  [[nodiscard]] double found(const std::string& key) const {
    std::ifstream in(out());
    for (std::string line; std::getline(in, line);) {
      if (line.rfind(key + " = ", 0) == 0) return std::stod(line.substr(key.size() + 3));
    }
    return std::nan("");
  }
  [[nodiscard]] int port() const { return rig_.port(); }
  /// No answers to anybody, from 0.1 s from now on, for a second.
  void mute() const { EXPECT_EQ(hal::hil_rig::set_remotely(rig_.address(), "mute_s=1"), ""); }

 private:
  static std::vector<std::string> rig_arguments(const std::vector<std::string>& field,
                                                const std::string& model) {
    std::vector<std::string> words{"--config", hal::hil_rig::shipped_config("bench_rig.toml")};
    if (!model.empty()) words.insert(words.end(), {"--set", "sim.model=" + model});
    for (const std::string& setting : field) {
      words.emplace_back("--set");
      words.push_back("field." + setting);
    }
    return words;
  }

  Folder folder_;
  hal::hil_rig::RigProcess rig_;
};

/// Greatest way from the first look.
inline double travel_m(const std::vector<Look>& looks) {
  double farthest_m = 0.0;
  for (const Look& look : looks) {
    farthest_m = std::max(farthest_m, std::abs(look.rod_m - looks.front().rod_m));
  }
  return farthest_m;
}

}  // namespace program
