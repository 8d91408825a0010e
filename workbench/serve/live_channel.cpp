#include "workbench/serve/live_channel.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "workbench/live/listen_feed.h"
#include "workbench/present/printed_axis.h"
#include "workbench/serve/live_listener.h"

namespace workbench::serve {
namespace {

using nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kBatch{100};
constexpr std::chrono::seconds kStatus{1};
constexpr std::chrono::seconds kFigures{5};  ///< a comparison over the last half minute
constexpr std::chrono::seconds kRetry{1};
/// A page that loads itself again finds the last minute, and a trigger as it was.
constexpr std::size_t kKeptCaptures = 4;
constexpr std::chrono::seconds kLinger{15};
/// Most numbers in a batch: some 200 kB of text.
constexpr std::uint64_t kMostNumbers = 20'000;

struct Batch {
  std::vector<StreamId> pages;
  const char* name;
  std::string json;
};

/// How far each page is.
class Pages {
 public:
  /// Those that have come.
  std::vector<StreamId> set(const std::set<StreamId>& open) {
    std::erase_if(pages_, [&](const auto& page) { return open.count(page.first) == 0; });
    std::vector<StreamId> begin;
    for (const StreamId page : open) {
      if (pages_.try_emplace(page).second) begin.push_back(page);
    }
    return begin;
  }
  /// Another run: all that came before is of no use.
  void begin_again() {
    for (auto& [id, place] : pages_) place = {};
  }
  /// The points that the pages lack, at most kMostNumbers for each; pages at the same place share
  /// one.
  std::vector<Batch> next(const LiveListener& listener) {
    std::map<Place, std::vector<StreamId>> places;
    for (const auto& [id, place] : pages_) places[place].push_back(id);
    std::vector<Batch> batches;
    const LiveChoice choice = listener.choice();
    const std::uint64_t most = kMostNumbers / (choice.size() + 1);
    for (auto& [place, ids] : places) {
      const std::uint64_t from = std::max(place.next, listener.begin());
      const std::uint64_t to = std::min(listener.end(), from + most);
      if (from == to) continue;
      const Place then{to, true, place.caught_up || to == listener.end()};
      for (const StreamId id : ids) pages_[id] = then;
      const std::vector<LivePoint> points = listener.part(from, to);
      std::string json = "{";
      if (!place.caught_up) {
        json += fmt::format("\"to\":{:.6f},\"begins\":{},\"newest\":{:.6f},", points.back().t_s,
                            !place.begun, listener.newest_s());
      }
      json += columns_json(points, points.front().t_s, choice) + "}";
      batches.push_back({std::move(ids), place.caught_up ? "samples" : "history", std::move(json)});
    }
    return batches;
  }

 private:
  struct Place {
    std::uint64_t next = 0;  ///< number of the first point that it lacks
    bool begun = false;
    bool caught_up = false;
    bool operator<(const Place& other) const {
      return std::tie(next, begun, caught_up) < std::tie(other.next, other.begun, other.caught_up);
    }
  };
  std::map<StreamId, Place> pages_;
};

std::string text_of(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

LiveChannel::LiveChannel(LiveOptions options, Publish publish, std::function<void()> every_second)
    : options_(std::move(options)),
      publish_(std::move(publish)),
      every_second_(std::move(every_second)),
      thread_([this] { run(); }) {}

void LiveChannel::end() {
  {
    const std::lock_guard lock(mutex_);
    wish_.ends = true;
  }
  wakes_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void LiveChannel::open(StreamId page) {
  {
    const std::lock_guard lock(mutex_);
    wish_.pages.insert(page);
  }
  wakes_.notify_one();
}

void LiveChannel::close(StreamId page) {
  const std::lock_guard lock(mutex_);
  wish_.pages.erase(page);
}

void LiveChannel::watch_model(std::string file) {
  const std::lock_guard lock(mutex_);
  wish_.model = std::move(file);
}

void LiveChannel::set_trigger(const TriggerSettings& settings) {
  const std::lock_guard lock(mutex_);
  wish_.trigger = settings;
  ++wish_.triggers_set;
}

std::shared_ptr<const Capture> LiveChannel::capture(std::uint64_t number) const {
  const std::lock_guard lock(mutex_);
  for (auto one = kept_.rbegin(); one != kept_.rend(); ++one) {
    if (number == 0 || (*one)->number == number) return *one;
  }
  return nullptr;
}

std::shared_ptr<const Capture> LiveChannel::number(const std::shared_ptr<const Capture>& capture) {
  auto numbered = std::make_shared<Capture>(*capture);
  const std::lock_guard lock(mutex_);
  numbered->number = ++captures_;
  kept_.push_back(numbered);
  if (kept_.size() > kKeptCaptures) kept_.pop_front();
  return numbered;
}

void LiveChannel::show_capture(const std::shared_ptr<const Capture>& capture,
                               const std::vector<StreamId>& pages) {
  if (capture && !pages.empty()) publish_(pages, "capture", to_json(*capture));
}

LiveChannel::Wish LiveChannel::wish() const {
  const std::lock_guard lock(mutex_);
  return wish_;
}

void LiveChannel::run() {
  while (true) {
    {
      std::unique_lock lock(mutex_);
      wakes_.wait(lock, [this] { return wish_.ends || !wish_.pages.empty(); });
      if (wish_.ends) return;
    }
    try {
      listen();
    } catch (const std::exception& error) {
      const ordered_json status{{"age_s", nullptr}, {"notice", error.what()}};
      const std::set<StreamId> pages = wish().pages;
      publish_({pages.begin(), pages.end()}, "status", text_of(status));
      std::unique_lock lock(mutex_);
      wakes_.wait_for(lock, kRetry, [this] { return wish_.ends; });
    }
  }
}

void LiveChannel::listen() {
  LiveListener listener;
  live::ListenFeed feed(options_.url, options_.prefix, true, listener);
  Pages pages;
  std::string model;
  std::uint64_t triggers_set = 0;
  Clock::time_point told{};
  Clock::time_point compared{};
  Clock::time_point watched = Clock::now();
  while (true) {
    const Wish now = wish();
    if (now.ends) return;
    if (!now.pages.empty()) watched = Clock::now();
    if (Clock::now() - watched > kLinger) return;
    if (now.model != model) {
      model = now.model;
      listener.watch(model);
    }
    const present::PrintedAxis axis(listener.motion());
    if (now.triggers_set != triggers_set) {
      triggers_set = now.triggers_set;
      listener.set_trigger(now.trigger);
      told = {};
    }
    const bool more = feed.poll(kBatch);
    if (listener.take_restarted()) pages.begin_again();
    const std::vector<StreamId> begin = pages.set(now.pages);
    if (!begin.empty()) told = {};
    for (const Batch& batch : pages.next(listener)) publish_(batch.pages, batch.name, batch.json);
    show_capture(capture(), begin);
    if (const auto made = listener.take_capture()) {
      show_capture(number(made), {now.pages.begin(), now.pages.end()});
      told = {};
    }
    if (!now.pages.empty() && Clock::now() - told >= kStatus) {
      told = Clock::now();
      if (told - compared >= kFigures) {
        compared = told;
        listener.update_model_figures();
      }
      publish_({now.pages.begin(), now.pages.end()}, "status", text_of(listener.status()));
      every_second_();
    }
    // After the end of a log its last picture stays.
    if (!more) std::this_thread::sleep_for(kBatch);
  }
}

}  // namespace workbench::serve
