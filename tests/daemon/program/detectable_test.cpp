// `spoolwatch status` asked what could be detected now: by a motion that tells, and at rest.
#include <gmock/gmock.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/daemon/program/subprocess.h"

namespace program {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr double kSupply_Pa = 6.89e6;
constexpr double kDamping_N_s_per_m = 1000.0;

/// The simulated stand in real time with the tracker on it.
class Detectable : public testing::Test {
 protected:
  ~Detectable() override {
    kill(daemon_.pid(), SIGTERM);
    daemon_.wait();
  }
  [[nodiscard]] Result order(const std::string& words) const {
    return spoolwatch(words + " --socket " + socket());
  }
  /// The tracker's own report; null: nothing yet.
  [[nodiscard]] json tracker() const {
    const json status = json::parse(order("status --json -").out, nullptr, false);
    if (!status.is_object() || !status.contains("detectable")) return nullptr;
    const json& sources = status["detectable"];
    return sources.size() == 1 ? sources[0] : json(nullptr);
  }
  /// Fifteen seconds at most.
  template <class F>
  static bool becomes(F&& f) {
    for (int i = 0; i < 150; ++i) {
      if (f()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  }

 private:
  [[nodiscard]] std::string socket() const { return (folder_.path() / "s").string(); }
  [[nodiscard]] std::vector<std::string> arguments() const {
    std::vector<std::string> all{"--config", shipped("thesis_case3_named.toml"), "--lcm-url", ""};
    for (const std::string& setting :
         {"control.socket=" + socket(), std::string("loop.overrun_action=count"),
          std::string("alarms.folder="), std::string("evidence.folder="),
          std::string("recorder.folder="), std::string("tracker.0.learn_s=1"),
          std::string("tracker.0.probe_low_m=0.28"), std::string("tracker.0.probe_high_m=0.33"),
          std::string("tracker.0.probe_speed_mps=0.1")}) {
      all.emplace_back("--set");
      all.push_back(setting);
    }
    return all;
  }

  Folder folder_;
  Daemon daemon_{arguments()};
};

TEST_F(Detectable, ChangesAreToldWithTheMotionAndAMotionIsSuggestedAtRest) {
  ASSERT_TRUE(becomes([&] {
    const json now = tracker();
    return now.is_object() && now["why"].is_null();
  })) << order("status").out;
  const json moving = tracker();
  EXPECT_EQ(moving["source"], "physics");
  EXPECT_LT(moving["age_s"].get<double>(), 2.0);
  // The least that is named is 3 %; damping is known to about 1 % on this sine, and five standard
  // errors are asked for.
  EXPECT_NEAR(moving["smallest"]["supply_pressure_Pa"], 0.03 * kSupply_Pa, 0.005 * kSupply_Pa);
  EXPECT_GT(moving["smallest"]["damping_N_s_per_m"], 0.03 * kDamping_N_s_per_m);
  EXPECT_LT(moving["smallest"]["damping_N_s_per_m"], 0.12 * kDamping_N_s_per_m);
  EXPECT_THAT(order("status").out, HasSubstr("physics would detect now: supply pressure 2.0"));

  ASSERT_EQ(order("hold").exit_code, 0);
  ASSERT_TRUE(becomes([&] { return tracker()["smallest"]["supply_pressure_Pa"].is_null(); }));
  const json still = tracker();
  EXPECT_TRUE(still["smallest"].contains("damping_N_s_per_m"));
  EXPECT_TRUE(becomes([&] {
    return order("status").out.find("; probe with a sine of ") != std::string::npos;
  })) << order("status").out;
  EXPECT_THAT(tracker()["why"].get<std::string>(), HasSubstr("about 305 mm"));
  // At rest noise decides whether damping is not known or could be seen to change a hundredfold.
  EXPECT_THAT(order("status").out, HasSubstr("supply pressure not known, damping "));
}

}  // namespace
}  // namespace program
