#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "ssm/voice/audio_sink.h"
#include "vm_protocol/core/scheduler.h"

namespace ssm {

/// Plays one utterance at a time through a sink and tells what is heard when. Positions come from
/// the sink, never from the clock alone: on a device that lags, everything is told later.
/// Thread: the scheduler's. The sink and the scheduler outlive the player.
class Player {
 public:
  /// Something to tell when a frame has been heard.
  struct Cue {
    std::size_t frame = 0;
    std::function<void()> action;
  };
  struct Events {
    std::function<void()> started;                 ///< the first frame is due
    std::function<void(std::size_t frames)> sync;  ///< every sync interval
    /// All was heard, or the sink failed (then `failed`). The player is idle already.
    std::function<void(AudioSink::Position, bool failed)> ended;
  };

  Player(vm::Scheduler& scheduler, AudioSink& sink, Events events);
  ~Player();
  Player(const Player&) = delete;

  /// Cues must be in order of frame. `started` comes within this call if `start` is not later
  /// than now. Error: from the sink; the player stays idle. REQUIRES: idle.
  vm::Result<void> Start(std::shared_ptr<const SampleBuffer> samples, vm::Time start,
                         std::vector<Cue> cues);
  /// Ends it and returns what was heard; no event follows. REQUIRES: active.
  AudioSink::Position Stop();
  /// From the next one on. Zero frames = none.
  void set_sync_interval(std::size_t frames);

  bool active() const { return samples_ != nullptr; }
  bool started() const { return started_; }
  /// REQUIRES: active.
  AudioSink::Position Where() const { return sink_.Where(); }

 private:
  void Begin();
  void Step();
  void Arm();
  std::size_t NextFrame() const;
  AudioSink::Position Finish();

  vm::Scheduler& scheduler_;
  AudioSink& sink_;
  const Events events_;
  std::shared_ptr<const SampleBuffer> samples_;
  vm::Time start_{0};
  bool started_ = false;
  std::vector<Cue> cues_;
  std::size_t next_cue_ = 0;
  std::size_t sync_interval_ = 0;
  std::size_t next_sync_ = 0;
  vm::TimerId timer_ = 0;
  std::size_t run_ = 0;  // counts utterances, so that a step notices that an event ended its own
};

}  // namespace ssm
