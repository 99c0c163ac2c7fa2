#pragma once

#include "fsm/app/fsm_core.h"

namespace fsm {

/// FaceExp.NAME.PATTERN, what each expression looks like: asked, set, saved. `def FaceExp.NAME =
/// LOOK` (pattern 1) and `def FaceExp.NAME.PATTERN = LOOK` make new ones, `del FaceExp.NAME` takes
/// an own one away and brings a changed one back. `Run = INIT` forgets them. At most 200 own names
/// between two of these.
void DeclareExpressionSlots(FsmCore& core);

}  // namespace fsm
