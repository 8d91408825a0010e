#include "hal/comedi/exchange.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "config/schema/error.h"

namespace hal::comedi {
namespace {

constexpr std::int64_t kMostLead_ns = 1'000'000;
constexpr std::uint64_t kNumber = 1ULL << 32U;

}  // namespace

Exchange::Exchange(std::shared_ptr<Board> board, std::vector<BoardChannel> inputs,
                   const BoardChannel& output, std::int64_t period_ns)
    : board_(std::move(board)),
      inputs_(std::move(inputs)),
      output_(output),
      period_ns_(period_ns),
      lead_ns_(std::min(period_ns / 4, kMostLead_ns)) {
  sem_init(&wake_, 0, 0);
}

Exchange::~Exchange() {
  thread_.stop();
  sem_destroy(&wake_);
}

void Exchange::start(bool threaded, int priority) {
  threaded_ = threaded;
  read_all();
  latest_.put(own_);
  if (!threaded) return;
  const int error = thread_.start_cyclic("comedi", {priority, -1, false}, [this] { pass(); });
  if (error != 0) {
    throw config::schema::RunError(std::string("comedi: no thread: ") + std::strerror(error));
  }
}

void Exchange::pass() noexcept {
  // The reading for the tick after the last one; and on at that pace while no tick comes.
  std::int64_t due_ns = tick_ns_.load(std::memory_order_relaxed) + period_ns_ - lead_ns_;
  if (due_ns < next_read_ns_) due_ns = next_read_ns_;
  const timespec until{due_ns / 1'000'000'000, due_ns % 1'000'000'000};
  if (sem_clockwait(&wake_, CLOCK_MONOTONIC, &until) == 0) {
    write_newest();
  } else if (monotonic_ns() >= due_ns) {
    read_all();
    next_read_ns_ = own_.read_ns + period_ns_ / 2;
  }
  latest_.put(own_);
}

void Exchange::read_all() noexcept {
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const std::optional<std::uint32_t> code = board_->read(inputs_[i]);
    own_.good[i] = code.has_value();
    own_.codes[i] = code.value_or(0);
    if (!code) ++own_.read_failures;
  }
  own_.read_ns = monotonic_ns();
}

void Exchange::write_newest() noexcept {
  const std::uint64_t command = command_.load(std::memory_order_acquire);
  if (command / kNumber == own_.written) return;
  own_.write_failed = !board_->write(output_, static_cast<std::uint32_t>(command));
  if (own_.write_failed) ++own_.write_failures;
  own_.written = command / kNumber;
}

const Exchange::View& Exchange::view(const Tick& tick) noexcept {
  if (threaded_) {
    tick_ns_.store(monotonic_ns(), std::memory_order_relaxed);
    return latest_.get();
  }
  if (tick.index != last_index_) read_all();
  last_index_ = tick.index;
  return own_;
}

bool Exchange::write(std::uint32_t code, const Tick& tick) noexcept {
  const std::uint64_t before = command_.load(std::memory_order_relaxed);
  const std::uint64_t number = before / kNumber + 1;
  // Fails only against a null from elsewhere, which stays the newest.
  std::uint64_t expected = before;
  const bool stored = command_.compare_exchange_strong(expected, number * kNumber + code,
                                                       std::memory_order_release);
  if (!threaded_) {
    write_newest();
    return !own_.write_failed && stored;
  }
  sem_post(&wake_);
  const View& seen = view(tick);
  const std::int64_t now_ns = monotonic_ns();
  if (seen.written >= before / kNumber) given_ns_ = now_ns;  // all but this one are taken
  return stored && !seen.write_failed && now_ns - given_ns_ <= 2 * period_ns_;
}

bool Exchange::write_now(std::uint32_t code) noexcept {
  std::uint64_t before = command_.load(std::memory_order_relaxed);
  while (!command_.compare_exchange_weak(before, (before / kNumber + 1) * kNumber + code,
                                         std::memory_order_release)) {
  }
  const bool good = board_->write(output_, code);
  if (threaded_) sem_post(&wake_);  // once more, should the thread just be writing an older one
  return good;
}

}  // namespace hal::comedi
