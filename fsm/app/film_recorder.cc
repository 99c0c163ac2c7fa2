#include "fsm/app/film_recorder.h"

#include <fmt/format.h>

#include <limits>

namespace fsm {
namespace {
constexpr long kMaxRepeatsAtOnce = 4;
}

FilmRecorder::FilmRecorder(vm::Scheduler& clock, FaceView& view, const MediaFiles& files, Draw draw,
                           OnFailure on_failure)
    : clock_(clock),
      view_(view),
      files_(files),
      draw_(std::move(draw)),
      on_failure_(std::move(on_failure)),
      queue_(view, [this](const Image& frame, long times) { return Write(frame, times); }) {}

vm::Result<void> FilmRecorder::Start(const std::string& path, int frames_per_second) {
  if (recording()) {
    return vm::Fail(vm::Errc::kBusy, "recording " + path_ + "; set Record = STOP first");
  }
  width_ = view_.width();
  height_ = view_.height();
  auto writer = files_.open_film(path, width_, height_, frames_per_second, "");
  if (!writer) return std::unexpected(writer.error());
  writer_ = std::move(*writer);
  path_ = path;
  series_ = {clock_.Now(), static_cast<double>(frames_per_second)};
  next_ = 0;
  repeated_ = 0;
  Arm();
  return {};
}

void FilmRecorder::Arm() {
  timer_.At(series_.TimeOf(next_), [this] { Tick(); });
}

void FilmRecorder::Tick() {
  // With a slow encoder the module must still handle its input, so the remaining frames follow
  // after that.
  if (auto added = AddUpTo(clock_.Now(), kMaxRepeatsAtOnce); !added) {
    queue_.Clear();
    writer_.reset();
    on_failure_(added.error());
    return;
  }
  Arm();
}

vm::Result<void> FilmRecorder::AddUpTo(vm::Time now, long most_repeats) {
  // A frame whose successor is due too is not drawn; the frame before is repeated.
  const long first = next_;
  while (next_ > 0 && series_.TimeOf(next_ + 1) <= now) {
    if (next_ - first == most_repeats) break;
    if (auto added = queue_.Repeat(); !added) return added;
    ++next_;
    ++repeated_;
  }
  if (auto drawn = draw_(next_, series_.TimeOf(next_)); !drawn) return drawn;
  if (view_.width() != width_ || view_.height() != height_) {  // the user has resized the window
    return vm::Fail(vm::Errc::kUnavailable,
                    fmt::format("the film {} of {} x {} has ended, for the view is {} x {} now",
                                path_, width_, height_, view_.width(), view_.height()));
  }
  ++next_;
  auto added = queue_.Add();
  return added && writer_->is_live() ? queue_.Flush() : added;
}

vm::Result<void> FilmRecorder::Write(const Image& frame, long times) {
  vm::Result<void> added;
  for (; added && times > 0; --times) added = writer_->Add(frame);
  return added;
}

vm::Result<FilmRecorder::Summary> FilmRecorder::Stop(const std::string& sound) {
  if (!recording()) return vm::Fail(vm::Errc::kBadValue, "no film is being recorded");
  timer_.Cancel();
  // Frames that were due before now belong to the film; the one due right now does not, but a film
  // has at least one.
  const vm::Time stop = clock_.Now();
  vm::Result<void> added;
  while (added && (next_ == 0 || series_.TimeOf(next_) < stop)) {
    added = AddUpTo(stop - vm::Time(1), std::numeric_limits<long>::max());
  }
  if (added) added = queue_.Flush();
  Summary summary{path_, next_, repeated_};
  const auto writer = std::move(writer_);
  if (!added) {
    queue_.Clear();
    return std::unexpected(added.error());
  }
  if (auto finished = writer->Finish(sound); !finished) return std::unexpected(finished.error());
  return summary;
}

}  // namespace fsm
