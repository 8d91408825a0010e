#include "hal/modbus/link.h"

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
/// How long the end may wait for the thread, beyond the time-outs of two requests.
constexpr int kEnd_ms = 10;

}  // namespace

Link::Link(const LinkConfig& config, Plan plan, std::unique_ptr<Port> port,
           std::unique_ptr<Counters> counters, const Snapshot& first)
    : config_(config),
      plan_(std::move(plan)),
      counters_(std::move(counters)),
      port_(std::move(port)),
      period_ns_(to_ns(config.period_s)),
      stale_ns_(to_ns(config.stale_after_s)),
      null_bits_(plan_.valve ? plan_.valve->codec.encode(config.null_V) : 0),
      rod_(plan_.find_role("rod")),
      outputs_(plan_.outputs.size()),
      rhythm_(period_ns_, to_ns(config.hand_over_s)),
      snapshot_(first) {
  if (plan_.valve) null_frame_ = port_->frame(*plan_.valve, null_bits_);
  for (auto& output : outputs_) output.store(-1);
  latest_.put(snapshot_);
  sem_init(&wake_, 0, 0);
  const int error = thread_.start("modbus", config_.priority, [this] { step(); });
  if (error != 0) {
    throw config::schema::RunError(std::string("[modbus]: no thread: ") + std::strerror(error));
  }
}

Link::~Link() {
  closing_.store(true);
  stop_.store(true);
  sem_post(&wake_);
  thread_.stop();
  finish();
  sem_destroy(&wake_);
}

void Link::pace(const Tick& tick) noexcept {
  if (tick.index == paced_tick_) return;
  paced_tick_ = tick.index;
  const std::int64_t now_ns = monotonic_ns();
  rhythm_.tick(tick, now_ns);
  if (driven_.load(std::memory_order_relaxed)) return;  // the command will do it
  paced_.store(true);
  announce(now_ns);
}

void Link::announce(std::int64_t now_ns) noexcept {
  // What is wanted must be there before the time that follows from it, or it waits for a period.
  next_tick_ns_.store(rhythm_.next_ns(now_ns), std::memory_order_release);
  if (asleep_.load()) sem_post(&wake_);
}

Applied Link::command(Bits bits) noexcept {
  const std::int64_t now_ns = monotonic_ns();
  if (!driven_.exchange(true)) taken_ns_.store(now_ns);
  const std::int64_t before_ns = given_ns_.exchange(now_ns);
  if (closing_.load()) bits = null_bits_;
  box_.put(bits, now_ns);
  announce(now_ns);
  const bool good = online() && before_ns - taken_ns_.load(std::memory_order_acquire) <= stale_ns_;
  return {good ? plan_.valve->codec.decode(bits) : kMissing, good};
}

Applied Link::write(double u_V) noexcept {
  return command(std::isfinite(u_V) ? plan_.valve->codec.encode(u_V) : null_bits_);
}

bool Link::set_output(std::size_t index, bool on) noexcept {
  outputs_[index].store(on ? 1 : 0, std::memory_order_release);
  if (!driven_.load(std::memory_order_relaxed)) {  // else it goes with the command
    switched_.store(true);
    announce(monotonic_ns());
  }
  return online();
}

Applied Link::end_at_null() noexcept {
  closing_.store(true);
  const Applied applied = command(null_bits_);
  sem_post(&wake_);
  const int longest_ms = kEnd_ms + static_cast<int>(2e3 * config_.port.timeout_s);
  if (gettid() != thread_id_.load()) {
    for (int ms = 0; ms < longest_ms && !null_taken_.load(); ++ms) poll(nullptr, 0, 1);
  }
  if (null_taken_.load()) return {plan_.valve->codec.decode(null_bits_), true};
  const bool sent = port_->send_now(null_frame_);
  return {applied.u_V, sent};
}

std::int64_t Link::next_ns() noexcept {
  if (!port_->is_open()) {
    asleep_.store(false);
    return retry_ns_;
  }
  const std::int64_t now_ns = monotonic_ns();
  std::int64_t next = std::min(read_due_ns_, look_ns(now_ns));
  // Until the loop runs, readings are kept fresh at its pace.
  if (first_round_) next = std::min(next, now_ns + period_ns_);
  if (greeted_ && !at_null_) next = std::min(next, given_ns_.load() + kSilence_ns);
  return next;
}

std::int64_t Link::look_ns(std::int64_t now_ns) noexcept {
  const std::int64_t look = rhythm_.look_ns(next_tick_ns_.load(std::memory_order_acquire), now_ns);
  asleep_.store(look == kNever_ns);
  const bool asked = box_.waiting() || (!driven_.load() && (paced_.load() || switched_.load()));
  return asked ? now_ns : look;
}

void Link::wait_until(std::int64_t t_ns) noexcept {
  const timespec t{static_cast<time_t>(t_ns / 1'000'000'000),
                   static_cast<long>(t_ns % 1'000'000'000)};
  int result = 0;
  do {
    result = t_ns == kNever_ns ? sem_wait(&wake_) : sem_clockwait(&wake_, CLOCK_MONOTONIC, &t);
  } while (result != 0 && errno == EINTR);
  while (sem_trywait(&wake_) == 0) {
  }
}

void Link::step() noexcept {
  if (thread_id_.load(std::memory_order_relaxed) == 0) thread_id_.store(gettid());
  if (stop_.load()) return;  // its wake-up has been used
  wait_until(next_ns());
  if (stop_.load()) return;
  if (port_->is_open()) {
    work(monotonic_ns());
  } else if (monotonic_ns() >= retry_ns_) {
    reconnect();
  }
}

void Link::work(std::int64_t now_ns) noexcept {
  const bool paced = paced_.exchange(false);
  switched_.store(false);
  const bool driven = driven_.load();
  if (paced || driven) first_round_ = false;
  const bool read_was_due = now_ns >= read_due_ns_ || first_round_;
  if (driven && !greeted_ && !greet()) return lost();

  const std::optional<Command> command = driven ? box_.take(now_ns) : std::nullopt;
  if (command) {
    send(*command, now_ns);
  } else if (greeted_ && !at_null_ && now_ns >= given_ns_.load() + kSilence_ns) {
    counters_->silences.fetch_add(1, std::memory_order_relaxed);
    if (!write_bits(null_bits_)) return lost();
  }
  if (!port_->is_open()) return lost();
  write_outputs();
  if (!port_->is_open()) return lost();

  const bool round = command.has_value() || paced;
  const bool later = config_.read_ahead_s > 0.0;
  if (read_was_due || (round && !later)) {
    read_blocks(command && config_.combined ? 1 : 0);
    if (!port_->is_open()) return lost();
    pause_ns_ = 0;
  }
  if (round && later) {
    read_due_ns_ = next_tick_ns_.load(std::memory_order_relaxed) - to_ns(config_.read_ahead_s);
  }
}

void Link::send(const Command& command, std::int64_t now_ns) noexcept {
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

std::int64_t Link::measured() const noexcept {
  return rod_ ? snapshot_.t_ns[plan_.reads[*rod_].block] : 0;
}

bool Link::write_bits(Bits bits) noexcept {
  // Even when no answer comes the device may have taken it.
  at_null_ = false;
  Outcome outcome = Outcome::lost;
  if (config_.combined) {
    std::uint16_t words[kMostRegisters];
    const std::int64_t start_ns = monotonic_ns();
    outcome = port_->exchange(*plan_.valve, bits, plan_.blocks[0], words);
    if (outcome == Outcome::done) keep(0, words, start_ns + (monotonic_ns() - start_ns) / 2);
  } else {
    outcome = port_->write(*plan_.valve, bits);
  }
  at_null_ = outcome == Outcome::done && bits == null_bits_;
  return outcome == Outcome::done;
}

void Link::write_outputs() noexcept {
  for (std::size_t i = 0; i < outputs_.size() && port_->is_open(); ++i) {
    const std::int8_t wanted = outputs_[i].exchange(-1, std::memory_order_acquire);
    if (wanted < 0) continue;
    const WriteChannel& output = plan_.outputs[i];
    port_->write(output, output.codec.encode(wanted));
  }
}

void Link::read_blocks(std::size_t from) noexcept {
  std::uint16_t words[kMostBits];
  read_due_ns_ = kNever_ns;
  for (std::size_t i = from; i < plan_.blocks.size(); ++i) {
    const std::int64_t start_ns = monotonic_ns();
    const Outcome outcome = port_->read(plan_.blocks[i], words);
    if (outcome == Outcome::lost) return;
    if (outcome == Outcome::done) keep(i, words, start_ns + (monotonic_ns() - start_ns) / 2);
  }
  latest_.put(snapshot_);
}

void Link::keep(std::size_t block, const std::uint16_t* words, std::int64_t t_ns) noexcept {
  snapshot_.t_ns[block] = t_ns;
  for (std::size_t i = 0; i < plan_.reads.size(); ++i) {
    const ReadChannel& r = plan_.reads[i];
    if (r.block == block) snapshot_.value[i] = r.codec.decode(r.codec.load(words + r.at));
  }
}

}  // namespace hal::modbus
