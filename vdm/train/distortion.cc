#include "vdm/train/distortion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vdm/train/made_sounds.h"

namespace vdm {
namespace {

constexpr double kRate = 16000;
using Sound = std::vector<float>;

/// Read `speed` times as fast: time, pitch and formants go together. Cubic (Catmull-Rom) between
/// samples.
Sound ReadFaster(std::span<const std::int16_t> in, double speed) {
  const auto count = static_cast<std::size_t>(static_cast<double>(in.size()) / speed);
  const auto at = [&](std::ptrdiff_t i) {
    return i < 0 || i >= static_cast<std::ptrdiff_t>(in.size())
               ? 0.0F
               : static_cast<float>(in[static_cast<std::size_t>(i)]) / 32768;
  };
  Sound out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double place = static_cast<double>(i) * speed;
    const auto k = static_cast<std::ptrdiff_t>(place);
    const auto u = static_cast<float>(place - static_cast<double>(k));
    const float a = at(k - 1), b = at(k), c = at(k + 1), d = at(k + 2);
    out[i] = b + 0.5F * u * (c - a + u * (2 * a - 5 * b + 4 * c - d + u * (3 * (b - c) + d - a)));
  }
  return out;
}

void AddRoom(Sound& sound, Dice& dice) {
  const double fade_s = dice.Between(0.12, 0.6);  // to -60 dB
  const double size = std::pow(10, dice.Between(-22, -10) / 20);
  const Sound dry = sound;
  for (double at = dice.Between(30, 120); at < fade_s * kRate / 2; at += dice.Between(20, 100)) {
    const auto delay = static_cast<std::size_t>(at);
    const auto gain = static_cast<float>((dice.Chance(0.5) ? size : -size) *
                                         std::pow(10, -3 * at / kRate / fade_s));
    for (std::size_t i = delay; i < sound.size(); ++i) sound[i] += gain * dry[i - delay];
  }
}

/// Second-order low or high pass (R. Bristow-Johnson, Cookbook formulae for audio EQ biquads).
void Pass(Sound& sound, double hz, bool high) {
  const double w = 2 * std::numbers::pi * hz / kRate, c = std::cos(w);
  const double alpha = std::sin(w) / std::numbers::sqrt2, a0 = 1 + alpha;
  const double side = (high ? 1 + c : 1 - c) / 2 / a0, middle = (high ? -2 : 2) * side;
  const double a1 = -2 * c / a0, a2 = (1 - alpha) / a0;
  double x1 = 0, x2 = 0, y1 = 0, y2 = 0;
  for (float& sample : sound) {
    const double x = static_cast<double>(sample);
    const double y = side * x + middle * x1 + side * x2 - a1 * y1 - a2 * y2;
    x2 = x1, x1 = x, y2 = y1, y1 = y;
    sample = static_cast<float>(y);
  }
}

double Rms(const Sound& sound) {
  double sum = 0;
  for (const float x : sound) sum += static_cast<double>(x * x);
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(sound.size(), 1)));
}

std::vector<std::int16_t> Written(const Sound& sound, double gain, double ceiling) {
  std::vector<std::int16_t> out;
  out.reserve(sound.size());
  for (const float x : sound) {
    const double y = std::clamp(static_cast<double>(x) * gain, -ceiling, ceiling);
    out.push_back(static_cast<std::int16_t>(std::lround(y * 32767)));
  }
  return out;
}

}  // namespace

HeardSpeech Distorted(std::span<const std::int16_t> speech, Dice dice) {
  HeardSpeech heard;
  heard.speed = dice.Chance(0.7) ? dice.Between(0.86, 1.16) : 1;
  heard.warp = static_cast<float>(dice.Chance(0.85) ? dice.Between(0.82, 1.2) : 1);
  const Sound faster = ReadFaster(speech, heard.speed);
  const auto before = static_cast<std::size_t>(dice.Between(0.05, 0.7) * kRate);
  const auto after = static_cast<std::size_t>(dice.Between(0.3, 0.6) * kRate);
  heard.start_ms = static_cast<double>(before) / kRate * 1000;
  Sound sound(before + faster.size() + after);
  std::ranges::copy(faster, sound.begin() + static_cast<std::ptrdiff_t>(before));

  if (dice.Chance(0.4)) AddRoom(sound, dice);
  const double loudness = std::max(Rms(sound), 1e-4);
  if (dice.Chance(0.65)) {
    const bool music = dice.Chance(0.15);
    const Sound behind = music ? MakeMusic(sound.size(), dice) : MakeNoise(sound.size(), dice);
    const auto size =
        static_cast<float>(loudness * std::pow(10, -dice.Between(music ? 12 : 5, 40) / 20));
    for (std::size_t i = 0; i < sound.size(); ++i) sound[i] += size * behind[i];
  }
  if (dice.Chance(0.2)) {  // a telephone
    Pass(sound, 300, true);
    Pass(sound, 3400, false);
    Pass(sound, 3400, false);
  } else if (dice.Chance(0.3)) {
    Pass(sound, dice.Between(2500, 7000), false);
  }
  if (dice.Chance(0.3)) Pass(sound, dice.Between(60, 250), true);
  if (dice.Chance(0.5)) {  // a tilt: a zero on the real axis
    const auto zero = static_cast<float>(dice.Between(-0.5, 0.7));
    for (std::size_t i = sound.size() - 1; i > 0; --i) sound[i] -= zero * sound[i - 1];
  }
  const double level = std::pow(10, dice.Between(-45, -14) / 20);
  const double ceiling = dice.Chance(0.05) ? dice.Between(1.5, 4) * level : 1;
  heard.samples = Written(sound, level / std::max(Rms(sound), 1e-6), std::min(ceiling, 1.0));
  return heard;
}

std::vector<std::int16_t> NoSpeech(Dice dice) {
  constexpr std::size_t kSamples = 64'000;
  if (dice.Chance(0.1)) return std::vector<std::int16_t>(kSamples);
  const Sound sound = dice.Chance(0.5) ? MakeNoise(kSamples, dice) : MakeMusic(kSamples, dice);
  return Written(sound, std::pow(10, dice.Between(-70, -14) / 20), 1);
}

}  // namespace vdm
