#include "vdm/core/voice_manner.h"

#include <utility>

namespace vdm {

VoiceManner::VoiceManner(const Parts& parts, std::size_t mouth_ahead, std::size_t mouth_hop)
    : parts_(parts), mouth_hop_(mouth_hop), stream_(mouth_ahead) {
  stream_.set_usual(parts.usual);
  if (parts.head) {
    mover_ = std::make_unique<HeadMover>(*parts.head, parts.seed);
    head_.emplace();
  }
  if (parts.emotions) reader_ = std::make_unique<EmotionReader>(*parts.emotions);
}

const std::vector<double>& VoiceManner::emotions() const {
  static const std::vector<double> none;
  return reader_ ? reader_->likelihoods() : none;
}

float VoiceManner::Aroused() const {
  const std::vector<double>& likely = emotions();
  for (std::size_t k = 0; k < likely.size(); ++k) {
    if (parts_.emotions->classes[k].name == kAroused) return static_cast<float>(likely[k]);
  }
  return 0;
}

void VoiceManner::Take(MouthTracker::Moment moment, const Settings& settings, const Tell& tell) {
  const std::vector<float>& sounds = moment.frame.sounds;
  stream_.Advance(moment.sample, 1 - sounds.front(), [&](const ProsodyFrame& frame) {
    last_ = frame;
    if (reader_ && reader_->Add(frame, stream_)) emotion_changed_ = true;
    if (!mover_) return;
    head_ = mover_->Add(frame, stream_.usual(), stream_.phrases(), sounds,
                        settings.emotion.value_or(Aroused()), settings.head_size);
  });
  const std::size_t wait = head_ ? std::min(settings.wait, kHeadLate) / mouth_hop_ : 0;
  waiting_.push_back(std::move(moment));
  while (waiting_.size() > wait) {
    const MouthTracker::Moment due = std::move(waiting_.front());
    waiting_.pop_front();
    tell(due, head_);
  }
}

void VoiceManner::Finish(const Tell& tell) {
  for (; !waiting_.empty(); waiting_.pop_front()) tell(waiting_.front(), head_);
}

}  // namespace vdm
