// A live channel passes the daemon's messages on to pages that watch: samples in batches,
// estimates, health, and the error of a model beside them. It listens only while a page watches.
//
// A page that begins to watch catches up with the last minute in batches of bounded size, apart
// from the other pages: "history" until it has all, then "samples".
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "workbench/serve/http_server.h"

namespace workbench::serve {

struct LiveOptions {
  std::string url;
  std::string prefix;
};

class LiveChannel {
 public:
  /// Sends the event `name` with JSON text to these pages.
  using Publish = std::function<void(const std::vector<StreamId>& pages, const char* name,
                                     const std::string& json)>;

  /// `publish` and `every_second` are called on this object's own thread.
  LiveChannel(LiveOptions options, Publish publish, std::function<void()> every_second);
  ~LiveChannel() { end(); }
  LiveChannel(const LiveChannel&) = delete;
  LiveChannel& operator=(const LiveChannel&) = delete;

  /// Waits for its thread; nothing is published afterwards.
  void end();
  /// May be called from any thread when a page begins or ends to watch.
  void open(StreamId page);
  void close(StreamId page);
  /// May be called from any thread. Sets the model file that runs beside the samples; empty: none.
  void watch_model(std::string file);

 private:
  struct Wish {
    bool ends = false;
    std::set<StreamId> pages;
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
