#pragma once

#include "fsm/rig/head_asset.h"

namespace fsm {

/// Checks that an asset meets the requirements of Head: arrays match in size, every index is in
/// range, and the rig has what RigData and its steps (RigStep) need. Throws vm::Failure (kBadValue)
/// naming the member, as "rig.mouth.seam[3]: vertex 900 of 800".
void CheckAsset(const HeadAsset& asset);

}  // namespace fsm
