#pragma once

#include <bitset>
#include <cstdint>

namespace vdm {

/// Where in a phrase somebody is who speaks, as far as that is known while it is spoken. Phrases
/// are what stands between pauses of kPause or more, as for the face that speaks a text. A plain
/// value.
class PhraseTracker {
 public:
  static constexpr int kPause = 11;         ///< hops of 10 ms
  static constexpr int kUsualLength = 200;  ///< hops of a phrase; longer ones are at their end

  /// The next 10 ms: how likely there is speech, and whether there is a voice.
  void Add(float speech01, bool voiced);

  /// Speech at this instant, as likely as not or more.
  bool speech() const { return pause_ == 0; }
  /// For a while now there has been speech, with a voice: noise and music are not taken for it.
  bool sure() const { return sure_; }
  /// Hops since the last speech.
  int pause() const { return pause_; }
  /// 0 in no speech and at the beginning of a phrase, 1 from a usual phrase's end on.
  float position01() const;
  /// Of phrases that were sure, from 1; 0 before the first.
  std::uint64_t phrase() const { return phrase_; }
  /// This hop is the first at which the phrase is sure.
  bool begins() const { return begins_; }

 private:
  static constexpr std::size_t kSeen = 25;
  static constexpr std::size_t kLikely = 12, kVoiced = 5;

  std::bitset<kSeen> likely_, voiced_;
  int pause_ = 1000;
  int length_ = 0;  // of the phrase so far
  std::uint64_t phrase_ = 0;
  bool known_ = false;  // the phrase has been sure
  bool sure_ = false, begins_ = false;
};

}  // namespace vdm
