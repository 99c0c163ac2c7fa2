#pragma once

#include <array>
#include <vector>

#include "fsm/mesh/mesh_model.h"
#include "fsm/mesh/original/original_face.h"

namespace fsm {

/// The mouth of each viseme 1..27 at full articulation, in FaceState's parameters, and then those
/// that speech shows by other sets of visemes: mixed of these.
using VisemeMouths = std::vector<std::array<float, kMouthParameters>>;
/// What Mouth.N asks of its parameter at 100 per cent; 0 = that it moves nothing.
using MouthUnitSizes = std::array<float, kMouthParameters>;

/// The rig of a face from its own shapes: action units by their FACS number, visemes by what speech
/// asks of the mouth, and mouth units by what is asked by hand (Mouth.N): each shows the one of its
/// number, whatever that is (in the data of the original, mostly vowels).
RigData RigOfOriginal(const OriginalFace& face, const MeshModel& model, const VisemeMouths& mouths,
                      const MouthUnitSizes& unit_sizes = {});

}  // namespace fsm
