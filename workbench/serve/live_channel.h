// A live channel passes the daemon's messages on to pages that watch: samples in batches,
// estimates, health, and the error of a model beside them. It listens while a page watches, and for
// some seconds more.
//
// A page that begins to watch catches up with the last minute in batches of bounded size, apart
// from the other pages: "history" until it has all, then "samples".
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "workbench/serve/http_server.h"
#include "workbench/serve/live_points.h"
#include "workbench/serve/trigger.h"

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
  /// May be called from any thread. While a page watches, the samples about each crossing are
  /// captured at the full rate; the pages get the event "capture".
  void set_trigger(const TriggerSettings& settings);
  /// May be called from any thread. The capture of that number, 0: the newest; null: none such, or
  /// no longer kept.
  [[nodiscard]] std::shared_ptr<const Capture> capture(std::uint64_t number = 0) const;

 private:
  struct Wish {
    bool ends = false;
    std::set<StreamId> pages;
    std::string model;
    TriggerSettings trigger;
    std::uint64_t triggers_set = 0;  ///< counts them: the same ones again begin again
  };
  void run();
  void listen();
  [[nodiscard]] Wish wish() const;
  /// Keeps it as the newest, with its number.
  std::shared_ptr<const Capture> number(const std::shared_ptr<const Capture>& capture);
  void show_capture(const std::shared_ptr<const Capture>& capture,
                    const std::vector<StreamId>& pages);

  const LiveOptions options_;
  const Publish publish_;
  const std::function<void()> every_second_;
  mutable std::mutex mutex_;
  std::condition_variable wakes_;
  Wish wish_;
  std::deque<std::shared_ptr<const Capture>> kept_;  ///< the newest is the last
  std::uint64_t captures_ = 0;
  std::thread thread_;
};

}  // namespace workbench::serve
