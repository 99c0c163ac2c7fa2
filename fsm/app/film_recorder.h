#pragma once

#include <functional>
#include <memory>
#include <string>

#include "fsm/app/frame_queue.h"
#include "fsm/app/frame_series.h"
#include "fsm/app/media_files.h"
#include "vm_protocol/core/timer.h"

namespace fsm {

/// Records a film of the face: frame k is the face at start + k / rate exactly. When drawing falls
/// behind the clock, the frame before is repeated so that the film keeps step with time; on the
/// virtual clock that never happens. A view that gets another size ends the film as a failure.
/// Thread: the scheduler's; a timer is pending while recording.
class FilmRecorder {
 public:
  /// Draws frame `number` as the face is at `at`; the picture is then read from the view.
  using Draw = std::function<vm::Result<void>(long number, vm::Time at)>;
  /// Told when recording ended by itself because of an error.
  using OnFailure = std::function<void(const vm::Error&)>;
  /// Lifetime: clock, view and files outlive it.
  FilmRecorder(vm::Scheduler& clock, FaceView& view, const MediaFiles& files, Draw draw,
               OnFailure on_failure);

  /// Errors: kBusy while recording; kUnavailable if the film cannot be opened.
  vm::Result<void> Start(const std::string& path, int frames_per_second);
  struct Report {
    std::string path;
    long frames = 0;
    long repeated = 0;
  };
  /// Ends the film with the frames up to now and adds the sound (may be ""). Errors: kBadValue when
  /// none is being recorded; kUnavailable as FilmWriter::Finish.
  vm::Result<Report> Stop(const std::string& sound);

  bool recording() const { return writer_ != nullptr; }
  const std::string& path() const { return path_; }
  /// The instant of frame 0. REQUIRES: recording.
  vm::Time start() const { return series_.start; }

 private:
  void Arm();
  void Tick();
  vm::Result<void> AddUpTo(vm::Time now, long most_repeats);
  /// Hands a frame to the writer.
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
