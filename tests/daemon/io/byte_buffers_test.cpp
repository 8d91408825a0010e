#include "daemon/io/byte_buffers.h"

#include <gtest/gtest.h>
#include <thread>

namespace monitor::io {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes record_of(std::size_t size, int seed) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(seed + 7 * i);
  return bytes;
}

TEST(ByteQueue, GivesBackRecordsOfEverySizeInOrderAcrossItsEnd) {
  ByteQueue queue(100);
  Bytes out;
  for (int i = 0; i < 200; ++i) {
    const Bytes head = record_of(static_cast<std::size_t>(i % 13), i);
    const Bytes tail = record_of(static_cast<std::size_t>(i % 31), i + 1);
    ASSERT_TRUE(queue.push(head, tail));
    ASSERT_TRUE(queue.pop(out));
    Bytes both = head;
    both.insert(both.end(), tail.begin(), tail.end());
    EXPECT_EQ(out, both);
  }
  EXPECT_FALSE(queue.pop(out));
}

TEST(ByteQueue, RefusesWhatDoesNotFitAndTakesItOnceThereIsRoom) {
  ByteQueue queue(40);  // 4 + 16 bytes a record: two fit exactly
  const Bytes sixteen = record_of(16, 1);
  EXPECT_TRUE(queue.push(sixteen, {}));
  EXPECT_TRUE(queue.push(sixteen, {}));
  EXPECT_FALSE(queue.push({}, {}));
  Bytes out;
  EXPECT_TRUE(queue.pop(out));
  EXPECT_TRUE(queue.push(sixteen, {}));
}

TEST(ByteQueue, PassesEveryRecordFromOneThreadToAnother) {
  constexpr int kRecords = 50'000;
  ByteQueue queue(500);
  std::thread producer([&] {
    for (int i = 0; i < kRecords;) {
      if (queue.push(record_of(static_cast<std::size_t>(1 + i % 60), i), {})) {
        ++i;
      } else {
        std::this_thread::yield();
      }
    }
  });
  Bytes out;
  int wrong = 0;
  for (int i = 0; i < kRecords;) {
    if (!queue.pop(out)) {
      std::this_thread::yield();
      continue;
    }
    wrong += out == record_of(static_cast<std::size_t>(1 + i % 60), i) ? 0 : 1;
    ++i;
  }
  producer.join();
  EXPECT_EQ(wrong, 0);
}

TEST(ByteBacklog, KeepsTheNewestAndCountsTheOldestItOverwrites) {
  ByteBacklog backlog(100);  // five records of 4 + 16 bytes
  std::int64_t lost = 0;
  for (int i = 0; i < 12; ++i) lost += backlog.push(record_of(16, i));
  EXPECT_EQ(lost, 7);
  EXPECT_EQ(backlog.records(), 5);
  Bytes out;
  int expected = 7;
  for (auto at = backlog.begin(); at != backlog.end(); ++expected) {
    at = backlog.read(at, out);
    EXPECT_EQ(out, record_of(16, expected));
  }
  EXPECT_EQ(expected, 12);
}

TEST(ByteBacklog, LosesARecordLargerThanAllOfIt) {
  ByteBacklog backlog(50);
  EXPECT_EQ(backlog.push(record_of(10, 0)), 0);
  EXPECT_EQ(backlog.push(record_of(47, 0)), 1);
  EXPECT_EQ(backlog.records(), 1);
}

}  // namespace
}  // namespace monitor::io
