#pragma once

#include "fsm/motion/inputs/motion_tables.h"
#include "fsm/motion/speech/viseme_track.h"
#include "vdm/train/mouth_loss.h"
#include "vm_protocol/core/phonemes.h"

namespace vdm {

/// What the face's own mouth does for a list of phonemes: the truth of training and of the bench.
/// `tables` outlives it.
class TextDrivenMouth {
 public:
  TextDrivenMouth(const vm::PhonemeList& phonemes, const fsm::MotionTables& tables);
  fsm::MouthPose At(double ms) const { return track_.At(ms); }
  const std::string& PhonemeAt(double ms) const { return track_.PhonemeAt(ms); }
  double length_ms() const { return track_.length_ms(); }
  /// At `count` instants from `start_ms` on, `step_ms` apart.
  MouthTruth Sampled(double start_ms, double step_ms, std::size_t count) const;

 private:
  fsm::VisemeTrack track_;
};

/// The mouth of what is no speech.
MouthTruth ClosedMouth(std::size_t count);

}  // namespace vdm
