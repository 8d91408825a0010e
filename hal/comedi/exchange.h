// Exchange with a board: writes commands at once, reads all inputs shortly before each tick.
//
// A driver's call may block (a converter that settles, a bus), so a thread makes it; the loop's
// side is wait-free. The thread writes a command as soon as it is woken, and reads a quarter of a
// period, at most 1 ms, before the next tick is due, so that readings are fresh. Without a thread
// the loop makes the calls itself: for boards known to be fast.
#pragma once

#include <semaphore.h>

#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include "hal/comedi/board.h"
#include "hal/device.h"
#include "hal/freshness.h"
#include "hal/latest.h"
#include "hal/monotonic.h"
#include "hal/thread.h"

namespace hal::comedi {

class Exchange {
 public:
  static constexpr std::size_t kInputs = 16;

  struct View {
    std::array<std::uint32_t, kInputs> codes{};
    std::array<bool, kInputs> good{};
    std::int64_t read_ns = 0;        ///< when the codes were read, 0: never
    std::uint64_t written = 0;       ///< number of the newest command that reached the board
    bool write_failed = false;       ///< result of the newest write
    std::int64_t read_failures = 0;  ///< since the start
    std::int64_t write_failures = 0;
  };

  /// At most kInputs places. `output` is used by write() only.
  Exchange(std::shared_ptr<Board> board, std::vector<BoardChannel> inputs,
           const BoardChannel& output, std::int64_t period_ns);
  ~Exchange();
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  /// Reads once, and starts the thread if asked to. Throws config::schema::RunError when the thread
  /// cannot start.
  void start(bool threaded, int priority);

  /// The inputs of this tick; from the loop's thread only.
  const View& view(const Tick& tick) noexcept;
  /// False when the board rejected the last command or has not accepted it within two periods. Loop
  /// thread only.
  bool write(std::uint32_t code, const Tick& tick) noexcept;
  /// Any thread; async-signal-safe; works without the exchange thread.
  bool write_now(std::uint32_t code) noexcept;
  /// Quality at `now_ns` of input `index` of `view`.
  [[nodiscard]] config::signals::Quality quality(const View& view, std::size_t index,
                                                 std::int64_t now_ns) const noexcept {
    return view.good[index] ? freshness(now_ns - view.read_ns, period_ns_)
                            : config::signals::Quality::bad;
  }

 private:
  void pass() noexcept;
  void read_all() noexcept;
  void write_newest() noexcept;

  std::shared_ptr<Board> board_;
  std::vector<BoardChannel> inputs_;
  BoardChannel output_;
  std::int64_t period_ns_;
  std::int64_t lead_ns_;
  bool threaded_ = false;

  View own_;  ///< owned by the thread, or by the loop without one
  Latest<View> latest_;
  std::atomic<std::uint64_t> command_{0};  ///< number << 32 | code; 0: none yet
  std::atomic<std::int64_t> tick_ns_{0};   ///< time of the loop's last call
  std::int64_t next_read_ns_ = 0;
  std::int64_t last_index_ = -1;
  std::int64_t given_ns_ = 0;  ///< loop only: time of the oldest command not yet accepted
  sem_t wake_;
  Thread thread_;
};

}  // namespace hal::comedi
