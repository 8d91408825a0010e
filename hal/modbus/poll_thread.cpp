#include "hal/modbus/poll_thread.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <utility>

#include "config/schema/error.h"

namespace hal::modbus {
namespace {

constexpr int kOldCommand_periods = 2;
constexpr std::int64_t kFirstPause_ns = 10'000'000;
/// Longest wait for the thread at the end, beyond the time-outs of two requests.
constexpr int kEnd_ms = 10;

}  // namespace

PollThread::PollThread(const PollThreadConfig& config, RegisterMap map,
                       std::unique_ptr<Connection> connection, std::unique_ptr<Counters> counters,
                       const RegisterSnapshot& first)
    : config_(config),
      map_(std::move(map)),
      counters_(std::move(counters)),
      connection_(std::move(connection)),
      period_ns_(to_ns(config.period_s)),
      stale_ns_(to_ns(config.stale_after_s)),
      null_bits_(map_.valve ? map_.valve->codec.encode(config.null_V) : 0),
      rod_(map_.find_role("rod")),
      outputs_(map_.outputs.size()),
      schedule_(period_ns_, to_ns(config.hand_over_s)),
      snapshot_(first) {
  if (map_.valve) null_frame_ = connection_->frame(*map_.valve, null_bits_);
  for (auto& output : outputs_) output.store(-1);
  latest_.put(snapshot_);
  sem_init(&wake_, 0, 0);
  const int error =
      thread_.start_cyclic("modbus", {config_.priority, -1, false}, [this] { step(); });
  if (error != 0) {
    throw config::schema::RunError(std::string("[modbus]: no thread: ") + std::strerror(error));
  }
}

PollThread::~PollThread() {
  closing_.store(true);
  stop_.store(true);
  sem_post(&wake_);
  thread_.stop();
  finish();
  sem_destroy(&wake_);
}

void PollThread::pace(const Tick& tick) noexcept {
  if (tick.index == announced_tick_) return;
  announced_tick_ = tick.index;
  const std::int64_t now_ns = monotonic_ns();
  schedule_.tick(tick, now_ns);
  if (driven_.load(std::memory_order_relaxed)) return;  // the command announces the tick
  paced_.store(true);
  announce(now_ns);
}

void PollThread::announce(std::int64_t now_ns) noexcept {
  // The command must be stored before the next tick's time, or it waits for a period.
  next_tick_ns_.store(schedule_.next_ns(now_ns), std::memory_order_release);
  if (asleep_.load()) sem_post(&wake_);
}

Applied PollThread::command(Bits bits) noexcept {
  const std::int64_t now_ns = monotonic_ns();
  if (!driven_.exchange(true)) taken_ns_.store(now_ns);
  const std::int64_t before_ns = given_ns_.exchange(now_ns);
  if (closing_.load()) bits = null_bits_;
  slot_.put(bits, now_ns);
  announce(now_ns);
  const bool good = online() && before_ns - taken_ns_.load(std::memory_order_acquire) <= stale_ns_;
  return {good ? map_.valve->codec.decode(bits) : kMissing, good};
}

Applied PollThread::write(double u_V) noexcept {
  return command(std::isfinite(u_V) ? map_.valve->codec.encode(u_V) : null_bits_);
}

bool PollThread::set_output(std::size_t index, bool on) noexcept {
  outputs_[index].store(on ? 1 : 0, std::memory_order_release);
  if (!driven_.load(std::memory_order_relaxed)) {  // otherwise sent with the command
    switched_.store(true);
    announce(monotonic_ns());
  }
  return online();
}

Applied PollThread::end_at_null() noexcept {
  closing_.store(true);
  const Applied applied = command(null_bits_);
  sem_post(&wake_);
  const int longest_ms = kEnd_ms + static_cast<int>(2e3 * config_.connection.timeout_s);
  if (gettid() != thread_id_.load()) {
    for (int ms = 0; ms < longest_ms && !null_taken_.load(); ++ms) poll(nullptr, 0, 1);
  }
  if (null_taken_.load()) return {map_.valve->codec.decode(null_bits_), true};
  const bool sent = connection_->send_now(null_frame_);
  return {applied.u_V, sent};
}

std::int64_t PollThread::next_ns() noexcept {
  if (!connection_->is_open()) {
    asleep_.store(false);
    return retry_ns_;
  }
  const std::int64_t now_ns = monotonic_ns();
  std::int64_t next = std::min(read_due_ns_, look_ns(now_ns));
  // Until the loop runs, poll at its period.
  if (first_round_) next = std::min(next, now_ns + period_ns_);
  if (initialized_ && !at_null_) next = std::min(next, given_ns_.load() + kSilence_ns);
  return next;
}

std::int64_t PollThread::look_ns(std::int64_t now_ns) noexcept {
  const std::int64_t look =
      schedule_.look_ns(next_tick_ns_.load(std::memory_order_acquire), now_ns);
  asleep_.store(look == kNever_ns);
  const bool asked = slot_.waiting() || (!driven_.load() && (paced_.load() || switched_.load()));
  return asked ? now_ns : look;
}

void PollThread::wait_until(std::int64_t t_ns) noexcept {
  const timespec t{static_cast<time_t>(t_ns / 1'000'000'000),
                   static_cast<long>(t_ns % 1'000'000'000)};
  int result = 0;
  do {
    result = t_ns == kNever_ns ? sem_wait(&wake_) : sem_clockwait(&wake_, CLOCK_MONOTONIC, &t);
  } while (result != 0 && errno == EINTR);
  while (sem_trywait(&wake_) == 0) {
  }
}

void PollThread::step() noexcept {
  if (thread_id_.load(std::memory_order_relaxed) == 0) thread_id_.store(gettid());
  if (stop_.load()) return;  // the wake-up has been consumed
  wait_until(next_ns());
  if (stop_.load()) return;
  if (connection_->is_open()) {
    work(monotonic_ns());
  } else if (monotonic_ns() >= retry_ns_) {
    reconnect();
  }
}

void PollThread::work(std::int64_t now_ns) noexcept {
  const bool paced = paced_.exchange(false);
  switched_.store(false);
  const bool driven = driven_.load();
  if (paced || driven) first_round_ = false;
  const bool read_was_due = now_ns >= read_due_ns_ || first_round_;
  if (driven && !initialized_ && !initialize_device()) return lost();

  const std::optional<RegisterCommand> command = driven ? slot_.take(now_ns) : std::nullopt;
  if (command) {
    send(*command, now_ns);
  } else if (initialized_ && !at_null_ && now_ns >= given_ns_.load() + kSilence_ns) {
    counters_->silences.fetch_add(1, std::memory_order_relaxed);
    if (!write_bits(null_bits_)) return lost();
  }
  if (!connection_->is_open()) return lost();
  write_outputs();
  if (!connection_->is_open()) return lost();

  const bool round = command.has_value() || paced;
  const bool later = config_.read_ahead_s > 0.0;
  if (read_was_due || (round && !later)) {
    read_blocks(command && config_.combined ? 1 : 0);
    if (!connection_->is_open()) return lost();
    pause_ns_ = 0;
  }
  if (round && later) {
    read_due_ns_ = next_tick_ns_.load(std::memory_order_relaxed) - to_ns(config_.read_ahead_s);
  }
}

void PollThread::send(const RegisterCommand& command, std::int64_t now_ns) noexcept {
  const bool closing = closing_.load();
  const bool old = now_ns - command.t_ns > kOldCommand_periods * period_ns_;
  const bool null = old || closing;
  if (old && command.bits != null_bits_) {
    counters_->expired_commands.fetch_add(1, std::memory_order_relaxed);
  }
  const std::int64_t measured_ns = measured();
  if (!write_bits(null ? null_bits_ : command.bits)) return;
  if (!null && measured_ns != 0) counters_->reactions.add(monotonic_ns() - measured_ns);
  if (!old) taken_ns_.store(command.t_ns, std::memory_order_release);
  if (closing) null_taken_.store(true);
}

std::int64_t PollThread::measured() const noexcept {
  return rod_ ? snapshot_.t_ns[map_.reads[*rod_].block] : 0;
}

bool PollThread::write_bits(Bits bits) noexcept {
  // Even without a reply the device may have applied the command.
  at_null_ = false;
  RequestResult outcome = RequestResult::lost;
  if (config_.combined) {
    std::uint16_t words[kMostRegisters];
    const std::int64_t start_ns = monotonic_ns();
    outcome = connection_->exchange(*map_.valve, bits, map_.blocks[0], words);
    if (outcome == RequestResult::done) keep(0, words, start_ns + (monotonic_ns() - start_ns) / 2);
    if (outcome == RequestResult::exception) forget(0);
  } else {
    outcome = connection_->write(*map_.valve, bits);
  }
  at_null_ = outcome == RequestResult::done && bits == null_bits_;
  return outcome == RequestResult::done;
}

void PollThread::write_outputs() noexcept {
  for (std::size_t i = 0; i < outputs_.size() && connection_->is_open(); ++i) {
    const std::int8_t wanted = outputs_[i].exchange(-1, std::memory_order_acquire);
    if (wanted < 0) continue;
    const WriteChannel& output = map_.outputs[i];
    connection_->write(output, output.codec.encode(wanted));
  }
}

void PollThread::read_blocks(std::size_t from) noexcept {
  std::uint16_t words[kMostBits];
  read_due_ns_ = kNever_ns;
  for (std::size_t i = from; i < map_.blocks.size(); ++i) {
    const std::int64_t start_ns = monotonic_ns();
    const RequestResult outcome = connection_->read(map_.blocks[i], words);
    if (outcome == RequestResult::lost) return;
    if (outcome == RequestResult::done) keep(i, words, start_ns + (monotonic_ns() - start_ns) / 2);
    if (outcome == RequestResult::exception) forget(i);
  }
  latest_.put(snapshot_);
}

void PollThread::keep(std::size_t block, const std::uint16_t* words, std::int64_t t_ns) noexcept {
  snapshot_.t_ns[block] = t_ns;
  for (std::size_t i = 0; i < map_.reads.size(); ++i) {
    const ReadChannel& r = map_.reads[i];
    if (r.block == block) snapshot_.value[i] = r.codec.decode(r.codec.load(words + r.at));
  }
}

void PollThread::forget(std::size_t block) noexcept {
  for (std::size_t i = 0; i < map_.reads.size(); ++i) {
    if (map_.reads[i].block == block) snapshot_.value[i] = kMissing;
  }
}

void PollThread::lost() noexcept {
  online_.store(false, std::memory_order_release);
  connection_->close();
  initialized_ = false;
  read_due_ns_ = kNever_ns;
  retry_ns_ = monotonic_ns() + pause_ns_;
  pause_ns_ = std::clamp(2 * pause_ns_, kFirstPause_ns, to_ns(config_.longest_pause_s));
}

bool PollThread::initialize_device() noexcept {
  const RequestResult outcome = connection_->write(*map_.valve, null_bits_);
  if (outcome != RequestResult::done) return false;
  at_null_ = true;
  if (map_.watchdog) {
    const WriteChannel& watchdog = *map_.watchdog;
    const Bits wanted = watchdog.codec.encode(config_.watchdog_s);
    std::uint16_t words[2];
    const Block block{watchdog.table, watchdog.address, watchdog.codec.words()};
    if (connection_->write(watchdog, wanted) != RequestResult::done) return false;
    if (connection_->read(block, words) != RequestResult::done) return false;
    if (watchdog.codec.load(words) != wanted) {
      counters_->last_error.store(EPROTO, std::memory_order_relaxed);
      return false;
    }
  }
  initialized_ = true;
  return true;
}

void PollThread::reconnect() noexcept {
  if (!connection_->connect()) {
    counters_->link_errors.fetch_add(1, std::memory_order_relaxed);
    return lost();
  }
  // Drop commands queued while disconnected.
  (void)slot_.take(monotonic_ns());
  for (auto& output : outputs_) output.store(-1);
  if (driven_.load()) {
    if (!initialize_device()) return lost();
    taken_ns_.store(monotonic_ns(), std::memory_order_release);
    if (closing_.load()) null_taken_.store(true);
  }
  read_blocks(0);
  if (!connection_->is_open()) return lost();
  counters_->reconnects.fetch_add(1, std::memory_order_relaxed);
  online_.store(true, std::memory_order_release);
}

void PollThread::finish() noexcept {
  if (!driven_.load() || null_taken_.load()) return;
  if (!connection_->is_open() && !connection_->connect()) return;
  if (connection_->write(*map_.valve, null_bits_) == RequestResult::done) return;
  if (connection_->connect()) (void)connection_->write(*map_.valve, null_bits_);
}

}  // namespace hal::modbus
