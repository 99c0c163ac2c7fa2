#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "fsm/head/cage.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"
#include "fsm/head/photo_head.h"
#include "fsm/head/photo_lids.h"
#include "fsm/rig/head.h"

namespace fsm {

/// Takes the colours of what the photo does not show from `head`.
void TakeColours(const PhotoHead& head, Palette& palette);

/// The sheet that carries hair, neck and clothes of a photo. It turns with the head as skin does.
void AddSheet(const PhotoHead& head, HeadMesh& mesh);

/// Glasses are in the photo on the skin. It stays where they rest, or they would bend with it.
/// `eye`: centre of the left one at rest, (x, y) of the base identity.
void HoldBehindGlasses(glm::vec2 eye, std::size_t skin_count, HeadMesh& mesh);

/// How far forward (z, millimetres) the neck reaches at a height above PhotoHead::skin_bottom_y:
/// skin behind that faces the camera again, but is not the face's. What covers a photo with skin
/// (face_fit) and what leaves skin out where the sheet is go by the same line.
float JawLine(float above_bottom);

/// Skin the photo does not show, behind the outline and below the jaw, where the sheet is: it goes,
/// and what is beside it fades (HeadMesh::opacity). The nostrils, which are lined like the mouth,
/// become skin: the photo shows how dark they are. `tags`: of the skin's vertices, the mesh's
/// first.
void LeaveOutUnseen(const PhotoHead& head, std::span<const CageTag> tags, HeadMesh& mesh);

/// Gives every vertex of skin and sheet its place in the photo, lids and lips their own paint.
/// `lip_inside`: the colour of lips that roll inward if `head` has none.
void WearPhoto(const PhotoHead& head, const PhotoSkin& skin, glm::vec3 lip_inside,
               HeadTopology& topology);

}  // namespace fsm
