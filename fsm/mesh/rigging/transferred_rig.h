#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fsm/mesh/transfer/deformation_transfer.h"
#include "fsm/mesh/unrigged_head.h"

namespace fsm {

/// Returns the triangles of a built-in head's skin, lips and mouth.
std::vector<std::uint32_t> SkinTriangles(const HeadSurface& surface);
/// Returns the triangles of a built-in head's eyeballs.
std::vector<std::uint32_t> EyeballTriangles(const HeadSurface& surface);

/// Makes a rig whose skin moves like that of `source`, a built-in head; `pairs` are in our frame.
/// Adds the lips of the source to `model` as vertices that are not drawn. Throws as
/// DeformationTransfer, with the model's name before the text.
RigData TransferRig(UnriggedHead& model, const Head& source, std::span<const PointPair> pairs);

}  // namespace fsm
