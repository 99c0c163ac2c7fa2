#include "vdm/prosody/prosody_stream.h"

#include <cmath>

namespace vdm {
namespace {
constexpr int kPhraseEnds = 26;  // hops of pause: after who measures phrases has measured this one
constexpr int kLeastSyllables = 3;  // of a phrase whose rate says something
}  // namespace

void ProsodyStream::Add(std::span<const std::int16_t> samples) {
  new_.clear();
  tracker_.Add(samples, new_);
  frames_.insert(frames_.end(), new_.begin(), new_.end());
}

void ProsodyStream::CountSyllables(const ProsodyFrame& frame) {
  const bool nucleus = syllables_.Add(frame.vowel_db, frame.hz > 0);
  syllable_ended_ = nucleus && phrases_.sure();
  if (phrases_.pause() < kPhraseEnds) {
    ++phrase_hops_;
    phrase_syllables_ += syllable_ended_ ? 1 : 0;
    if (phrases_.speech()) speech_hops_ = phrase_hops_;
    return;
  }
  if (phrase_syllables_ >= kLeastSyllables) {
    usual_.rate.Add(phrase_syllables_ * 100.0 / speech_hops_);
  }
  phrase_hops_ = speech_hops_ = phrase_syllables_ = 0;
}

void ProsodyStream::Take(const ProsodyFrame& frame, float speech01) {
  const bool voiced = frame.hz > 0;
  phrases_.Add(speech01, voiced);
  CountSyllables(frame);
  if (!voiced || !phrases_.sure() || !phrases_.speech()) return;
  usual_.log_hz.Add(std::log(static_cast<double>(frame.hz)));
  usual_.power_db.Add(static_cast<double>(frame.power_db));
  usual_.tilt_db.Add(static_cast<double>(frame.tilt_db));
}

}  // namespace vdm
