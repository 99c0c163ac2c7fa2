#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "fsm/head/cage.h"
#include "fsm/head/identity.h"
#include "fsm/head/mesh_builder.h"
#include "fsm/head/photo_head.h"
#include "fsm/head/photo_lids.h"
#include "fsm/rig/head.h"

namespace fsm {

/// Takes the colours of parts that the photo of `photo_head` does not show.
void CopyColours(const PhotoHead& photo_head, Palette& palette);

/// Adds the sheet with hair, neck and clothes of a photo. It turns with the head as skin does.
void AddPhotoSheet(const PhotoHead& photo_head, MeshBuilder& mesh);

/// Keeps the skin still where glasses rest, which the photo shows on the skin, or they would bend.
/// `eye`: centre of the left eye at rest, (x, y) of the base identity.
void FreezeSkinBehindGlasses(const Features& features, glm::vec2 eye, std::size_t skin_count,
                             MeshBuilder& mesh);

/// Returns how far forward (z, millimetres) the neck reaches at a height above
/// PhotoHead::skin_bottom_y. Skin behind this line may face the camera but is not the face's. The
/// code that maps a photo to skin (face_fit) and the code that removes skin over the sheet share
/// it.
float NeckFrontZ(float above_bottom_mm);

/// Removes skin that the photo does not show, behind the outline and below the jaw, where the sheet
/// is, and fades the skin beside it (MeshBuilder::opacity). The nostrils' lining becomes skin,
/// since the photo shows how dark they are. `tags`: those of the skin's vertices, the first of the
/// mesh.
void RemoveUnseenSkin(const PhotoHead& photo_head, std::span<const CageTag> tags,
                      MeshBuilder& mesh);

/// Gives every vertex of skin and sheet its texture coordinate in the photo, and lids and lips
/// their own paint. `lip_inside`: colour of lips that roll inward if `photo_head` has none.
void ApplyPhoto(const PhotoHead& photo_head, const PhotoSkin& skin, glm::vec3 lip_inside,
                HeadSurface& surface);

}  // namespace fsm
