#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fsm/mesh/mesh_model.h"
#include "fsm/mesh/transfer/deformation_transfer.h"

namespace fsm {

/// The triangles of a built-in head's skin, lips and mouth.
std::vector<std::uint32_t> SkinTriangles(const HeadTopology& topology);
/// The triangles of its eyeballs.
std::vector<std::uint32_t> EyeballTriangles(const HeadTopology& topology);

/// The rig of skin that moves as `source`, a built-in head, would; `pairs` in our frame. Adds
/// unseen vertices to `model`, the source's lips. Throws as DeformationTransfer, with the model's
/// name before the sentence.
RigData TransferRig(MeshModel& model, const Head& source, std::span<const PointPair> pairs);

}  // namespace fsm
