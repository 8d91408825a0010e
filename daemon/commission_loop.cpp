#include "daemon/commission_loop.h"

#include <chrono>
#include <cmath>

#include "daemon/rt/privileges.h"
#include "hal/freshness.h"

namespace monitor {
namespace {

constexpr std::int64_t kFirstPeriod_ns = 20'000'000;
/// An outage this long aborts the stage.
constexpr double kStoodStill_s = 0.1;
constexpr std::chrono::milliseconds kStuck{1000};

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

const char* to_string(CommissionLoop::Stop stop) noexcept {
  constexpr const char* kTexts[] = {"", "the emergency stop is pressed or cannot be read",
                                    "the enable input is off or cannot be read",
                                    "the valve does not accept commands",
                                    "the loop was interrupted"};
  return kTexts[static_cast<std::size_t>(stop)];
}

CommissionLoop::CommissionLoop(const Parts& parts, control::Commissioning& procedure,
                               bool virtual_time)
    : parts_(parts),
      procedure_(procedure),
      virtual_time_(virtual_time),
      grid_(parts.clock.now_ns() + (virtual_time ? 0 : kFirstPeriod_ns),
            std::llround(parts.sample_time_s * 1e9)),
      aux_inputs_(&parts.devices.inputs, parts.max_bad_in_a_row, stats_),
      start_s_(seconds(parts.clock.now_ns())) {}

CommissionLoop::~CommissionLoop() { end_.store(true, std::memory_order_relaxed); }

int CommissionLoop::start(const hal::ThreadOptions& options) {
  if (virtual_time_) return 0;
  return thread_.start("loop", options, [this] {
    rt::prepare_loop_thread();
    while (!end_.load(std::memory_order_relaxed)) tick();
    parts_.valve.go_null();
  });
}

bool CommissionLoop::run_stage(const std::function<bool()>& stop_asked) {
  constexpr int kTicksBetweenLooks = 256;
  stop_.store(Stop::none, std::memory_order_relaxed);
  stage_.store(true, std::memory_order_release);
  for (int n = 0; stage_.load(std::memory_order_acquire); ++n) {
    if (virtual_time_) tick();
    if ((!virtual_time_ || n % kTicksBetweenLooks == 0) && stop_asked()) {
      abandon_.store(true, std::memory_order_relaxed);
      return false;
    }
  }
  return true;
}

bool CommissionLoop::end() {
  end_.store(true, std::memory_order_relaxed);
  if (virtual_time_) parts_.valve.go_null();
  return thread_.join_for(kStuck);
}

void CommissionLoop::tick() noexcept {
  const rt::Period period = grid_.next(parts_.clock);
  const double period_s = parts_.sample_time_s;
  control::Commissioning::Input in;
  in.now_s = seconds(parts_.clock.now_ns()) - start_s_;
  const hal::Reading reading = parts_.devices.rod->read(period.tick);
  quality_.store(reading.quality, std::memory_order_relaxed);
  in.y_m = reading.y_m;
  in.homed = reading.quality == config::signals::Quality::good;
  in.usable = std::isfinite(reading.y_m) && !reading.end &&
              reading.quality != config::signals::Quality::bad;
  if (reading.t_ns == 0) {
    in.t_s = in.now_s;
    in.usable = in.usable && reading.quality != config::signals::Quality::stale;
  } else {
    // The reading's own time stamp is preferred over the quality flag.
    in.t_s = seconds(reading.t_ns) - start_s_;
    in.usable = in.usable && in.now_s - in.t_s <= hal::kStalePeriods * period_s;
  }
  in.applied_V =
      (std::isfinite(reading.command_V) ? reading.command_V : applied_V_) - parts_.null_V;
  aux_inputs_.read(period.tick);
  in.disturbed = aux_inputs_.blind() || bad_writes_ > 0 || period.skipped > 0;

  double command_V = 0.0;
  if (stage_.load(std::memory_order_acquire)) {
    Stop stop = Stop::none;
    if (!aux_inputs_.e_stop_released()) stop = Stop::e_stop;
    if (stop == Stop::none && !aux_inputs_.enabled()) stop = Stop::not_enabled;
    if (bad_writes_ > parts_.max_bad_in_a_row) stop = Stop::valve_lost;
    if (static_cast<double>(period.skipped) * period_s >= kStoodStill_s) stop = Stop::stood_still;
    const bool abandoned = abandon_.load(std::memory_order_relaxed);
    if (stop == Stop::none && !abandoned) command_V = procedure_.step(in);
    if (stop != Stop::none || abandoned || procedure_.over()) {
      stop_.store(stop, std::memory_order_relaxed);
      stage_.store(false, std::memory_order_release);
      command_V = 0.0;
    }
  }
  if (aux_inputs_.blind()) command_V = 0.0;
  const hal::Applied applied = command_V == 0.0
                                   ? parts_.valve.go_null()
                                   : parts_.valve.write(parts_.null_V + command_V, period.tick);
  applied_V_ = applied.u_V;
  bad_writes_ = applied.good ? 0 : bad_writes_ + 1;
  if (parts_.devices.permit != nullptr && period.skipped == 0) {
    permit_on_ = !permit_on_;
    parts_.devices.permit->set(permit_on_);
  }
}

}  // namespace monitor
