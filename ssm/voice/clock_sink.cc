#include <algorithm>
#include <cassert>
#include <utility>

#include "ssm/voice/audio_sink.h"

namespace ssm {

vm::Result<void> ClockSink::Play(std::shared_ptr<const SampleBuffer> samples, vm::Time start) {
  assert(!samples_);
  samples_ = std::move(samples);
  start_ = std::max(start, scheduler_.Now());
  return {};
}

AudioSink::Position ClockSink::Where() const {
  assert(samples_);
  return {std::min(FramesIn(scheduler_.Now() - start_), samples_->size()), start_, false};
}

AudioSink::Position ClockSink::Stop() {
  const Position position = Where();
  samples_.reset();
  return position;
}

}  // namespace ssm
