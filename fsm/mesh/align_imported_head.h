#pragma once

#include "fsm/mesh/imported_head.h"
#include "fsm/mesh/unrigged_head.h"

namespace fsm {

/// The y coordinate of the built-in heads' mouth, millimetres.
inline constexpr float kUsualMouthY = -43;
/// Transforms a head to our frame by `to_ours`. Parts are classified by their names; whether rigid
/// ones belong to the jaw follows from their position relative to the mouth, which is at `mouth_y`.
/// Throws std::runtime_error naming file and vertex if `to_ours` moves one beyond kMaxReach,
/// which happens if the landmarks do not belong to the head.
UnriggedHead AlignImportedHead(const ImportedHead& file, const Similarity& to_ours, float mouth_y);

}  // namespace fsm
