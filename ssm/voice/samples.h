#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vm_protocol/core/scheduler.h"

/// Sound, as every part of the voice passes it on: 16 bit signed, mono, 16 000 frames per second.
namespace ssm {

inline constexpr std::int64_t kSampleRateHz = 16000;
inline constexpr std::size_t kFramesPerMs = kSampleRateHz / 1000;

constexpr std::size_t ToFrames(std::chrono::milliseconds length) {
  return static_cast<std::size_t>(length.count()) * kFramesPerMs;
}
/// Whole milliseconds, rounded down.
constexpr std::chrono::milliseconds ToMs(std::size_t frames) {
  return std::chrono::milliseconds(frames / kFramesPerMs);
}
/// The shortest time after which `frames` have certainly passed.
constexpr vm::Time ToTime(std::size_t frames) {
  const auto us = static_cast<std::int64_t>(frames) * 1'000'000;
  return vm::Time((us + kSampleRateHz - 1) / kSampleRateHz);
}
/// Frames that have passed after `time`, rounded down; 0 for a negative time.
constexpr std::size_t FramesIn(vm::Time time) {
  return time.count() <= 0 ? 0 : static_cast<std::size_t>(time.count() * kSampleRateHz / 1'000'000);
}

/// A sample made louder: what is beyond 3/4 of full scale is bent instead of cut.
inline double Limited(double value) {
  constexpr double kKnee = 24576, kRoom = 32767 - kKnee;
  const double size = std::abs(value);
  if (size <= kKnee) return value;
  return std::copysign(kKnee + kRoom * std::tanh((size - kKnee) / kRoom), value);
}

/// The sound of one utterance. Its length is known from the start (the phonemes say it); the engine
/// fills it from the front while the front may be playing already.
/// Thread: one writer (Append, Finish), any number of readers; Cancel from anywhere.
class SampleBuffer {
 public:
  /// The first `skip` frames that are written are left out: nobody is to hear them.
  explicit SampleBuffer(std::size_t frames, std::size_t skip = 0) : samples_(frames), skip_(skip) {}

  std::size_t size() const { return samples_.size(); }
  /// What may be read: everything written so far. Stays valid as long as the buffer.
  std::span<const std::int16_t> Ready() const {
    return {samples_.data(), ready_.load(std::memory_order_acquire)};
  }
  bool complete() const { return Ready().size() == samples_.size(); }

  /// What does not fit is dropped.
  void Append(std::span<const std::int16_t> more) {
    more = more.subspan(Skipped(more.size()));
    const std::size_t at = ready_.load(std::memory_order_relaxed);
    const std::size_t count = std::min(more.size(), samples_.size() - at);
    std::copy_n(more.begin(), count, samples_.begin() + static_cast<std::ptrdiff_t>(at));
    ready_.store(at + count, std::memory_order_release);
  }
  void AppendSilence(std::size_t frames) {
    frames -= Skipped(frames);
    const std::size_t at = ready_.load(std::memory_order_relaxed);
    ready_.store(at + std::min(frames, samples_.size() - at), std::memory_order_release);
  }
  /// The rest is silence.
  void Finish() { ready_.store(samples_.size(), std::memory_order_release); }

  /// Asks the writer to give up.
  void Cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

 private:
  /// How many of the frames now written are among those left out.
  std::size_t Skipped(std::size_t frames) {
    const std::size_t skipped = std::min(skip_, frames);
    skip_ -= skipped;
    return skipped;
  }

  std::vector<std::int16_t> samples_;
  std::size_t skip_;  // the writer's
  std::atomic<std::size_t> ready_{0};
  std::atomic<bool> cancelled_{false};
};

}  // namespace ssm
