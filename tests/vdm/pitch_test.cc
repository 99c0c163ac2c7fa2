// The fundamental frequency of made voices, whose truth is known.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "vdm/prosody/pitch_tracker.h"

namespace vdm {
namespace {

constexpr double kTurn = 6.283185307179586;
using Sound = std::vector<std::int16_t>;
using Frames = std::vector<PitchTracker::Frame>;

/// A buzz through formants of a vowel whose frequency follows `hz`, with noise `noise_db` below it.
Sound Buzz(double seconds, const std::function<double(double)>& hz, double noise_db = 100) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Sound sound;
  double phase = 0, power = 0;
  std::vector<double> voice;
  for (int i = 0; i < static_cast<int>(seconds * 16000); ++i) {
    const double f = hz(i / 16000.0);
    phase += f / 16000;
    double x = 0;
    for (int k = 1; k * f < 4000; ++k) {
      double size = 0.02;
      for (const double formant : {600.0, 1300.0, 2500.0}) {
        size += 1 / (1 + std::pow((k * f - formant) / 120, 2));
      }
      x += size * std::cos(kTurn * k * phase);
    }
    voice.push_back(x);
    power += x * x;
  }
  const double rms = std::sqrt(power / static_cast<double>(voice.size()));
  for (const double x : voice) {
    const double noise = rms * std::pow(10, -noise_db / 20) * normal(random);
    sound.push_back(static_cast<std::int16_t>(std::lround(3000 / rms * (x + noise))));
  }
  return sound;
}

Frames Track(const Sound& sound) {
  Frames frames;
  PitchTracker().Add(sound, frames);
  return frames;
}

struct Errors {
  double worst = 0;  // of voiced frames within 20 %, as a ratio
  int gross = 0, unvoiced = 0, all = 0;
};
/// Of frames after the first and before the last 50 ms.
Errors ErrorsOf(const Frames& frames, const std::function<double(double)>& hz) {
  Errors out;
  for (std::size_t k = 5; k + 5 < frames.size(); ++k) {
    ++out.all;
    if (frames[k].hz == 0) {
      ++out.unvoiced;
      continue;
    }
    const double off =
        std::abs(static_cast<double>(frames[k].hz) / hz(0.01 * static_cast<double>(k)) - 1);
    if (off > 0.2) {
      ++out.gross;
    } else {
      out.worst = std::max(out.worst, off);
    }
  }
  return out;
}

TEST(PitchTest, SteadyVoicesOfAllHeightsAreFoundWithinHalfAPerCent) {
  for (const double hz : {70.0, 95.0, 120.0, 180.0, 233.0, 310.0, 440.0}) {
    const auto steady = [hz](double) { return hz; };
    const Errors errors = ErrorsOf(Track(Buzz(1, steady)), steady);
    EXPECT_EQ(errors.gross, 0) << hz;
    EXPECT_EQ(errors.unvoiced, 0) << hz;
    EXPECT_LT(errors.worst, 0.005) << hz;
  }
}

TEST(PitchTest, AGlideIsFollowed) {
  const auto glide = [](double s) { return 110 * std::pow(2, s / 1.5); };  // an octave in 1.5 s
  const Errors errors = ErrorsOf(Track(Buzz(1.5, glide)), glide);
  EXPECT_EQ(errors.gross, 0);
  EXPECT_LE(errors.unvoiced, 1);
  EXPECT_LT(errors.worst, 0.01);
}

TEST(PitchTest, NoiseBehindAVoiceDoesLittle) {
  const auto wave = [](double s) { return 160 * std::pow(2, 0.3 * std::sin(kTurn * s)); };
  const Errors errors = ErrorsOf(Track(Buzz(2, wave, 10)), wave);
  EXPECT_LE(errors.gross, 2) << "of " << errors.all;
  EXPECT_LE(errors.unvoiced, errors.all / 20);
  EXPECT_LT(errors.worst, 0.05);
}

TEST(PitchTest, NoiseAndSilenceHaveNoVoice) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 2000);
  Sound noise(32000);
  for (auto& sample : noise) sample = static_cast<std::int16_t>(std::lround(normal(random)));
  int voiced = 0;
  for (const auto& frame : Track(noise)) voiced += frame.hz > 0;
  EXPECT_LE(voiced, 12) << "of 200";
  for (const auto& frame : Track(Sound(16000))) EXPECT_EQ(frame.hz, 0);
}

TEST(PitchTest, PiecesOfAnySizeGiveTheSameFrames) {
  const Sound sound = Buzz(
      1, [](double s) { return 140 + 40 * s; }, 20);
  const Frames whole = Track(sound);
  Frames pieces;
  PitchTracker tracker;
  for (std::size_t at = 0, size = 1; at < sound.size(); at += size, size = size * 3 % 1009) {
    size = std::min(size, sound.size() - at);
    tracker.Add(std::span(sound).subspan(at, size), pieces);
  }
  ASSERT_EQ(pieces.size(), whole.size());
  for (std::size_t k = 0; k < whole.size(); ++k) EXPECT_EQ(pieces[k].hz, whole[k].hz) << k;
}

TEST(PitchTest, AFrameIsToldWithItsLookaheadAndDependsOnNoMore) {
  const Sound sound = Buzz(0.5, [](double) { return 150.0; });
  PitchTracker tracker;
  Frames frames;
  for (std::size_t at = 0; at + 16 <= sound.size(); at += 16) {
    tracker.Add(std::span(sound).subspan(at, 16), frames);
    const std::size_t heard = at + 16;
    if (heard > PitchTracker::kAhead) {
      EXPECT_GE(frames.size(), (heard - PitchTracker::kAhead) / PitchTracker::kHop) << heard;
    }
    if (!frames.empty()) {
      EXPECT_LE((frames.size() - 1) * PitchTracker::kHop, heard);
    }
  }
}

}  // namespace
}  // namespace vdm
