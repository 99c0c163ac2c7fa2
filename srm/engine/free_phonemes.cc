#include "srm/engine/free_phonemes.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace srm {

Segment ReadSegment(ps_seg_t* seg) {
  Segment part;
  std::int32_t sound = 0, language = 0, back = 0;
  ps_seg_frames(seg, &part.first, &part.last);
  ps_seg_prob(seg, &sound, &language, &back);
  part.score = sound;
  return part;
}

bool IsFiller(const std::string& word) {
  return word.empty() || word[0] == '<' || word[0] == '[' || word[0] == '+' || word == "SIL";
}

FreePhonemes::FreePhonemes(DecoderPtr decoder)
    : decoder_(std::move(decoder)), mean_(decoder_.get()) {}

void FreePhonemes::Begin() {
  mean_.Begin();
  ps_start_utt(decoder_.get());
}

void FreePhonemes::Feed(const std::vector<std::int16_t>& samples) {
  ps_process_raw(decoder_.get(), samples.data(), samples.size(), FALSE, FALSE);
}

bool FreePhonemes::End() {
  ps_end_utt(decoder_.get());
  mean_.End();
  return Read();
}

bool FreePhonemes::Again(const std::vector<std::int16_t>& samples) {
  mean_.UseOwn();
  ps_start_utt(decoder_.get());
  Feed(samples);
  ps_end_utt(decoder_.get());
  mean_.UseAll();
  return Read();
}

bool FreePhonemes::Read() {
  total_ = 0;
  by_frame_.clear();
  silent_.clear();
  if (ps_get_hyp(decoder_.get(), &total_) == nullptr) return false;
  for (ps_seg_t* seg = ps_seg_iter(decoder_.get()); seg != nullptr; seg = ps_seg_next(seg)) {
    const Segment part = ReadSegment(seg);
    if (part.frames() <= 0) continue;
    const double each = part.score / part.frames();
    by_frame_.resize(static_cast<std::size_t>(part.last) + 1, each);
    silent_.resize(by_frame_.size(), IsFiller(ps_seg_word(seg)));
  }
  return true;
}

double FreePhonemes::Score(int first, int last) const {
  double sum = 0;
  for (int i = std::max(first, 0); i <= last; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (at < by_frame_.size()) sum += by_frame_[at];
  }
  return sum;
}

bool FreePhonemes::Silent(int frame) const {
  const auto at = static_cast<std::size_t>(std::max(frame, 0));
  return at >= silent_.size() || silent_[at];
}

}  // namespace srm
