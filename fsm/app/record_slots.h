#pragma once

#include <string>

#include "fsm/app/film_recorder.h"
#include "fsm/app/fsm_core.h"

namespace fsm {

/// The slot Record and its settings: films of the face.
class RecordSlots final : public SlotGroup {
 public:
  /// Declares the slots. `core` outlives this.
  explicit RecordSlots(FsmCore& core);
  /// Ends the film, if there is one; an error is reported as of the slot.
  void StopActivity() override;
  void RestoreInitial() override { frames_per_second_ = kFramesPerSecond; }

  bool recording() const { return film_.recording(); }
  int frames_per_second() const { return frames_per_second_; }

 private:
  static constexpr int kFramesPerSecond = 30;

  vm::Result<std::string> Set(const std::string& file);
  vm::Result<std::string> Stop();

  FsmCore& core_;
  FilmRecorder film_;
  int frames_per_second_ = kFramesPerSecond;
};

}  // namespace fsm
