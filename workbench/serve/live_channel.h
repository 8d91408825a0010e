// A live channel passes the daemon's messages on to pages that watch: samples in batches,
// estimates, health, and the error of a model beside them. It listens only while a page watches.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

namespace workbench::serve {

struct LiveOptions {
  std::string url;
  std::string prefix;
};

class LiveChannel {
 public:
  using Publish = std::function<void(const char* name, const nlohmann::ordered_json& data)>;

  /// `publish` and `every_second` are called on this object's own thread.
  LiveChannel(LiveOptions options, Publish publish, std::function<void()> every_second);
  ~LiveChannel() { end(); }
  LiveChannel(const LiveChannel&) = delete;
  LiveChannel& operator=(const LiveChannel&) = delete;

  /// Waits for its thread; nothing is published afterwards.
  void end();
  /// May be called from any thread when a page begins or ends to watch.
  void want(bool wanted);
  /// May be called from any thread. Sets the model file that runs beside the samples; empty: none.
  void watch_model(std::string file);

 private:
  struct Wish {
    bool wanted = false;
    bool ends = false;
    std::uint64_t pages = 0;  ///< counts calls of want(true): each gets the history
    std::string model;
  };
  void run();
  void listen();
  [[nodiscard]] Wish wish() const;

  const LiveOptions options_;
  const Publish publish_;
  const std::function<void()> every_second_;
  mutable std::mutex mutex_;
  std::condition_variable wakes_;
  Wish wish_;
  std::thread thread_;
};

}  // namespace workbench::serve
