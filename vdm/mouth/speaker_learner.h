#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "vdm/mouth/mouth_tracker.h"
#include "vdm/mouth/speaker.h"

namespace vdm {

/// Where a sound is loud: first and end, in steps of 10 ms. Loud is within 25 dB of the loudest
/// step and 10 dB above the quietest; holes below 100 ms are part of it, and what is shorter than
/// 100 ms is none.
struct Stretch {
  std::size_t first = 0, end = 0;
};
std::vector<Stretch> LoudStretches(const std::vector<float>& levels_db);

/// Meets a new speaker, who says the table's vowels one after the other with pauses between: of the
/// vocal tracts in the table that one is theirs with which the network hears those vowels best, in
/// their middles (after the papers' choice among stored weights by five vowels). All are heard at
/// once, so the cost is that of as many trackers. Lifetime: network and table outlive it.
class SpeakerLearner {
 public:
  static constexpr std::size_t kMostSteps = 2000;  ///< 20 s
  SpeakerLearner(const MouthNet& net, const VowelTable& table);
  /// The speaker once the last vowel is over for 300 ms. Error: kBadValue (more stretches of sound
  /// than vowels; not all within 20 s; they do not sound like these vowels; the network does not
  /// know them).
  std::optional<vm::Result<Speaker>> Add(std::span<const std::int16_t> samples);
  /// The sound has ended.
  vm::Result<Speaker> Finish();

 private:
  struct Candidate {
    float warp = 1;
    std::unique_ptr<MouthTracker> tracker;
    std::vector<std::vector<float>> logs;  // step by step: of each vowel's likelihood
  };
  void Measure(std::span<const std::int16_t> samples);
  double FitOf(const Candidate& candidate, const std::vector<Stretch>& stretches) const;
  vm::Result<Speaker> Best(const std::vector<Stretch>& stretches) const;
  vm::Error Failed(const std::string& what) const;

  const VowelTable& table_;
  std::vector<std::size_t> classes_;  // of the vowels, in the network
  std::vector<Candidate> candidates_;
  std::vector<std::int16_t> rest_;  // not yet a whole step
  std::vector<float> levels_;
};

}  // namespace vdm
