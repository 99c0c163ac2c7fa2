#include <algorithm>
#include <utility>

#include "sound/audio_source.h"

namespace sound {
namespace {
constexpr std::size_t kSamplesPerMs = 16;
}

RecordedSource::RecordedSource(vm::Scheduler& scheduler, std::vector<std::int16_t> samples)
    : scheduler_(scheduler), samples_(std::move(samples)) {
  const auto tail = static_cast<std::size_t>(kTail.count() / 1000) * kSamplesPerMs;
  samples_.resize(samples_.size() + tail);
}

RecordedSource::~RecordedSource() {
  if (timer_ != 0) scheduler_.Cancel(timer_);
}

vm::Result<void> RecordedSource::Start(Events events) {
  events_ = std::move(events);
  start_ = scheduler_.Now();
  timer_ = scheduler_.At(start_ + kStep, [this] { Step(); });
  return {};
}

/// Sound is handed over when it has been heard, not before.
void RecordedSource::Step() {
  timer_ = 0;
  const auto heard =
      static_cast<std::size_t>((scheduler_.Now() - start_).count() / 1000) * kSamplesPerMs;
  const std::size_t until = std::min(heard, samples_.size());
  const auto piece = std::span<const std::int16_t>(samples_).subspan(next_, until - next_);
  next_ = until;
  const bool over = next_ == samples_.size();
  if (!over) timer_ = scheduler_.At(scheduler_.Now() + kStep, [this] { Step(); });
  const auto ended = events_.ended;  // an event may be our end
  const auto sound = events_.sound;
  if (!piece.empty()) sound(piece);
  if (over) ended();
}

}  // namespace sound
