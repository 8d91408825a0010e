// The rig of the null matrix in a process of its own: every millisecond it takes the board's
// voltage, moves the rod and the encoder's lines, and notes what it sees. A relay that the permit
// line keeps closed takes the voltage away when that line rests.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "hal/comedi/board.h"
#include "hal/hil_rig/gpio_lines.h"
#include "plant_sim/model_file.h"
#include "plant_sim/plant.h"
#include "tests/daemon/program/null_watch.h"
#include "tests/vm/process.h"

namespace vm {

inline constexpr double kCount_m = 1e-4;
inline constexpr double kValveNull_V = 0.25;
inline constexpr std::int64_t kRelay_ns = 20'000'000;  ///< that the permit may rest
inline constexpr hal::comedi::ConverterSpan kSpan{-10.0, 10.0, 65'535};

class NullRig {
 public:
  explicit NullRig(const std::string& chip)
      : shared_(static_cast<Shared*>(mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE,
                                          MAP_SHARED | MAP_ANONYMOUS, -1, 0))),
        process_([this, chip] { return work(chip); }) {}
  NullRig(const NullRig&) = delete;
  NullRig& operator=(const NullRig&) = delete;

  /// The encoder's cable is out: its lines stay as they are.
  void hold_lines() { shared_->held = true; }
  /// When the relay opened, 0: it has not.
  [[nodiscard]] std::int64_t relay_opened_ns() const { return shared_->relay_opened_ns; }
  /// valve_V: at the board's terminal, from null.
  [[nodiscard]] std::vector<program::Look> looks() const {
    return {shared_->looks, shared_->looks + shared_->count.load()};
  }
  /// Waits, ten seconds at most, until the valve is that far out.
  [[nodiscard]] bool moves(double far_V) const {
    for (int i = 0; i < 10'000; ++i) {
      const std::size_t n = shared_->count;
      if (n > 0 && shared_->looks[n - 1].valve_V > far_V) return true;
      sleep_until(hal::monotonic_ns() + 1'000'000);
    }
    return false;
  }

 private:
  static constexpr std::size_t kMost = 60'000;
  static constexpr std::int64_t kStep_ns = 1'000'000;

  struct Shared {
    std::atomic<bool> held;
    std::atomic<std::int64_t> relay_opened_ns;
    std::atomic<std::size_t> count;
    program::Look looks[kMost];
  };

  int work(const std::string& chip) {
    hal::hil_rig::SimEncoder lines(chip, 2, 3);
    const std::unique_ptr<plant_sim::Plant> plant = plant_sim::make_plant(plant_sim::ModelFile());
    hal::comedi::ComediBoard board("rig", "/dev/comedi0");
    board.write({1, 0, 0, 0}, kSpan.code(kValveNull_V));  // it keeps what a killed daemon wrote
    const int permit =
        open(("/sys/devices/platform/gpio-sim.0/" + chip + "/sim_gpio8/value").c_str(), O_RDONLY);
    const double start_m = plant->reading_m();
    const std::int64_t start_ns = hal::monotonic_ns();
    std::int64_t toggled_ns = 0;
    char level = '0';
    for (std::size_t k = 0; k < kMost; ++k) {
      sleep_until(start_ns + static_cast<std::int64_t>(k) * kStep_ns);
      program::Look look{};
      look.before_ns = hal::monotonic_ns();
      look.valve_V = kSpan.volts(board.read({0, 0, 0, 0}).value_or(0)) - kValveNull_V;
      look.after_ns = hal::monotonic_ns();
      char now = level;
      if (pread(permit, &now, 1, 0) == 1 && now != level) toggled_ns = look.after_ns;
      level = now;
      const bool open = toggled_ns != 0 && look.after_ns - toggled_ns > kRelay_ns;
      if (open && shared_->relay_opened_ns == 0) shared_->relay_opened_ns = look.after_ns;
      look.command_V = shared_->relay_opened_ns != 0 ? 0.0 : look.valve_V;
      plant->advance(look.command_V, 1e-9 * kStep_ns);
      look.rod_m = plant->reading_m();
      if (!shared_->held) lines.move_to(std::llround((look.rod_m - start_m) / kCount_m));
      shared_->looks[k] = look;
      shared_->count = k + 1;
    }
    return 0;
  }

  Shared* shared_;
  Process process_;
};

}  // namespace vm
