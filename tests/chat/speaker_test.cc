#include "chat/core/speaker.h"

#include <gtest/gtest.h>

namespace chat {
namespace {

TEST(HeardPartTest, TheTextIsKeptUpToTheLastWordHeard) {
  EXPECT_EQ(HeardPart("Well, \"my name\" is Anna.", "well my name"), "Well, \"my name");
  EXPECT_EQ(HeardPart("Hello there.", "Hello there"), "Hello there");
  EXPECT_EQ(HeardPart("It costs 5 dollars.", "it costs five"), "it costs five");
  EXPECT_EQ(HeardPart("Hello.", ""), "");
}

}  // namespace
}  // namespace chat
