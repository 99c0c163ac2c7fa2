// A recorded film taken apart: where the mouth stood in its frames, where the sound is in its
// sound.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "tests/stack/stack.h"
#include "vm_protocol/core/phonemes.h"

namespace {

using stack::Stack;

constexpr double kLeadMs = 40;  // LipSync.lead at start
constexpr double kFrameMs = 1000.0 / 30;

struct Frame {
  double time_ms = 0;  ///< on the face's clock, which is the session's on the virtual clock
  std::string phoneme;
  double gap_mm = 0;
};

struct Film {
  std::vector<Frame> frames;
  vm::PhonemeList phonemes;
  std::vector<std::int16_t> sound;  ///< 16 kHz mono
  double record_started_ms = 0;
  std::string folder;
};

std::vector<std::int16_t> Samples(const std::string& wav) {
  const std::size_t data = wav.find("data");
  if (data == std::string::npos) return {};
  std::vector<std::int16_t> samples((wav.size() - data - 8) / 2);
  std::memcpy(samples.data(), wav.data() + data + 8, samples.size() * 2);
  return samples;
}

/// Speaks `text` into a film with the real English voice on the virtual clock.
Film Make(Stack& stack, const std::string& text) {
  stack.Say("to @SSM set Record = voice.wav");
  stack.Say("to @FSM prop Frame = AutoOutput");
  stack.Say("to @FSM inq#start Clock");
  stack.Say("to @FSM set Record = film.mp4");
  stack.Say("set Wait = 200");
  stack.Say("to @AM-MCL set#said Speak = " + text);
  stack.Say("set Wait = IDLE");
  stack.Say("set Wait = 300");
  stack.Say("to @SSM set Record = STOP");
  stack.Say("to @FSM set Record.sound = voice.wav");
  stack.Say("to @FSM set#done Record = STOP");
  stack.Say("set Wait = IDLE");
  Film film;
  for (const std::string& line : stack.Finish()) {
    const auto message = vm::ParseMessage(line);
    if (!message) continue;
    if (message->slot == "Text.pho")
      film.phonemes = vm::ParsePhonemes(message->value).value_or(vm::PhonemeList{});
    if (message->tag == "start") film.record_started_ms = std::stod(message->value);
    if (message->tag == "said") {
      EXPECT_EQ(message->slot, "Speak") << line;
    }
    if (message->tag == "done") {
      EXPECT_EQ(message->slot, "Record") << line;
    }
    if (message->slot == "Frame") {
      std::istringstream words(message->value);
      long number = 0;
      double jaw = 0;
      Frame frame;
      words >> number >> frame.time_ms >> frame.phoneme >> jaw >> frame.gap_mm;
      film.frames.push_back(frame);
    }
  }
  film.sound = Samples(stack.Text("voice.wav"));
  return film;
}

/// When the utterance's first sample stands in the sound, in ms from the start of the recording.
double SpeechStartMs(const Film& film) {
  const auto first = std::ranges::find_if(film.sound, [](std::int16_t s) { return s != 0; });
  return static_cast<double>(first - film.sound.begin()) / 16.0;
}

TEST(FilmTest, TheMouthLeadsTheSoundByTheChosenLeadExactlyToTheFrame) {
  Stack stack("virtual", {stack::Voice("ssm", {"--sink", "null"}), stack::Face()});
  const Film film = Make(stack, "Hello, my name is Galatea.");
  ASSERT_FALSE(film.phonemes.empty());
  ASSERT_FALSE(film.frames.empty());
  const double sound_start = SpeechStartMs(film);
  ASSERT_LT(sound_start * 16, static_cast<double>(film.sound.size())) << "there is sound";

  double at = sound_start;
  std::size_t frame = 0;
  std::string report;
  for (const vm::Phoneme& phoneme : film.phonemes) {
    const double start = at;
    at += static_cast<double>(phoneme.duration.count());
    // A phoneme shorter than a frame may fall between two.
    while (frame < film.frames.size() &&
           film.frames[frame].time_ms - film.record_started_ms < start - kLeadMs)
      ++frame;
    if (frame >= film.frames.size()) break;
    if (film.frames[frame].time_ms - film.record_started_ms >= at - kLeadMs) continue;
    const double offset = film.frames[frame].time_ms - film.record_started_ms - start;
    report += phoneme.name + " " + std::to_string(std::lround(offset)) + " ms; ";
    EXPECT_EQ(film.frames[frame].phoneme, phoneme.name)
        << "at " << film.frames[frame].time_ms << ": the first frame of " << phoneme.name;
    EXPECT_GE(offset, -kLeadMs - 1e-6) << phoneme.name;
    EXPECT_LT(offset, -kLeadMs + kFrameMs) << phoneme.name;
  }
  RecordProperty("offsets", report);
  std::cout << "first frame of each phoneme against its sound: " << report << "\n";
}

TEST(FilmTest, TheMouthIsClosedInPausesAndOnMAndOpenOnVowels) {
  Stack stack("virtual", {stack::Voice("ssm", {"--sink", "null"}), stack::Face()});
  const Film film = Make(stack, "Mama and papa.");
  const double sound_start = SpeechStartMs(film);
  double open_vowel = 0;
  double at = film.record_started_ms + sound_start;
  std::string before = "pau";
  for (const vm::Phoneme& phoneme : film.phonemes) {
    const double start = at;
    const bool after_vowel = std::string("aa ae ah ax").find(before) != std::string::npos;
    before = phoneme.name;
    at += static_cast<double>(phoneme.duration.count());
    double least = 1e9;
    for (const Frame& frame : film.frames) {
      if (frame.time_ms < start - kLeadMs || frame.time_ms > at - kLeadMs) continue;
      least = std::min(least, frame.gap_mm);
      if (phoneme.name == "aa" || phoneme.name == "ae" || phoneme.name == "ah")
        open_vowel = std::max(open_vowel, frame.gap_mm);
    }
    if (least > 1e8) continue;
    const bool closing = phoneme.name == "m" || phoneme.name == "p" || phoneme.name == "b";
    if (!closing) continue;
    EXPECT_LT(least, 1.0) << phoneme.name << " at " << start;
    // The key instant of a closure is its phoneme's start: shut from the lead before it on for
    // about a frame (34 ms, or 85 % of a shorter one), and not yet shut two frames earlier.
    const double key = start - kLeadMs;
    const double shut = std::min(34.0, 0.85 * static_cast<double>(phoneme.duration.count()));
    for (const Frame& frame : film.frames) {
      if (frame.time_ms < key || frame.time_ms > key + shut) continue;
      EXPECT_LT(frame.gap_mm, 0.05) << phoneme.name << " at " << frame.time_ms;
    }
    if (start == film.record_started_ms + sound_start || !after_vowel) continue;
    for (const Frame& frame : film.frames) {
      if (frame.time_ms < key - 2 * kFrameMs || frame.time_ms > key - kFrameMs) continue;
      EXPECT_GT(frame.gap_mm, 0.2) << "before " << phoneme.name << " at " << frame.time_ms;
    }
  }
  EXPECT_GT(open_vowel, 4.0);
  ASSERT_FALSE(film.frames.empty());
  EXPECT_LT(film.frames.front().gap_mm, 0.1) << "closed before";
  EXPECT_LT(film.frames.back().gap_mm, 0.1) << "closed after";
}

TEST(FilmTest, TheSameWordsMakeTheSameFilmToTheByte) {
  std::string first;
  for (int i = 0; i < 2; ++i) {
    Stack stack("virtual", {stack::Voice("ssm", {"--sink", "null"}), stack::Face()});
    Make(stack, "Hello.");
    const std::string film = stack.Text("film.mp4");
    ASSERT_GT(film.size(), 1000u);
    if (i == 0) first = film;
    EXPECT_EQ(film, first);
  }
}

}  // namespace
