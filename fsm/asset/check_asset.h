#pragma once

#include "fsm/rig/head_asset.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Whether the arrays of an asset fit together as Head requires it: lengths, and every index within
/// what it points into. Errors: kBadValue naming the member, "rig.lips.seam[3]: vertex 900 of 800".
vm::Result<void> CheckAsset(const HeadAsset& asset);

}  // namespace fsm
