#pragma once

#include "fsm/rig/head_asset.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Whether an asset is as Head requires it: arrays fit together, every index is within what it
/// points into, and the rig has what RigData and its steps (RigStep) say they need. Errors:
/// kBadValue naming the member, "rig.lips.seam[3]: vertex 900 of 800".
vm::Result<void> CheckAsset(const HeadAsset& asset);

}  // namespace fsm
