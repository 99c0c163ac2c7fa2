#pragma once

#include <functional>
#include <memory>
#include <string>

#include "fsm/app/frame_queue.h"
#include "fsm/app/frame_series.h"
#include "fsm/app/media_files.h"
#include "vm_protocol/core/timer.h"

namespace fsm {

/// Records a film of the face: frame k shows the face at start + k / rate exactly. If drawing falls
/// behind the clock, frames are repeated so that the film keeps pace; on the virtual clock that
/// never happens. Resizing the view ends the film with an error.
/// Thread: the scheduler's; a timer is pending while recording.
class FilmRecorder {
 public:
  /// Draws the face at `at` as frame `number`; the picture is then read from the view.
  using Draw = std::function<vm::Result<void>(long number, vm::Time at)>;
  /// Called when an error has ended the recording.
  using OnFailure = std::function<void(const vm::Error&)>;
  /// Lifetime: clock, view and files outlive this.
  FilmRecorder(vm::Scheduler& clock, FaceView& view, const MediaFiles& files, Draw draw,
               OnFailure on_failure);

  /// Errors: kBusy while recording; kUnavailable if the film cannot be opened.
  vm::Result<void> Start(const std::string& path, int frames_per_second);
  struct Summary {
    std::string path;
    long frames = 0;
    long repeated = 0;
  };
  /// Ends the film with the frames up to now and adds the sound file (may be ""). Errors: kBadValue
  /// when not recording; kUnavailable as FilmWriter::Finish.
  vm::Result<Summary> Stop(const std::string& sound);

  bool recording() const { return writer_ != nullptr; }
  /// The instant of frame 0. REQUIRES: recording.
  vm::Time start() const { return series_.start; }

 private:
  void Arm();
  void Tick();
  vm::Result<void> AddUpTo(vm::Time now, long most_repeats);
  /// Adds a frame to the film `times` times.
  vm::Result<void> Write(const Image& frame, long times);

  vm::Scheduler& clock_;
  FaceView& view_;
  const MediaFiles& files_;
  Draw draw_;
  OnFailure on_failure_;
  std::unique_ptr<FilmWriter> writer_;
  FrameQueue queue_;
  std::string path_;
  int width_ = 0, height_ = 0;  // of the film
  FrameSeries series_;
  long next_ = 0;
  long repeated_ = 0;
  vm::Timer timer_{clock_};
};

}  // namespace fsm
