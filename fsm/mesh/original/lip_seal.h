#pragma once

#include <cstddef>

#include "fsm/mesh/unrigged_head.h"
#include "fsm/rig/lip_rig.h"

namespace fsm {

/// Makes the rig of a mesh's lips, which keeps them from crossing and closes them on demand, from
/// its seam and the first `count` vertices. Returns an empty rig if there is no seam.
LipRig LipsOf(const UnriggedHead& model, std::size_t count);

}  // namespace fsm
