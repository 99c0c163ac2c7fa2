#pragma once

#include "fsm/rig/head_asset.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Checks that an asset meets the requirements of Head: arrays match in size, every index is in
/// range, and the rig has what RigData and its steps (RigStep) need. Error: kBadValue naming the
/// member, as "rig.mouth.seam[3]: vertex 900 of 800".
vm::Result<void> CheckAsset(const HeadAsset& asset);

}  // namespace fsm
