// Messages with lengths that do not fit, as damage or malice makes them.
#include "config/messages/decode.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/sample_t.hpp"

namespace config::messages {
namespace {

template <class Message>
std::string encoded(const Message& message) {
  std::string bytes(static_cast<std::size_t>(message.getEncodedSize()), '\0');
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

spoolwatch::estimate_t estimate() {
  spoolwatch::estimate_t message{};
  message.source = "period";
  message.reason = "short";
  message.size = 2;
  message.name = {"a1", "b1"};
  message.value = message.std_error = message.low = message.high = {1.0, 2.0};
  return message;
}

template <class Message>
bool decodes(const std::string& bytes) {
  Message message{};
  return decode(message, bytes.data(), static_cast<int>(bytes.size()));
}

TEST(Decode, TakesWhatWasEncodedOfEveryType) {
  EXPECT_TRUE(decodes<spoolwatch::sample_t>(encoded(spoolwatch::sample_t{})));
  EXPECT_TRUE(decodes<spoolwatch::estimate_t>(encoded(estimate())));
  EXPECT_FALSE(decodes<spoolwatch::sample_t>(encoded(estimate())));
  spoolwatch::alarm_t alarm{};
  alarm.group_size = 2;
  alarm.ambiguity_group = {"gain", "Ps"};
  EXPECT_TRUE(decodes<spoolwatch::alarm_t>(encoded(alarm)));
  spoolwatch::health_t health{};
  health.device_count = 2;
  health.device = {"rod", "valve"};
  health.device_good = health.device_bad = {7, 8};
  EXPECT_TRUE(decodes<spoolwatch::health_t>(encoded(health)));
}

TEST(Decode, RefusesEveryCut) {
  const std::string whole = encoded(estimate());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(decodes<spoolwatch::estimate_t>(whole.substr(0, size))) << size;
  }
}

TEST(Decode, RefusesCountsAndLengthsThatAreNotThere) {
  const std::string whole = encoded(estimate());
  // hash, four int64_t, then the length of source; size stands four bytes before the first name.
  const std::size_t source_at = 8 + 4 * 8;
  const std::size_t size_at = whole.find("a1") - 8;
  ASSERT_EQ(whole.substr(size_at, 4), std::string("\0\0\0\2", 4));
  ASSERT_EQ(whole.substr(source_at, 4), std::string("\0\0\0\7", 4));
  for (const std::size_t at : {source_at, size_at}) {
    for (const std::string& number :
         {std::string("\x7F\xFF\xFF\xFF", 4), std::string("\xFF\xFF\xFF\xFF", 4),
          std::string("\0\0\1\0", 4), std::string("\x80\0\0\0", 4)}) {
      std::string bytes = whole;
      bytes.replace(at, 4, number);
      EXPECT_FALSE(decodes<spoolwatch::estimate_t>(bytes)) << at;
    }
  }
  std::string empty_text = whole;
  empty_text.replace(source_at, 4, std::string(4, '\0'));  // not even the null byte
  EXPECT_FALSE(decodes<spoolwatch::estimate_t>(empty_text));
}

}  // namespace
}  // namespace config::messages
