// Alarms across a restart, and who did what: files that are there whole or not.
#include "daemon/io/alarm_store.h"

#include <gmock/gmock.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>
#include <sstream>

#include "daemon/io/audit.h"

namespace monitor::io {
namespace {

using estimator::fdi::Alarm;
using estimator::fdi::AlarmBook;
using estimator::fdi::AlarmInput;
using estimator::fdi::AlarmState;
using estimator::fdi::Severity;
using testing::HasSubstr;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class AlarmFiles : public testing::Test {
 protected:
  AlarmFiles() {
    std::string name = (std::filesystem::temp_directory_path() / "alarms-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~AlarmFiles() override { std::filesystem::remove_all(folder_); }

  static AlarmBook book() {
    AlarmBook book(1.0);
    Alarm alarm;
    alarm.source = "s";
    for (const char* name : {"a", "b"}) {
      alarm.name = name;
      book.declare(alarm);
    }
    return book;
  }
  static void come(AlarmBook& book, std::size_t number) {
    AlarmInput input;
    input.severity = Severity::major;
    input.direction = -1;
    input.value = 1.5;
    input.reason = "too \"low\"";
    book.set(number, input);
  }

  std::filesystem::path folder_;
};

TEST_F(AlarmFiles, GiveBackEveryLifeThatWasSaved) {
  AlarmBook before = book();
  come(before, 0);
  come(before, 1);
  before.shelve(1, 100.0, "bob");
  {
    BackgroundWriter writer;
    AlarmStore store(folder_ / "sub", "rig", writer);
    store.keep(before, 1'000'000'000);
    writer.finish();
  }
  BackgroundWriter writer;
  const AlarmStore store(folder_ / "sub", "rig", writer);
  const LoadedLives loaded = store.load(1'030'000'000);  // 30 s later
  EXPECT_EQ(loaded.wrong, "");
  ASSERT_EQ(loaded.lives.size(), 2U);
  EXPECT_EQ(loaded.lives[0].name, "a");
  EXPECT_EQ(loaded.lives[0].reason, "too \"low\"");
  EXPECT_EQ(loaded.lives[0].value, 1.5);
  EXPECT_EQ(loaded.lives[0].direction, -1);
  EXPECT_TRUE(loaded.lives[0].first_up);
  EXPECT_EQ(loaded.lives[1].shelved_for_s, 70.0);
  EXPECT_EQ(loaded.lives[1].shelved_by, "bob");
  AlarmBook after = book();
  after.restore(loaded.lives);
  EXPECT_EQ(after.alarm(0).state(), AlarmState::returned);
  EXPECT_EQ(after.alarm(1).state(), AlarmState::shelved);
  // A clock that was set back does not make the shelf longer, one that ran on ends it.
  EXPECT_EQ(store.load(500'000'000).lives[1].shelved_for_s, 100.0);
  EXPECT_EQ(store.load(2'000'000'000).lives[1].shelved_for_s, 0.0);
}

TEST_F(AlarmFiles, AreWrittenOnlyWhenALifeHasChanged) {
  AlarmBook alarms = book();
  come(alarms, 0);
  const auto keep = [&](AlarmStore& store, std::int64_t utc_us) { store.keep(alarms, utc_us); };
  {
    BackgroundWriter writer;
    AlarmStore store(folder_, "rig", writer);
    keep(store, 1'000'000);
    keep(store, 2'000'000);
    writer.finish();
  }
  EXPECT_THAT(text_of(folder_ / "alarms.json"), HasSubstr("\"saved_utc_us\": 1000000"));
}

TEST_F(AlarmFiles, DamagedOrOfAnotherRigGiveNothingAndSayWhy) {
  AlarmBook alarms = book();
  come(alarms, 0);
  const std::string good = print_lives(alarms.persisted_alarms(), "rig", 5);
  EXPECT_EQ(parse_lives(good, "rig", 5).lives.size(), 1U);
  EXPECT_EQ(parse_lives(good, "another", 5).wrong, "belongs to another rig: \"rig\"");
  EXPECT_TRUE(parse_lives(good, "another", 5).lives.empty());
  for (std::size_t size = 0; size + 2 < good.size(); size += 7) {
    const LoadedLives cut = parse_lives(good.substr(0, size), "rig", 5);
    EXPECT_TRUE(cut.lives.empty());
    EXPECT_NE(cut.wrong, "") << size;
  }
  for (const char* text : {"[]", "{}", "{\"format\": 3}",
                           "{\"format\":\"spoolwatch alarms\",\"version\":1,\"rig_id\":\"rig\","
                           "\"alarms\":[{\"source\":1}]}"}) {
    EXPECT_NE(parse_lives(text, "rig", 5).wrong, "") << text;
  }
  BackgroundWriter writer;
  EXPECT_EQ(AlarmStore(folder_ / "none", "rig", writer).load(5).wrong, "");
}

TEST_F(AlarmFiles, HistoryWaitsForADiskThatIsFull) {
  std::filesystem::create_directory(folder_ / "history.log");  // in the way, as a full disk is
  BackgroundWriter writer;
  AlarmStore store(folder_, "rig", writer);
  estimator::fdi::Alarm alarm;
  alarm.source = "loop";
  alarm.name = "n";
  alarm.active = true;
  store.note(alarm, 1'000'000);
  const auto waiting = [&](std::size_t lines) {
    for (int i = 0; i < 1000 && store.waiting_history() != lines; ++i) usleep(2000);
    return store.waiting_history() == lines;
  };
  EXPECT_TRUE(waiting(2)) << "the start and the alarm";
  constexpr std::size_t kChanges = 600;  // more than are written together
  for (std::size_t i = 1; i <= kChanges; ++i) {
    alarm.active = !alarm.active;
    store.note(alarm, 1'000'000 * static_cast<std::int64_t>(1 + i));
    if (i % 100 == 0) {
      EXPECT_TRUE(waiting(2 + i));  // the writer's queue is shorter
    }
  }
  EXPECT_EQ(store.lost_history(), 0);
  std::filesystem::remove(folder_ / "history.log");
  store.retry_history();
  EXPECT_TRUE(waiting(102));
  store.retry_history();
  EXPECT_TRUE(waiting(0));
  std::istringstream text(text_of(folder_ / "history.log"));
  std::vector<std::string> times;
  std::string line;
  while (std::getline(text, line)) times.push_back(nlohmann::json::parse(line).at("utc"));
  ASSERT_EQ(times.size(), 2 + kChanges);
  EXPECT_TRUE(std::is_sorted(times.begin() + 1, times.end())) << "in the order of their coming";
}

TEST_F(AlarmFiles, AreNotWrittenThroughALinkInTheWay) {
  const std::filesystem::path file = folder_ / "alarms.json";
  std::ofstream(folder_ / "other") << "of somebody";
  std::filesystem::create_symlink("other", folder_ / "alarms.json.new");
  EXPECT_NE(write_durably(file, "new"), 0);
  EXPECT_EQ(text_of(folder_ / "other"), "of somebody");
}

TEST_F(AlarmFiles, ThatCannotBeWrittenLeaveTheOldOne) {
  const std::filesystem::path file = folder_ / "alarms.json";
  ASSERT_EQ(write_durably(file, "old"), 0);
  std::filesystem::create_directory(folder_ / "alarms.json.new");  // in the way
  EXPECT_NE(write_durably(file, "new"), 0);
  EXPECT_EQ(text_of(file), "old");
}

TEST_F(AlarmFiles, AreWrittenAlsoWhenWhoAskedForItIsGone) {
  AlarmBook alarms = book();
  come(alarms, 0);
  std::promise<void> go_on;
  {
    BackgroundWriter writer;
    writer.post([done = go_on.get_future().share()] { done.wait(); });
    {
      AlarmStore store(folder_, "rig", writer);
      store.keep(alarms, 1'000'000);
      Audit audit(folder_, 4096, writer);
      audit.note({1'000'000, 1000, "ann", "{}", ""});
    }
    go_on.set_value();
  }
  EXPECT_THAT(text_of(folder_ / "alarms.json"), HasSubstr("\"saved_utc_us\": 1000000"));
  EXPECT_THAT(text_of(folder_ / "audit.log"), HasSubstr("ann"));
}

TEST_F(AlarmFiles, AuditKeepsItsActsWhenRejectionsFloodIt) {
  for (const bool may_act : {true, false}) {
    BackgroundWriter writer;
    {
      Audit audit(folder_, 1 << 14, writer);
      for (int i = 0; i < 5; ++i)
        audit.note({1'000'000LL * i, 0, "root", "{\"command\":\"arm\"}", ""});
      for (int i = 0; i < 20000; ++i) {
        audit.note({10'000'000LL + i, 65534, "nobody", std::string(500, 'x'), "no", may_act});
      }
    }
    writer.finish();
    const std::string acts = text_of(folder_ / "audit.log") + text_of(folder_ / "audit.log.1");
    std::size_t arms = 0;
    for (std::size_t at = 0; (at = acts.find("arm", at)) != std::string::npos; ++at) ++arms;
    EXPECT_EQ(arms, 5U) << "may act: " << may_act;
    const std::string refused = may_act ? acts : text_of(folder_ / "refused.log");
    EXPECT_THAT(refused, HasSubstr("\"not_listed\":19980")) << "none goes uncounted";
    if (!may_act) {
      EXPECT_THAT(acts, testing::Not(HasSubstr("nobody")));
    }
    std::filesystem::remove(folder_ / "audit.log");
  }
}

TEST_F(AlarmFiles, AuditHasALineForEachActAndStaysWithinItsSize) {
  BackgroundWriter writer;
  Audit audit(folder_, 4096, writer);
  for (int i = 0; i < 200; ++i) {
    audit.note({1'000'000LL * i, 1000, "ann", "{\"command\":\"ack\"}", i == 3 ? "no" : ""});
  }
  writer.finish();
  EXPECT_EQ(audit.lost(), 0);
  const auto newest = std::filesystem::file_size(folder_ / "audit.log");
  const auto before = std::filesystem::file_size(folder_ / "audit.log.1");
  EXPECT_LE(newest, 4096U);
  EXPECT_LE(before, 4096U);
  EXPECT_GT(newest + before, 4096U);
  std::istringstream lines(text_of(folder_ / "audit.log"));
  std::string last;
  for (std::string line; std::getline(lines, line);) last = line;
  const auto entry = nlohmann::json::parse(last);
  EXPECT_EQ(entry["utc"], "1970-01-01T00:03:19.000Z");
  EXPECT_EQ(entry["uid"], 1000);
  EXPECT_EQ(entry["who"], "ann");
  EXPECT_EQ(entry["what"], "{\"command\":\"ack\"}");
  EXPECT_EQ(entry["done"], true);
  EXPECT_THAT(print_audit({0, 7, "x", "y", "no"}), HasSubstr("\"done\":false,\"reason\":\"no\""));
}

}  // namespace
}  // namespace monitor::io
