#include "ssm/process/voice_process.h"

#include <gtest/gtest.h>

namespace ssm {
namespace {

TEST(VoiceProcessTest, ALineBreakInATextIsABlankAndNoCommand) {
  VoiceProcess voice({GALATEA_BIN_DIR "/ssm", "--sink", "null", "--clock", "virtual"},
                     std::chrono::seconds(60));
  const auto plain = voice.Speak({.text = "Good morning set Rate = 3"});
  const auto broken = voice.Speak({.text = "Good morning\nset Rate = 3"});
  const auto again = voice.Speak({.text = "Good morning set Rate = 3"});
  ASSERT_TRUE(plain && broken && again);
  EXPECT_GT(plain->phonemes.size(), 10U);
  EXPECT_EQ(vm::FormatPhonemesPlain(broken->phonemes), vm::FormatPhonemesPlain(plain->phonemes));
  EXPECT_EQ(vm::FormatPhonemesPlain(again->phonemes), vm::FormatPhonemesPlain(plain->phonemes));
}

TEST(VoiceProcessTest, WhatIsNoVoiceIsRefusedByTheVoicesOwnWord) {
  VoiceProcess voice({GALATEA_BIN_DIR "/ssm", "--sink", "null", "--clock", "virtual"},
                     std::chrono::seconds(60));
  const auto spoken = voice.Speak({.text = "Hello", .voice = "nobody"});
  ASSERT_FALSE(spoken);
  EXPECT_EQ(spoken.error().code, vm::Errc::kBadValue) << spoken.error().text;
  EXPECT_TRUE(voice.Speak({.text = "Hello"})) << "the next text is spoken";
}

}  // namespace
}  // namespace ssm
