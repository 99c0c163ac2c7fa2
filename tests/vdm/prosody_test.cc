// Levels, syllables, phrases, and how somebody usually speaks.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vdm/prosody/phrase_tracker.h"
#include "vdm/prosody/prosody_stream.h"
#include "vdm/prosody/prosody_tracker.h"
#include "vdm/prosody/speaker_usual.h"
#include "vdm/prosody/syllable_counter.h"

namespace vdm {
namespace {

std::vector<std::int16_t> Tone(double hz, double size, std::size_t samples) {
  std::vector<std::int16_t> sound(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    sound[i] = static_cast<std::int16_t>(
        std::lround(size * std::sin(6.283185307 * hz * static_cast<double>(i) / 16000)));
  }
  return sound;
}

std::vector<ProsodyFrame> Followed(const std::vector<std::int16_t>& sound) {
  std::vector<ProsodyFrame> frames;
  ProsodyTracker().Add(sound, frames);
  return frames;
}

TEST(ProsodyTest, PowerIsTheMeanSquareInDecibels) {
  for (const double size : {100.0, 1000.0, 10000.0}) {
    const ProsodyFrame frame = Followed(Tone(500, size, 8000))[20];
    EXPECT_NEAR(frame.power_db, 10 * std::log10(size * size / 2), 0.1) << size;
    EXPECT_NEAR(frame.vowel_db, frame.power_db, 0.1);
  }
  EXPECT_EQ(Followed(std::vector<std::int16_t>(8000))[20].power_db, 0);
}

TEST(ProsodyTest, TiltIsLowAgainstHigh) {
  auto sound = Tone(400, 2000, 8000);
  const auto high = Tone(2500, 200, 8000);
  for (std::size_t i = 0; i < sound.size(); ++i) {
    sound[i] = static_cast<std::int16_t>(sound[i] + high[i]);
  }
  EXPECT_NEAR(Followed(sound)[20].tilt_db, 20, 0.2);
}

TEST(ProsodyTest, SyllablesAreCounted) {
  for (const int rate : {3, 5, 7}) {
    SyllableCounter counter;
    int count = 0, unvoiced = 0;
    SyllableCounter of_noise;
    for (int k = 0; k < 400; ++k) {
      const auto level = static_cast<float>(60 - 8 * std::cos(6.283185307 * rate * k / 100));
      count += counter.Add(level, true);
      unvoiced += of_noise.Add(level, false);
    }
    EXPECT_NEAR(count, 4 * rate, 1) << rate;
    EXPECT_EQ(unvoiced, 0);
  }
  SyllableCounter flat;
  int count = 0;
  for (int k = 0; k < 400; ++k) count += flat.Add(static_cast<float>(60 + 0.25 * (k % 7)), true);
  EXPECT_EQ(count, 0);
}

TEST(ProsodyTest, TheUsualMovesToTheSpeaker) {
  SpeakerUsual usual;
  std::mt19937 random(1);
  std::normal_distribution<double> pitch(std::log(220.0), 0.12);
  for (int k = 0; k < 3000; ++k) usual.log_hz.Add(pitch(random));
  EXPECT_NEAR(std::exp(usual.log_hz.mean()), 220, 2);
  EXPECT_NEAR(usual.log_hz.deviation(), 0.12, 0.01);
  EXPECT_NEAR(usual.log_hz.Above(std::log(220.0) + 0.12), 1, 0.15);
  // After a few syllables already it is nearer to the speaker than to people at large.
  SpeakerUsual early;
  for (int k = 0; k < 20; ++k) early.log_hz.Add(std::log(90.0));
  EXPECT_LT(std::exp(early.log_hz.mean()), 105);
}

TEST(ProsodyTest, PhrasesStandBetweenPausesAndAreSureAfterAWhile) {
  PhraseTracker phrases;
  const auto add = [&](int hops, float speech, bool voiced) {
    int began = 0;
    for (int k = 0; k < hops; ++k) {
      phrases.Add(speech, voiced);
      began += phrases.begins();
    }
    return began;
  };
  EXPECT_EQ(add(100, 0.1F, true), 0);
  EXPECT_EQ(phrases.position01(), 0);
  EXPECT_EQ(add(100, 0.9F, false), 0) << "speech without a voice is not sure";
  add(50, 0, false);
  EXPECT_EQ(add(100, 0.9F, true), 1);
  EXPECT_NEAR(phrases.position01(), 0.5, 0.01);
  EXPECT_EQ(add(8, 0, false), 0);
  EXPECT_EQ(add(20, 0.9F, true), 0) << "a short pause is within a phrase";
  add(12, 0, false);
  EXPECT_EQ(phrases.position01(), 0);
  EXPECT_EQ(add(30, 0.9F, true), 1);
  EXPECT_EQ(phrases.phrase(), 2U);
  add(300, 0.9F, true);
  EXPECT_EQ(phrases.position01(), 1);
}

TEST(ProsodyTest, AStreamTakesWhatIsKnownWithTheMouthWhateverThePieces) {
  const auto sound = Tone(150, 3000, 16000);
  const auto run = [&](std::size_t piece) {
    ProsodyStream stream(960);
    std::vector<float> powers;
    std::vector<std::uint64_t> at;
    std::size_t given = 0;
    for (std::uint64_t sample = 0; sample + 960 <= sound.size(); sample += 160) {
      while (given < sample + 960) {
        const std::size_t size = std::min(piece, sound.size() - given);
        stream.Add(std::span(sound).subspan(given, size));
        given += size;
      }
      stream.Advance(sample, 1,
                     [&](const ProsodyFrame& frame) { powers.push_back(frame.power_db); });
      at.push_back(stream.at());
    }
    return std::pair(powers, at);
  };
  const auto whole = run(16000);
  EXPECT_EQ(run(97), whole);
  EXPECT_EQ(run(320), whole);
  // The newest prosody that is known: 960 samples less its own lookahead, in whole hops.
  EXPECT_EQ(whole.second[50], 50U * 160 + (960 - ProsodyTracker::kAhead) / 160 * 160);
}

}  // namespace
}  // namespace vdm
