#pragma once

#include <algorithm>
#include <string>
#include <utility>

#include "srm/align/phone_aligner.h"
#include "srm/engine/free_phonemes.h"
#include "srm/engine/pocketsphinx_handle.h"

/// Private to srm/align.
namespace srm {

inline constexpr int kFrameMs = 10;
/// Frames are counted from their first sample, but what they hold lies around their middle, half a
/// window (25.6 ms) later; 8 ms leave no bias against flite's own times.
inline constexpr Millis kHalfWindow{8};

/// A whole utterance at once.
inline void HearWhole(ps_decoder_t* decoder, const std::vector<std::int16_t>& samples) {
  ps_start_utt(decoder);
  ps_process_raw(decoder, samples.data(), samples.size(), FALSE, TRUE);
  ps_end_utt(decoder);
}

/// Collects the phonemes of a decoder, one behind the other, from 0 to the end of the sound.
class SegmentCollector {
 public:
  explicit SegmentCollector(std::size_t samples)
      : end_(static_cast<std::int64_t>(samples / kFramesPerMs)) {}

  void Add(std::string name, int first_frame) {
    const Millis start =
        first_frame == 0 ? Millis{0} : std::min(Millis(first_frame * kFrameMs) + kHalfWindow, end_);
    Close(start);
    if (name == "pau" && !list_.empty() && list_.back().name == "pau") return;
    list_.push_back({std::move(name), Millis{0}});
    at_ = start;
  }
  Millis at() const { return at_; }
  vm::PhonemeList Finish() {
    Close(end_);
    if (list_.empty()) list_.push_back({"pau", end_});
    std::erase_if(list_, [](const vm::Phoneme& p) { return p.duration.count() == 0; });
    return std::move(list_);
  }
  Millis end() const { return end_; }

 private:
  void Close(Millis until) {
    if (list_.empty()) {
      if (until.count() > 0) list_.push_back({"pau", until});
    } else {
      list_.back().duration += until - Total();
    }
  }
  Millis Total() const { return vm::TotalDuration(list_); }

  const Millis end_;
  Millis at_{0};
  vm::PhonemeList list_;
};

}  // namespace srm
