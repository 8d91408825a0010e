// Work in the background: its order, and what an exception ends.
#include <gtest/gtest.h>

#include <atomic>
#include <semaphore>
#include <stdexcept>
#include <string>
#include <thread>

#include "workbench/serve/jobs.h"
#include "workbench/serve/lane.h"

namespace workbench::serve {
namespace {

/// Work that keeps a lane busy until it is released.
class Blocker {
 public:
  explicit Blocker(Lane& lane) {
    lane.post([this] {
      begun_ = true;
      while (!released_) std::this_thread::yield();
    });
    while (!begun_) std::this_thread::yield();
  }
  void release() { released_ = true; }

 private:
  std::atomic<bool> begun_{false};
  std::atomic<bool> released_{false};
};

TEST(Jobs, AnExceptionBehindAJobEndsNothing) {
  Jobs jobs;
  std::binary_semaphore ended(0);
  const auto fails = [&](const JobResult& result) {
    EXPECT_NE(result.error, "");
    EXPECT_TRUE(jobs.running()) << "until its result is taken";
    ended.release();
    throw std::runtime_error("behind the job");
  };
  for (int i = 0; i < 2; ++i) {
    while (jobs.running()) std::this_thread::yield();
    fit::FitRequest request;
    request.model = "none.toml";
    request.records = {"none.csv"};
    ASSERT_TRUE(jobs.fit(std::move(request), {}, fails));
    ended.acquire();
  }
}

TEST(Jobs, OneRunsUntilItsResultIsTaken) {
  Jobs jobs;
  std::binary_semaphore ended(0);
  const auto ends = [&](const JobResult& /*result*/) { ended.release(); };
  fit::FitRequest request;
  request.model = "none.toml";
  request.records = {"none.csv"};
  ASSERT_TRUE(jobs.fit(request, {}, ends));
  ended.acquire();
  EXPECT_TRUE(jobs.running());
  EXPECT_FALSE(jobs.fit(request, {}, ends));
  jobs.taken();
  ASSERT_TRUE(jobs.fit(request, {}, ends));
  ended.acquire();
}

TEST(Lane, AnExceptionEndsItsOwnWorkAlone) {
  std::binary_semaphore done(0);
  Lane lane;
  lane.post([] { throw std::runtime_error("one thing has failed"); });
  lane.post([] { throw 3; });
  lane.post([&] { done.release(); });
  EXPECT_TRUE(done.try_acquire_for(std::chrono::seconds(10)));
}

TEST(Lane, WhatIsKeptIsDoneBeforeItEndsAndTheRestIsDropped) {
  std::string done;
  Lane lane;
  Blocker blocker(lane);
  lane.post([&] { done += 'a'; });
  lane.post_kept([&] { done += 'b'; });
  lane.post([&] { done += 'c'; });
  lane.post_kept([&] { done += 'd'; });
  std::thread ends([&] { lane.end(); });
  while (lane.waiting() > 2) std::this_thread::yield();  // the other two are dropped
  blocker.release();
  ends.join();
  lane.post_kept([&] { done += 'e'; });
  EXPECT_EQ(done, "bd");
}

TEST(Lane, OnlyTheLatestOfWhatWaitsIsDone) {
  std::string done;
  {
    Lane lane;
    Blocker blocker(lane);
    for (const char name : {'a', 'b', 'c'}) {
      lane.post_latest([&done, name] { done += name; },
                       [&done, name] { done += static_cast<char>(name - 'a' + 'A'); });
    }
    blocker.release();
    std::atomic<bool> last{false};
    lane.post([&] { last = true; });
    while (!last) std::this_thread::yield();
  }
  EXPECT_EQ(done, "ABc");
}

}  // namespace
}  // namespace workbench::serve
