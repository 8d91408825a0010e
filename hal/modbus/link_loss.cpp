// What the thread does when the connection is lost, and at the end.
#include <algorithm>
#include <cerrno>

#include "hal/modbus/link.h"

namespace hal::modbus {
namespace {

constexpr std::int64_t kFirstPause_ns = 10'000'000;

}  // namespace

void Link::lost() noexcept {
  online_.store(false, std::memory_order_release);
  port_->close();
  greeted_ = false;
  read_due_ns_ = kNever_ns;
  retry_ns_ = monotonic_ns() + pause_ns_;
  pause_ns_ = std::clamp(2 * pause_ns_, kFirstPause_ns, to_ns(config_.longest_pause_s));
}

bool Link::greet() noexcept {
  const Outcome outcome = port_->write(*plan_.valve, null_bits_);
  if (outcome != Outcome::done) return false;
  at_null_ = true;
  if (plan_.watchdog) {
    const WriteChannel& watchdog = *plan_.watchdog;
    const Bits wanted = watchdog.codec.encode(config_.watchdog_s);
    std::uint16_t words[2];
    const Block block{watchdog.table, watchdog.address, watchdog.codec.words()};
    if (port_->write(watchdog, wanted) != Outcome::done) return false;
    if (port_->read(block, words) != Outcome::done) return false;
    if (watchdog.codec.load(words) != wanted) {
      counters_->last_error.store(EPROTO, std::memory_order_relaxed);
      return false;
    }
  }
  greeted_ = true;
  return true;
}

void Link::reconnect() noexcept {
  if (!port_->connect()) {
    counters_->link_errors.fetch_add(1, std::memory_order_relaxed);
    return lost();
  }
  // Whatever was wished while nobody listened is gone.
  (void)box_.take(monotonic_ns());
  for (auto& output : outputs_) output.store(-1);
  if (driven_.load()) {
    if (!greet()) return lost();
    taken_ns_.store(monotonic_ns(), std::memory_order_release);
    if (closing_.load()) null_taken_.store(true);
  }
  read_blocks(0);
  if (!port_->is_open()) return lost();
  counters_->reconnects.fetch_add(1, std::memory_order_relaxed);
  online_.store(true, std::memory_order_release);
}

void Link::finish() noexcept {
  if (!driven_.load() || null_taken_.load()) return;
  if (!port_->is_open() && !port_->connect()) return;
  if (port_->write(*plan_.valve, null_bits_) == Outcome::done) return;
  if (port_->connect()) (void)port_->write(*plan_.valve, null_bits_);
}

}  // namespace hal::modbus
