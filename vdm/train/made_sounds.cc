#include "vdm/train/made_sounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace vdm {
namespace {

constexpr double kRate = 16000, kTurn = 2 * std::numbers::pi;

void Normalise(std::vector<float>& sound) {
  double sum = 0;
  for (const float x : sound) sum += static_cast<double>(x * x);
  const auto scale = static_cast<float>(
      1 / std::sqrt(sum / static_cast<double>(std::max<std::size_t>(sound.size(), 1)) + 1e-9));
  for (float& x : sound) x *= scale;
}

/// One note with its overtones, struck at `first` and fading.
void AddNote(std::vector<float>& sound, std::size_t first, double hz, double seconds, double fade,
             const std::array<double, 8>& overtones, double size) {
  const std::size_t last =
      std::min(sound.size(), first + static_cast<std::size_t>(seconds * kRate));
  for (std::size_t harmonic = 0; harmonic < overtones.size(); ++harmonic) {
    const double step = kTurn * hz * static_cast<double>(harmonic + 1) / kRate;
    if (step > 3) break;
    // The sine turns on by one step a sample; so does its fading.
    const double turn_re = std::cos(step), turn_im = std::sin(step);
    const double fades = std::exp(-fade / kRate);
    double re = size * overtones[harmonic], im = 0;
    for (std::size_t i = first; i < last; ++i) {
      const double t = static_cast<double>(i - first) / kRate;
      const double left = static_cast<double>(last - i) / kRate;
      sound[i] += static_cast<float>(std::min({t / 0.01, left / 0.03, 1.0}) * im);
      const double next = fades * (re * turn_re - im * turn_im);
      im = fades * (re * turn_im + im * turn_re);
      re = next;
    }
  }
}

}  // namespace

std::vector<float> MakeNoise(std::size_t samples, Dice& dice) {
  std::vector<float> sound(samples);
  // A pole on the real axis tilts the spectrum: near 1 it rumbles, below 0 it hisses.
  const auto pole = static_cast<float>(dice.Between(-0.6, 0.98));
  float last = 0;
  for (float& x : sound) {
    last = pole * last + static_cast<float>(dice.Between(-1.7, 1.7));
    x = last;
  }
  Normalise(sound);
  if (dice.Chance(0.3)) {
    const double hz = dice.Chance(0.5) ? 50 : 60, size = dice.Between(0.3, 3);
    for (std::size_t i = 0; i < samples; ++i) {
      const double angle = kTurn * hz * static_cast<double>(i) / kRate;
      sound[i] += static_cast<float>(size * (std::sin(angle) + 0.5 * std::sin(3 * angle)));
    }
  }
  if (dice.Chance(0.3)) {
    for (int knocks = 0; knocks < 6; ++knocks) {
      const std::size_t at = dice.Below(samples);
      const double size = dice.Between(3, 12), fade = dice.Between(60, 600);
      for (std::size_t i = at; i < std::min(samples, at + 3200); ++i) {
        sound[i] += static_cast<float>(size * dice.Between(-1, 1) *
                                       std::exp(-fade * static_cast<double>(i - at) / kRate));
      }
    }
  }
  Normalise(sound);
  return sound;
}

std::vector<float> MakeMusic(std::size_t samples, Dice& dice) {
  std::vector<float> sound(samples);
  constexpr std::array kMajor = {0, 2, 4, 5, 7, 9, 11};
  const double root = 110 * std::pow(2, dice.Between(0, 1)), beat = dice.Between(0.2, 0.6);
  std::array<double, 8> chord_tone{}, tune_tone{};
  for (std::size_t h = 0; h < 8; ++h) {
    chord_tone[h] = dice.Uniform() / static_cast<double>(h + 1);
    tune_tone[h] = dice.Uniform() / std::sqrt(static_cast<double>(h + 1));
  }
  const double fade = dice.Between(0.3, 6);
  const bool drums = dice.Chance(0.5);
  const auto hz = [&](std::size_t degree) {
    const auto octave = static_cast<double>(degree / 7);
    return root * std::pow(2, octave + kMajor[degree % 7] / 12.0);
  };
  for (std::size_t bar = 0;; ++bar) {
    const auto start = static_cast<std::size_t>(static_cast<double>(bar) * 4 * beat * kRate);
    if (start >= samples) break;
    const std::size_t degree = dice.Below(7);
    for (const std::size_t third : {0U, 2U, 4U}) {
      AddNote(sound, start, hz(degree + third), 4 * beat, fade / 4, chord_tone, 0.4);
    }
    for (std::size_t note = 0; note < 4; ++note) {
      const std::size_t at =
          start + static_cast<std::size_t>(static_cast<double>(note) * beat * kRate);
      if (at >= samples) break;
      if (dice.Chance(0.8)) AddNote(sound, at, hz(7 + dice.Below(9)), beat, fade, tune_tone, 0.7);
      if (!drums) continue;
      for (std::size_t i = at; i < std::min(samples, at + 2400); ++i) {
        sound[i] += static_cast<float>(dice.Between(-1.5, 1.5) *
                                       std::exp(-40 * static_cast<double>(i - at) / kRate));
      }
    }
  }
  Normalise(sound);
  return sound;
}

}  // namespace vdm
