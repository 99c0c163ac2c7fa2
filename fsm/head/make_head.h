#pragma once

#include <memory>
#include <string_view>

#include "fsm/head/identity.h"
#include "fsm/rig/head.h"

namespace fsm {

struct PhotoHead;

/// Makes the built-in head named `identity`. The two sides move slightly differently, by a few
/// percent fixed for each identity. Deterministic. Throws
/// std::runtime_error listing the names if the name is unknown, and if a table is damaged.
std::unique_ptr<Head> MakeHead(std::string_view identity);
/// Makes the head of a user's own identity. Throws std::runtime_error for an unknown slider.
std::unique_ptr<Head> MakeHead(Identity own);
/// Make such heads whose sides move alike.
std::unique_ptr<Head> MakeSymmetricHead(std::string_view identity);
std::unique_ptr<Head> MakeSymmetricHead(Identity own);
/// Makes a head from a photo: its base face, warped and wearing the photo. Throws as the first, and
/// std::runtime_error without `photo_head.atlas`. REQUIRES: sheet_triangles index `sheet`, as
/// ReadPhotoHead makes sure.
std::unique_ptr<Head> MakeHead(const PhotoHead& photo_head);
/// Makes the rig of the skin alone of such a head, whose vertices are the first of the head. It
/// does not need the photo.
Rig MakeSkinRig(const PhotoHead& photo_head);

}  // namespace fsm
