#pragma once

#include <array>
#include <vector>

#include "fsm/mesh/original/original_face.h"
#include "fsm/mesh/unrigged_head.h"

namespace fsm {

/// The mouth parameters (FaceState::mouth) of each viseme 1..27 at full articulation, followed by
/// mouths of other sets of visemes, which are reproduced as combinations of the 27.
using VisemeMouths = std::vector<std::array<float, kMouthParameters>>;
/// The value of each mouth parameter when the slot Mouth.N is at 100 per cent; 0 = it moves
/// nothing.
using MouthUnitSizes = std::array<float, kMouthParameters>;

/// Makes the rig of a face from its own shapes. Action units are driven by FaceState::au, visemes
/// by FaceState::mouth, and mouth unit N by parameter N of FaceState::mouth_by_hand (slot Mouth.N),
/// whatever that unit shows (in the data of the original, mostly vowels).
RigData RigOfOriginal(const OriginalFace& face, const UnriggedHead& model,
                      const VisemeMouths& mouths, const MouthUnitSizes& unit_sizes = {});

}  // namespace fsm
