#include "daemon/control/arming.h"

#include <gtest/gtest.h>

#include <initializer_list>

namespace monitor::control {
namespace {

constexpr Event kEvents[] = {Event::arm,  Event::disarm, Event::start,
                             Event::stop, Event::reset,  Event::trip};

Arming after(std::initializer_list<Event> events) {
  Arming arming(false);
  for (const Event event : events) arming.apply(event);
  return arming;
}

TEST(Arming, StartsDisarmedAndNeedsArmThenStartToRun) {
  Arming arming(false);
  EXPECT_EQ(arming.state(), ArmingState::disarmed);
  EXPECT_FALSE(arming.apply(Event::start)) << "a start without arming must be refused";
  EXPECT_EQ(arming.state(), ArmingState::disarmed);
  EXPECT_TRUE(arming.apply(Event::arm));
  EXPECT_EQ(arming.state(), ArmingState::armed);
  EXPECT_TRUE(arming.apply(Event::start));
  EXPECT_EQ(arming.state(), ArmingState::run);
}

TEST(Arming, StopKeepsItArmedAndDisarmDoesNot) {
  EXPECT_EQ(after({Event::arm, Event::start, Event::stop}).state(), ArmingState::armed);
  EXPECT_EQ(after({Event::arm, Event::start, Event::disarm}).state(), ArmingState::disarmed);
  EXPECT_EQ(after({Event::arm, Event::disarm}).state(), ArmingState::disarmed);
}

TEST(Arming, LatchesAfterATripUntilReset) {
  Arming arming = after({Event::arm, Event::start, Event::trip});
  for (const Event event : {Event::arm, Event::start, Event::stop, Event::disarm, Event::trip}) {
    arming.apply(event);
    EXPECT_EQ(arming.state(), ArmingState::latched);
  }
  EXPECT_TRUE(arming.apply(Event::reset));
  EXPECT_EQ(arming.state(), ArmingState::disarmed) << "a reset must not lead back to motion";
}

TEST(Arming, NeverLeavesMonitor) {
  Arming arming(true);
  for (const Event event : kEvents) {
    EXPECT_FALSE(arming.apply(event));
    EXPECT_EQ(arming.state(), ArmingState::monitor);
  }
}

}  // namespace
}  // namespace monitor::control
