#pragma once

#include <Eigen/Core>
#include <vector>

#include "vdm/prosody/head_net.h"
#include "vdm/prosody/phrase_tracker.h"
#include "vdm/prosody/prosody_tracker.h"
#include "vdm/prosody/speaker_usual.h"

namespace vdm {

/// Makes the inputs of a HeadNet of prosody, and of what the mouth's network says, as they come,
/// each 10 ms. Pitch and power are told in deviations from the speaker's own usual; where there is
/// no voice the pitch goes to the usual one, and where there is no speech all is as in silence.
/// Used by who trains and by who moves.
class HeadInputs {
 public:
  /// `sounds`: how many classes of sounds the network asks for, HeadNet::sounds; 0: none.
  explicit HeadInputs(std::size_t sounds)
      : size_(HeadNet::InstantSize(sounds)), ring_(kKept, std::vector<float>(size_)) {
    for (std::vector<float>& instant : ring_) instant[kPower] = kSilent;
  }
  /// `sounds`: how likely each class is. REQUIRES: as many as the network asks for, or it asks for
  /// none; `usual` and `phrases` have taken the frame already.
  void Add(const ProsodyFrame& frame, const SpeakerUsual& usual, const PhraseTracker& phrases,
           const std::vector<float>& sounds);
  /// Of the last instant. `emotion`: the factor, 0 .. 1.
  Eigen::VectorXf Vector(float emotion) const;

 private:
  static constexpr std::size_t kKept = (HeadNet::kInstants - 1) * HeadNet::kApart + 1;
  enum Value : std::size_t { kPitch, kPower, kPosition, kSounds };
  static constexpr float kSilent = -3;
  const std::size_t size_;
  std::vector<std::vector<float>> ring_;
  std::size_t last_ = 0;
};

}  // namespace vdm
