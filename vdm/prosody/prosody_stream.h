#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "vdm/prosody/phrase_tracker.h"
#include "vdm/prosody/prosody_tracker.h"
#include "vdm/prosody/speaker_usual.h"
#include "vdm/prosody/syllable_counter.h"

namespace vdm {

/// Prosody beside a mouth: sound goes to both, and when the mouth of an instant is known this one
/// goes on to the newest prosody that is known then, which does not depend on how the sound was
/// cut. It keeps the speaker's usual and where in a phrase the speaker is. The mouth's network also
/// says what is speech. Thread: none of its own; one instance, one thread.
class ProsodyStream {
 public:
  static constexpr std::size_t kHop = ProsodyTracker::kHop;
  /// `mouth_ahead`: how many samples after a moment's own the mouth has heard when it is told.
  explicit ProsodyStream(std::size_t mouth_ahead) : mouth_ahead_(mouth_ahead) {}

  /// The same sound as the mouth's tracker gets, before its moments are taken.
  void Add(std::span<const std::int16_t> samples);
  /// The mouth is known for the instant `sample`, and there is speech as likely as `speech01`.
  /// `hop(const ProsodyFrame&)` is called for each 10 ms of prosody that is known more.
  template <typename Hop>
  void Advance(std::uint64_t sample, float speech01, Hop hop) {
    const auto known = static_cast<std::int64_t>(sample + mouth_ahead_) -
                       static_cast<std::int64_t>(ProsodyTracker::kAhead);
    for (; static_cast<std::int64_t>(next_ * kHop) <= known && !frames_.empty(); ++next_) {
      const ProsodyFrame frame = frames_.front();
      frames_.pop_front();
      Take(frame, speech01);
      hop(frame);
    }
  }
  const SpeakerUsual& usual() const { return usual_; }
  void set_usual(const SpeakerUsual& usual) { usual_ = usual; }
  const PhraseTracker& phrases() const { return phrases_; }
  /// The nucleus of a syllable has ended with the last frame.
  bool syllable_ended() const { return syllable_ended_; }
  /// The instant of the last frame taken, in samples.
  std::uint64_t at() const { return next_ == 0 ? 0 : (next_ - 1) * kHop; }

 private:
  void Take(const ProsodyFrame& frame, float speech01);
  void CountSyllables(const ProsodyFrame& frame);

  const std::size_t mouth_ahead_;
  ProsodyTracker tracker_;
  std::deque<ProsodyFrame> frames_;
  std::vector<ProsodyFrame> new_;
  std::uint64_t next_ = 0;
  SpeakerUsual usual_;
  PhraseTracker phrases_;
  SyllableCounter syllables_;
  bool syllable_ended_ = false;
  int phrase_hops_ = 0, speech_hops_ = 0, phrase_syllables_ = 0;  // of the phrase in hand
};

}  // namespace vdm
