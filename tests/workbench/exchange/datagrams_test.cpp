#include "workbench/exchange/udp_sender.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace workbench::exchange {
namespace {

using nlohmann::json;

exchange::Message message(exchange::Tree values) {
  return {"estimate", "estimate/period", 1'500'000'000, std::move(values)};
}

TEST(Datagrams, KeepASmallMessageInOnePiece) {
  EXPECT_THAT(
      exchange::datagrams_of(message({{"b1", {{"value", 2.0}}}})),
      testing::ElementsAre(R"({"timestamp":1.5,"estimate":{"period":{"b1":{"value":2.0}}}})"));
}

TEST(Datagrams, CutALargeMessageIntoPiecesThatTogetherAreTheWhole) {
  exchange::Tree values;
  for (int i = 0; i < 100; ++i) {
    values["parameter_" + std::to_string(i)] = {{"value", i * 0.1}, {"low", nullptr}, {"high", i}};
  }
  const std::vector<std::string> pieces = exchange::datagrams_of(message(values));
  EXPECT_GT(pieces.size(), 3U);
  json whole;
  for (const std::string& piece : pieces) {
    EXPECT_LE(piece.size(), exchange::kMostDatagramBytes);
    const json tree = json::parse(piece);
    EXPECT_EQ(tree["timestamp"], 1.5);
    whole.merge_patch(tree);
    for (const auto& [name, parts] : tree["estimate"]["period"].items()) {
      EXPECT_TRUE(parts.contains("value") || parts.contains("high") || parts.contains("low"));
    }
  }
  EXPECT_EQ(whole["estimate"]["period"].size(), 100U);
  EXPECT_EQ(whole["estimate"]["period"]["parameter_99"]["high"], 99);
}

TEST(Datagrams, CutATextThatIsTooLongAndNoLetterInHalf) {
  const std::vector<std::string> pieces = exchange::datagrams_of(
      message({{"reason", std::string(99, 'a') + "\xC2\xB0" + std::string(2000, 'b')}}));
  ASSERT_EQ(pieces.size(), 1U);
  const json tree = json::parse(pieces[0]);
  EXPECT_EQ(tree["estimate"]["period"]["reason"], std::string(99, 'a') + "...");
}

}  // namespace
}  // namespace workbench::exchange
