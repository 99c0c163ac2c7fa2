#include "vdm/prosody/phrase_tracker.h"

#include <algorithm>

namespace vdm {

void PhraseTracker::Add(float speech01, bool voiced) {
  const bool likely = speech01 > 0.5F;
  likely_ = likely_ << 1;
  likely_[0] = likely;
  voiced_ = voiced_ << 1;
  voiced_[0] = likely && voiced;
  if (likely) {
    if (pause_ >= kPause) {
      length_ = 0;
      known_ = false;
    }
    pause_ = 0;
  } else {
    pause_ = std::min(pause_ + 1, 1'000'000);
  }
  length_ = std::min(length_ + 1, 1'000'000);
  sure_ = likely_.count() >= kLikely && voiced_.count() >= kVoiced;
  begins_ = sure_ && likely && !known_;
  if (!begins_) return;
  known_ = true;
  ++phrase_;
}

float PhraseTracker::position01() const {
  if (pause_ >= kPause) return 0;
  return std::min(1.0F, static_cast<float>(length_) / kUsualLength);
}

}  // namespace vdm
