// Speech as it might have come from elsewhere: the same by the same dice, in range, in time.

#include "vdm/train/distortion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "vdm/train/made_sounds.h"

namespace vdm {
namespace {

std::vector<std::int16_t> Click() {
  std::vector<std::int16_t> sound(16000);
  for (int i = 0; i < 160; ++i)
    sound[static_cast<std::size_t>(8000 + i)] = i % 2 == 0 ? 20000 : -20000;
  return sound;
}

TEST(DistortionTest, TheSameDiceGiveTheSameSound) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const HeardSpeech a = Distorted(Click(), Dice(seed)), b = Distorted(Click(), Dice(seed));
    EXPECT_EQ(a.samples, b.samples);
    EXPECT_EQ(a.warp, b.warp);
    EXPECT_EQ(NoSpeech(Dice(seed)), NoSpeech(Dice(seed)));
  }
  EXPECT_NE(Distorted(Click(), Dice(1)).samples, Distorted(Click(), Dice(2)).samples);
}

TEST(DistortionTest, WhereTheSpeechIsIsKnown) {
  // The loudest 5 ms of a clean enough sound are where the click should be.
  int near = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const HeardSpeech heard = Distorted(Click(), Dice(seed));
    double best = 0, at = 0;
    for (std::size_t i = 0; i + 80 < heard.samples.size(); i += 16) {
      double sum = 0;
      for (std::size_t k = i; k < i + 80; ++k)
        sum += std::abs(static_cast<double>(heard.samples[k]));
      if (sum > best) best = sum, at = static_cast<double>(i) / 16;
    }
    near += std::abs(at - (heard.start_ms + 500 / heard.speed)) < 12;
    EXPECT_GE(heard.speed, 0.8);
    EXPECT_LE(heard.speed, 1.2);
  }
  EXPECT_GE(near, 34);
}

TEST(MadeSoundsTest, TheyAreAboutAsLoudAsPromised) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    for (const bool music : {false, true}) {
      Dice dice(seed);
      const auto sound = music ? MakeMusic(32000, dice) : MakeNoise(32000, dice);
      double sum = 0;
      for (const float x : sound) sum += static_cast<double>(x * x);
      EXPECT_NEAR(std::sqrt(sum / 32000), 1, 0.01);
    }
  }
}

}  // namespace
}  // namespace vdm
