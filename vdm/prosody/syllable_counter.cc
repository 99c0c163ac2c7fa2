#include "vdm/prosody/syllable_counter.h"

#include <algorithm>

namespace vdm {

bool SyllableCounter::Add(float level_db, bool voiced) {
  const float level = (before_that_ + before_ + level_db) / 3;
  before_that_ = before_;
  before_ = level_db;
  if (rising_) {
    if (level > top_) {
      top_ = level;
      voiced_at_top_ = voiced;
    }
    if (level > top_ - kDip) return false;
    rising_ = false;
    bottom_ = level;
    return voiced_at_top_;
  }
  bottom_ = std::min(bottom_, level);
  if (level < bottom_ + kDip) return false;
  rising_ = true;
  top_ = level;
  voiced_at_top_ = voiced;
  return false;
}

}  // namespace vdm
