#include "hal/thread.h"

#include <sched.h>
#include <sys/prctl.h>

#include <csignal>
#include <ctime>
#include <utility>

namespace hal {

void SignalStack::use() noexcept {
  stack_t stack{};
  if (sigaltstack(nullptr, &stack) != 0 || (stack.ss_flags & SS_DISABLE) == 0) return;
  stack = {};
  stack.ss_sp = bytes_.data();
  stack.ss_size = bytes_.size();
  sigaltstack(&stack, nullptr);
}

int Thread::start(const char* name, const ThreadOptions& options, std::function<void()> body) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kThreadStack_bytes);
  sched_param parameters{};
  parameters.sched_priority = options.priority;
  if (options.priority > 0 && options.priority_required) {
    pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
    pthread_attr_setschedpolicy(&attributes, SCHED_FIFO);
    pthread_attr_setschedparam(&attributes, &parameters);
  }
  if (options.cpu >= 0) {
    cpu_set_t cpus;
    CPU_ZERO(&cpus);
    CPU_SET(static_cast<unsigned>(options.cpu), &cpus);
    pthread_attr_setaffinity_np(&attributes, sizeof cpus, &cpus);
  }
  body_ = std::move(body);
  sigset_t blocked;
  sigset_t before;
  sigfillset(&blocked);
  // A crash in this thread must still reach the handler that commands null.
  for (const int crash : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP}) {
    sigdelset(&blocked, crash);
  }
  pthread_sigmask(SIG_SETMASK, &blocked, &before);
  const int error = pthread_create(
      &handle_, &attributes,
      [](void* self) -> void* {
        auto* thread = static_cast<Thread*>(self);
        thread->signal_stack_.use();
        thread->body_();
        return nullptr;
      },
      this);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  pthread_attr_destroy(&attributes);
  running_ = error == 0;
  if (!running_) return error;
  pthread_setname_np(handle_, name);
  if (options.priority > 0 && !options.priority_required) {
    pthread_setschedparam(handle_, SCHED_FIFO, &parameters);
  }
  return 0;
}

int Thread::start_cyclic(const char* name, const ThreadOptions& options,
                         std::function<void()> body) {
  return start(name, options, [this, body = std::move(body)] {
    prctl(PR_SET_TIMERSLACK, 1UL);  // in the normal class a sleep would end 50 us late
    while (!stop_.load(std::memory_order_relaxed)) body();
  });
}

void Thread::stop() {
  stop_.store(true, std::memory_order_relaxed);
  join();
}

void Thread::join() {
  if (running_) pthread_join(handle_, nullptr);
  running_ = false;
}

bool Thread::join_for(std::chrono::milliseconds time) {
  if (!running_) return true;
  timespec until{};
  clock_gettime(CLOCK_MONOTONIC, &until);
  const auto ns = std::chrono::nanoseconds(time).count() + until.tv_nsec;
  until.tv_sec += ns / 1'000'000'000;
  until.tv_nsec = ns % 1'000'000'000;
  if (pthread_clockjoin_np(handle_, nullptr, CLOCK_MONOTONIC, &until) != 0) return false;
  running_ = false;
  return true;
}

}  // namespace hal
