#pragma once

#include <memory>
#include <string_view>

#include "fsm/head/identity.h"
#include "fsm/rig/head.h"

namespace fsm {

struct PhotoHead;

/// The built-in head called `identity`. Nobody's two sides move quite alike: a few percent, fixed
/// for each identity, unless `asymmetric` is false. Deterministic. Throws std::runtime_error
/// listing the names if there is none of that name, and if a table is damaged.
std::unique_ptr<Head> MakeHead(std::string_view identity, bool asymmetric = true);
/// The head of an identity of one's own. Throws std::runtime_error for an unknown slider.
std::unique_ptr<Head> MakeHead(Identity identity, bool asymmetric = true);
/// A head made from a photo: its base face, warped and wearing the photo. Throws as the first, and
/// std::runtime_error if `head` does not fit together.
std::unique_ptr<Head> MakeHead(const PhotoHead& head);
/// The rig of such a head's skin alone, whose vertices are the first of the head. The photo is not
/// needed.
Rig MakeSkinRig(const PhotoHead& head);

}  // namespace fsm
