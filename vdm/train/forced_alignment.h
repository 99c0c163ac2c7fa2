#pragma once

#include <Eigen/Core>

#include "vm_protocol/core/phonemes.h"

namespace vdm {

/// When each phoneme of a recording is spoken.
struct ForcedAlignment {
  vm::PhonemeList phonemes;  ///< with pauses (pau) where there are some; multiples of 10 ms
  double fit = 0;  ///< mean logarithm of how likely a frame of speech is its phoneme, <= 0
};

/// Finds it by the likeliest way (Viterbi over segments) through the phonemes' classes of sounds
/// (tables/sounds.txt), so that it serves any language whose phonemes have names of ours. Between
/// any two phonemes, before the first and after the last there may be a pause. `features`:
/// FeaturesOf the recording, kPhones. `phonemes`: without pauses, as long as a voice speaks them in
/// turn: the recording's may be longer or shorter, all alike rather than one of them. REQUIRES: at
/// least one phoneme. A recording too short for its phonemes gives none at all.
ForcedAlignment AlignPhonemes(const Eigen::MatrixXf& features, const vm::PhonemeList& phonemes);

}  // namespace vdm
