#include "hal/hil_rig/gpio_lines.h"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>

#include "config/schema/error.h"

namespace hal::hil_rig {
namespace {

int open_pull(const std::string& chip, int line) {
  const std::filesystem::path platform = "/sys/devices/platform";
  std::error_code none;
  for (const auto& device : std::filesystem::directory_iterator(platform, none)) {
    const auto pull = device.path() / chip / ("sim_gpio" + std::to_string(line)) / "pull";
    const int file = open(pull.c_str(), O_WRONLY | O_CLOEXEC);
    if (file >= 0) return file;
  }
  throw config::schema::bad_config("line " + std::to_string(line) + " of " + chip,
                                   "is no line of a simulated GPIO chip that can be written",
                                   "a chip of the kernel module gpio-sim, as root");
}

}  // namespace

SimLine::SimLine(const std::string& chip, int line) : file_(open_pull(chip, line)) {}

SimLine::~SimLine() { close(file_); }

bool SimLine::set(bool high) noexcept {
  constexpr char kUp[] = "pull-up";
  constexpr char kDown[] = "pull-down";
  return high ? pwrite(file_, kUp, sizeof kUp - 1, 0) > 0
              : pwrite(file_, kDown, sizeof kDown - 1, 0) > 0;
}

SimEncoder::SimEncoder(const std::string& chip, int line_a, int line_b, int index_line)
    : a_(chip, line_a), b_(chip, line_b) {
  if (index_line >= 0) index_ = std::make_unique<SimLine>(chip, index_line);
  a_.set(false);
  b_.set(false);
  if (index_ != nullptr) index_->set(true);
}

std::int64_t SimEncoder::move_to(std::int64_t quarter) noexcept {
  std::int64_t edges = 0;
  for (; quarter_ != quarter; ++edges) {
    const std::int64_t next = quarter_ + (quarter > quarter_ ? 1 : -1);
    // (A, B) in quarters 0 to 3: (0,0) (1,0) (1,1) (0,1).
    const auto a = [](std::int64_t q) { return ((q + 3) & 2) == 0; };
    const auto b = [](std::int64_t q) { return (q & 2) != 0; };
    if (a(quarter_) != a(next)) a_.set(a(next));
    if (b(quarter_) != b(next)) b_.set(b(next));
    if (index_ != nullptr && (quarter_ == 0 || next == 0)) index_->set(next == 0);
    quarter_ = next;
  }
  return edges;
}

}  // namespace hal::hil_rig
