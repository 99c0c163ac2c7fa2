// Interrupting a ten-second utterance at every half second, on the virtual clock with all
// processes.

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/stack/stack.h"
#include "vm_protocol/core/phonemes.h"

namespace {

using stack::Stack;

/// One `rep Frame = NUMBER TIME_MS PHONEME JAW_DEG GAP_MM WIDTH_MM`.
struct SpokenFrame {
  double time_ms = 0;
  std::string phoneme;
  double gap_mm = 0;
};

std::vector<SpokenFrame> SpokenFrames(const std::vector<std::string>& lines) {
  std::vector<SpokenFrame> frames;
  for (const std::string& line : lines) {
    const auto message = vm::ParseMessage(line);
    if (!message || message->slot != "Frame") continue;
    std::istringstream words(message->value);
    long number = 0;
    double jaw = 0;
    SpokenFrame frame;
    words >> number >> frame.time_ms >> frame.phoneme >> jaw >> frame.gap_mm;
    frames.push_back(frame);
  }
  return frames;
}

std::string TenSeconds() {
  std::string text;
  for (int i = 0; i < 18; ++i) text += "a banana and a papaya ";
  return text;
}

class BargeInTest : public testing::TestWithParam<int> {};

TEST_P(BargeInTest, SoundAndLipsStopInTimeAndTheNextUtteranceIsInStep) {
  const int stop_after_ms = GetParam();
  Stack stack("virtual", {stack::Voice(), stack::Face()});
  stack.Say("to @FSM prop Frame = AutoOutput");
  stack.Say("to @AM-MCL set#first Speak = " + TenSeconds());
  stack.Say("set Wait = " + std::to_string(stop_after_ms));
  stack.Say("to @FSM inq#mark Clock");
  stack.Say("to @AM-MCL set#stop Speak = STOP");
  stack.Say("set Wait = IDLE");
  stack.Say("to @AM-MCL set#second Speak = papa");
  stack.Say("set Wait = IDLE");
  const auto lines = stack.Finish();

  const std::string spoken = stack::Last(lines, "SSM", "Speak.len");
  double first_len = -1;
  double mark = -1;
  std::string first_error;
  std::string second;
  for (const std::string& line : lines) {
    const auto message = vm::ParseMessage(line);
    if (!message) continue;
    if (message->from == "SSM" && message->slot == "Speak.len" && first_len < 0)
      first_len = std::stod(message->value);
    if (message->tag == "mark") mark = std::stod(message->value);
    if (message->tag == "first") first_error = message->slot + " " + message->value;
    if (message->tag == "second") second = message->slot;
  }
  EXPECT_NE(first_error.find("Speak.error STOPPED"), std::string::npos)
      << "the interrupted utterance is answered as stopped: " << first_error;
  EXPECT_EQ(second, "Speak") << "the next utterance succeeds";
  ASSERT_GE(mark, 0) << testing::PrintToString(lines);
  // Preparing takes some of the time before the stop, so less than that was spoken, and not
  // nothing.
  EXPECT_LE(first_len, stop_after_ms);
  EXPECT_GE(first_len, stop_after_ms - 500);
  EXPECT_FALSE(spoken.empty());

  double closed_at = -1;
  for (const SpokenFrame& frame : SpokenFrames(lines)) {
    if (frame.time_ms < mark) continue;
    if (frame.gap_mm < 0.3 && closed_at < 0) closed_at = frame.time_ms;
  }
  ASSERT_GE(closed_at, 0);
  EXPECT_LE(closed_at - mark, 120 + 34) << "lips close within 120 ms, seen at 30 frames a second";
}

INSTANTIATE_TEST_SUITE_P(EveryHalfSecond, BargeInTest, testing::Range(500, 10001, 500));

}  // namespace
