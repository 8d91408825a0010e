#include "daemon/io/drain_thread.h"

#include <chrono>
#include <csignal>
#include <utility>

namespace monitor::io {
namespace {

constexpr auto kPeriod = std::chrono::milliseconds(50);

}  // namespace

void DrainThread::start(std::function<void()> drain) {
  drain_ = std::move(drain);
  thread_ = std::thread([this] { run(); });
}

void DrainThread::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void DrainThread::run() {
  // The main thread handles signals; a file-size limit is then reported as EFBIG.
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
  std::unique_lock lock(mutex_);
  while (!stop_) {
    wake_.wait_for(lock, kPeriod, [this] { return stop_; });
    lock.unlock();
    drain_();
    lock.lock();
  }
}

}  // namespace monitor::io
