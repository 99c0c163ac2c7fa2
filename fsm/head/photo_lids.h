#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "fsm/head/cage.h"
#include "fsm/head/face_light.h"
#include "fsm/head/features.h"
#include "fsm/head/mesh_builder.h"
#include "fsm/rig/head.h"

namespace fsm {

/// Positions and normals of the skin's vertices.
struct SkinSurface {
  std::span<const glm::vec3> position;  ///< millimetres
  std::span<const glm::vec3> normal;    ///< unit length
};

/// A photo and its mapping to the skin: TextureMaps::texcoord and weight.
struct PhotoMapping {
  const Image& photo;
  std::span<const glm::vec2> texcoord;
  std::span<const float> weight;
};

/// Returns the photo's screen colour (0..1) at a texture coordinate, v down.
glm::vec3 PhotoColour(const Image& photo, glm::vec2 texcoord);

/// The skin of a face as a photo of open eyes shows it; all spans are per vertex, of one length.
struct PhotoSkin {
  std::span<const BakeWeights> weights;
  std::span<const CageTag> tags;
  SkinSurface open, shut;  ///< with lids at rest and with lids shut
};

/// Paints the shut lids of a face that wears a photo of open eyes; `features` describes their look.
/// `glasses`: the person wears glasses, so nothing above the eye counts as lashes.
///
/// A shutting lid slides out from under the skin above it. That skin keeps its place in the photo,
/// but the lashes of the open eye do not, and the eye is covered by skin with the grain of the
/// lower lid. At its upper edge the lid has the colour of the skin around the eye, ignoring places
/// that are unusually dark or bright (glasses, brows, reflections). Lower down it takes the light
/// that falls on the face.
std::vector<ShutLid> PaintLids(const PhotoMapping& mapping, const PhotoSkin& skin, bool glasses,
                               const Features& features, const FaceLight& light);

/// Fits the light of a photo to the front of the face that wears it.
FaceLight FitFaceLight(const PhotoMapping& mapping, const SkinSurface& open);

}  // namespace fsm
