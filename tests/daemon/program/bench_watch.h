// Between a test and the bench rig: a client that watches it, a cable that can be cut.
#pragma once

#include <gtest/gtest.h>
#include <modbus/modbus.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "hal/hil_rig/register_map.h"
#include "hal/monotonic.h"
#include "tests/daemon/program/null_watch.h"

namespace program {

inline double real(const std::uint16_t* words) {
  return static_cast<double>(modbus_get_float_abcd(words));
}

/// Looks at the rig as often as it answers, on a connection of its own.
class Watcher {
 public:
  explicit Watcher(int port) : bus_(modbus_new_tcp("127.0.0.1", port)) {
    EXPECT_EQ(modbus_connect(bus_), 0);
    thread_ = std::thread([this] { watch(); });
  }
  ~Watcher() {
    ended_ = true;
    thread_.join();
    modbus_close(bus_);
    modbus_free(bus_);
  }
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  std::vector<Look> looks() {
    const std::lock_guard lock(mutex_);
    return looks_;
  }
  /// Waits, ten seconds at most, until a look fulfils it.
  bool wait_for(const std::function<bool(const Look&)>& wanted) {
    for (int i = 0; i < 10000; ++i) {
      {
        const std::lock_guard lock(mutex_);
        if (!looks_.empty() && wanted(looks_.back())) return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }

 private:
  void watch() {
    std::uint16_t words[8];
    while (!ended_) {
      Look look{};
      look.before_ns = hal::monotonic_ns();
      if (modbus_read_registers(bus_, hal::hil_rig::kCommand, 8, words) != 8) continue;
      look.after_ns = hal::monotonic_ns();
      look.command_V = real(words);
      look.rod_m = real(words + hal::hil_rig::kPosition - hal::hil_rig::kCommand);
      look.valve_V = real(words + hal::hil_rig::kValve - hal::hil_rig::kCommand);
      {
        const std::lock_guard lock(mutex_);
        looks_.push_back(look);
      }
      std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
  }

  modbus_t* bus_;
  std::atomic<bool> ended_{false};
  std::mutex mutex_;
  std::vector<Look> looks_;
  std::thread thread_;
};

/// A cable between daemon and rig that can be cut: what is sent afterwards is lost.
class Cable {
 public:
  explicit Cable(int rig_port) : rig_port_(rig_port), listener_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address = loopback(0);
    EXPECT_EQ(bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(listen(listener_, 8), 0);
    socklen_t size = sizeof address;
    getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { carry(); });
  }
  ~Cable() {
    ended_ = true;
    thread_.join();
    close(listener_);
    for (const auto& [one, other] : pairs_) {
      close(one);
      close(other);
    }
  }
  Cable(const Cable&) = delete;
  Cable& operator=(const Cable&) = delete;
  void cut() { cut_ = true; }
  /// From now on reads are answered with exception 11, as by a gateway whose device is silent.
  void refuse_reads() { refuses_reads_ = true; }
  /// From now on no read is answered.
  void swallow_reads() { swallows_reads_ = true; }
  [[nodiscard]] std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

 private:
  static sockaddr_in loopback(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    return address;
  }
  void carry() {
    const sched_param prompt{70};
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &prompt);  // else the normal class
    while (!ended_) {
      std::vector<pollfd> files{{listener_, POLLIN, 0}};
      for (const auto& [one, other] : pairs_) {
        files.push_back({one, POLLIN, 0});
        files.push_back({other, POLLIN, 0});
      }
      if (poll(files.data(), files.size(), 20) <= 0) continue;
      for (std::size_t i = 0; i < pairs_.size(); ++i) {
        if (files[2 * i + 1].revents != 0) pass(pairs_[i].first, pairs_[i].second, false);
        if (files[2 * i + 2].revents != 0) pass(pairs_[i].second, pairs_[i].first, true);
      }
      if (files[0].revents == 0) continue;
      const int client = accept(listener_, nullptr, nullptr);
      const int rig = socket(AF_INET, SOCK_STREAM, 0);
      const int at_once = 1;
      for (const int file : {client, rig}) {
        setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
      }
      const sockaddr_in address = loopback(rig_port_);
      (void)connect(rig, reinterpret_cast<const sockaddr*>(&address), sizeof address);
      pairs_.emplace_back(client, rig);
    }
  }
  void pass(int from, int to, bool from_rig) const {
    char bytes[512];
    ssize_t n = recv(from, bytes, sizeof bytes, 0);
    const bool reading = n > 8 && bytes[7] == 3 && from_rig;
    if (reading && swallows_reads_) return;
    if (reading && refuses_reads_) {
      bytes[4] = 0;
      bytes[5] = 3;
      bytes[7] = static_cast<char>(0x83);
      bytes[8] = 11;
      n = 9;
    }
    if (n > 0 && !cut_) (void)send(to, bytes, static_cast<std::size_t>(n), MSG_NOSIGNAL);
    if (n <= 0) {
      shutdown(to, SHUT_RDWR);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  int rig_port_;
  int listener_;
  int port_ = 0;
  std::atomic<bool> cut_{false};
  std::atomic<bool> refuses_reads_{false};
  std::atomic<bool> swallows_reads_{false};
  std::atomic<bool> ended_{false};
  std::vector<std::pair<int, int>> pairs_;
  std::thread thread_;
};

}  // namespace program
