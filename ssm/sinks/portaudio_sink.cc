#include "ssm/sinks/portaudio_sink.h"

#include <portaudio.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cmath>
#include <semaphore>
#include <utility>

#include "ssm/sinks/portaudio_library.h"

namespace ssm {
namespace {

using Micros = std::chrono::microseconds;

constexpr std::size_t kFadeFrames = 80;  // 5 ms, so that a stop does not click
// A device that has taken this much more sound than time has passed has no clock of its own.
// (Honest ones take a buffer or two ahead.)
constexpr Micros kRunaway{2'000'000};
constexpr Micros kTrial{30'000};  // a device without a clock shows itself within this
// Callbacks further apart than this mean that the device has stopped.
constexpr Micros kDeadAfter{2'000'000};

class PortAudioSink final : public AudioSink {
 public:
  PortAudioSink(vm::Scheduler& scheduler, std::unique_ptr<PortAudioLibrary> library,
                std::function<vm::Time()> instants)
      : scheduler_(scheduler), library_(std::move(library)), instants_(std::move(instants)) {}
  ~PortAudioSink() override {
    if (stream_ == nullptr) return;
    const QuietStderr quiet;
    Pa_AbortStream(stream_);
    Pa_CloseStream(stream_);
  }

  vm::Result<void> Open(PaDeviceIndex device) {
    const PaDeviceInfo* info = Pa_GetDeviceInfo(device);
    name_ = info->name;
    PaStreamParameters output{};
    output.device = device;
    output.channelCount = 1;
    output.sampleFormat = paInt16;
    output.suggestedLatency = info->defaultLowOutputLatency;
    PaError error = Pa_OpenStream(&stream_, nullptr, &output, static_cast<double>(kSampleRateHz),
                                  paFramesPerBufferUnspecified, paNoFlag, &OnBuffer, this);
    if (error != paNoError) stream_ = nullptr;
    opened_ = instants_();
    last_buffer_us_ = Now();
    if (error == paNoError) error = Pa_StartStream(stream_);
    if (error == paNoError) {
      if (!ran_away_.try_acquire_for(kTrial)) return {};
      return vm::Fail(vm::Errc::kUnavailable,
                      "sound device '" + name_ + "' throws sound away at any speed");
    }
    return vm::Fail(vm::Errc::kUnavailable,
                    "sound device '" + name_ + "' cannot be opened: " + Pa_GetErrorText(error));
  }

  vm::Result<void> Play(std::shared_ptr<const SampleBuffer> samples, vm::Time start) override {
    assert(!samples_);
    if (Failed()) return vm::Fail(vm::Errc::kUnavailable, "sound device '" + name_ + "' failed");
    WaitForCallback();
    samples_ = std::move(samples);
    start_ = std::max(start, scheduler_.Now());
    // Instants are handed over on the clock of both threads, counted from when the stream opened.
    start_us_ = Now() + (start_ - scheduler_.Now()).count();
    next_frame_ = 0;
    first_heard_us_ = kNever;
    current_ = samples_.get();
    return {};
  }

  Position Where() const override {
    assert(samples_);
    const std::int64_t first = first_heard_us_;
    if (first == kNever) return {0, start_, Failed()};
    const vm::Time since(Now() - first);
    // Never more than what was handed over: on an underrun the clock runs on, the sound does not.
    const std::size_t frames = std::min({FramesIn(since), next_frame_.load(), samples_->size()});
    return {frames, scheduler_.Now() - since, Failed()};
  }

  Position Stop() override {
    const Position before = Where();
    current_ = nullptr;
    WaitForCallback();
    Position position = before;
    // What the device holds already is heard as well.
    if (!Failed()) position.frames = std::min(next_frame_.load(), samples_->size());
    samples_.reset();
    return position;
  }

  std::string name() const override { return "portaudio:" + name_; }

 private:
  static constexpr std::int64_t kNever = INT64_MIN;

  std::int64_t Now() const { return (instants_() - opened_).count(); }
  bool Failed() const { return runaway_ || Now() - last_buffer_us_ > kDeadAfter.count(); }

  /// Until the callback that may be running has ended: afterwards none uses the old samples.
  void WaitForCallback() const { in_callback_.wait(true); }

  static int OnBuffer(const void*, void* output, unsigned long frames,
                      const PaStreamCallbackTimeInfo* time, PaStreamCallbackFlags, void* self) {
    return static_cast<PortAudioSink*>(self)->Fill(
        {static_cast<std::int16_t*>(output), static_cast<std::size_t>(frames)}, *time);
  }

  int Fill(std::span<std::int16_t> out, const PaStreamCallbackTimeInfo& time) {
    in_callback_ = true;
    std::fill(out.begin(), out.end(), std::int16_t{0});
    const std::int64_t now = Now();
    last_buffer_us_ = now;
    delivered_ += out.size();
    if (ToTime(delivered_).count() > now + kRunaway.count()) {
      if (!runaway_.exchange(true)) ran_away_.release();
      LeaveCallback();
      return paAbort;
    }
    const double delay_s = std::clamp(time.outputBufferDacTime - time.currentTime, 0.0, 1.0);
    FillSpeech(out, now + std::llround(delay_s * 1e6));
    LeaveCallback();
    return paContinue;
  }

  void LeaveCallback() {
    in_callback_ = false;
    in_callback_.notify_one();
  }

  /// `heard_us`: when the first frame of `out` will be heard.
  void FillSpeech(std::span<std::int16_t> out, std::int64_t heard_us) {
    const SampleBuffer* samples = current_;
    if (samples == nullptr) {
      for (std::size_t i = 0; i < out.size() && fade_left_ > 0; ++i) {
        --fade_left_;
        out[i] = static_cast<std::int16_t>(last_sample_ * static_cast<int>(fade_left_) /
                                           static_cast<int>(kFadeFrames));
      }
      return;
    }
    std::size_t at = next_frame_;
    std::size_t silence = 0;
    if (at == 0) {
      silence = FramesIn(vm::Time(start_us_ - heard_us));
      if (silence >= out.size()) return;
      first_heard_us_ = heard_us + ToTime(silence).count();
    }
    const auto ready = samples->Ready();
    const std::size_t count = std::min(out.size() - silence, ready.size() - at);
    std::copy_n(ready.begin() + static_cast<std::ptrdiff_t>(at), count,
                out.begin() + static_cast<std::ptrdiff_t>(silence));
    if (count > 0) last_sample_ = out[silence + count - 1];
    fade_left_ = kFadeFrames;
    at += count;
    next_frame_ = at;
    if (count < out.size() - silence && at < samples->size()) {
      // The engine lags: what comes later is heard later.
      const auto late = static_cast<std::size_t>(out.size() - silence - count);
      first_heard_us_ += ToTime(late).count();
    }
  }

  vm::Scheduler& scheduler_;
  const std::unique_ptr<PortAudioLibrary> library_;
  PaStream* stream_ = nullptr;
  std::string name_;
  const std::function<vm::Time()> instants_;
  vm::Time opened_{0};

  // The scheduler's thread only.
  std::shared_ptr<const SampleBuffer> samples_;
  vm::Time start_{0};

  // Written by the scheduler's thread while no samples are set, read by the callback.
  std::atomic<const SampleBuffer*> current_{nullptr};
  std::atomic<std::int64_t> start_us_{0};

  // Written by the callback.
  std::atomic<std::size_t> next_frame_{0};
  std::atomic<std::int64_t> first_heard_us_{kNever};
  std::atomic<std::int64_t> last_buffer_us_{0};
  std::atomic<bool> runaway_{false};
  std::binary_semaphore ran_away_{0};
  std::atomic<bool> in_callback_{false};

  // The callback only.
  std::size_t delivered_ = 0;
  std::size_t fade_left_ = 0;
  int last_sample_ = 0;
};

}  // namespace

vm::Result<std::unique_ptr<AudioSink>> OpenPortAudio(vm::Scheduler& scheduler,
                                                     const std::string& device,
                                                     std::function<vm::Time()> instants) {
  if (!instants) {
    instants = [] {
      return std::chrono::duration_cast<vm::Time>(
          std::chrono::steady_clock::now().time_since_epoch());
    };
  }
  const QuietStderr quiet;
  auto library = std::make_unique<PortAudioLibrary>();
  if (library->error() != paNoError) {
    return vm::Fail(vm::Errc::kUnavailable,
                    "the sound system cannot be used, or has no configuration");
  }
  const auto chosen = ChooseOutputDevice(device);
  if (!chosen) return std::unexpected(chosen.error());
  auto sink = std::make_unique<PortAudioSink>(scheduler, std::move(library), std::move(instants));
  if (auto opened = sink->Open(*chosen); !opened) return std::unexpected(opened.error());
  return sink;
}

bool HasSoundDevice() {
  const QuietStderr quiet;
  const PortAudioLibrary library;
  return library.error() == paNoError && ChooseOutputDevice({}).has_value();
}

}  // namespace ssm
