#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "fsm/head/cage.h"
#include "fsm/head/face_light.h"
#include "fsm/head/features.h"
#include "fsm/head/head_mesh.h"
#include "fsm/rig/head.h"

namespace fsm {

/// Where vertices of the skin lie and which way they face.
struct SkinPose {
  std::span<const glm::vec3> position;  ///< millimetres
  std::span<const glm::vec3> normal;    ///< unit
};

/// A photo, and where it shows the skin: TextureMaps::texcoord and weight.
struct PhotoMapping {
  const Image& photo;
  std::span<const glm::vec2> texcoord;
  std::span<const float> weight;
};

/// What a photo shows at a place (u, v down), on the screen, 0..1.
glm::vec3 PhotoColour(const Image& photo, glm::vec2 place);

/// The skin of a face as a photo of open eyes shows it: its vertices, all of one length.
struct PhotoSkin {
  std::span<const BakeWeights> weights;
  std::span<const CageTag> tags;
  SkinPose open, shut;  ///< with lids at rest and shut
};

/// Paints the shut lids of a face that wears a photo of open eyes; `features` says how they look.
/// `glasses`: the person wears them, so nothing above the eye is taken for lashes.
///
/// A shutting lid slides out from under the skin above it. That skin keeps its place in the photo,
/// but the lashes of the open eye do not, and the eye is covered by skin with the grain of the
/// lower lid. At its upper edge the lid has the colour of the skin round the eye; places there that
/// are darker or brighter than most (glasses, brows, reflections) do not count. Further down the
/// lid takes the light that falls on the face.
std::vector<ShutLid> PaintLids(const PhotoMapping& mapping, const PhotoSkin& skin, bool glasses,
                               const Features& features, const FaceLight& light);

/// The light of a photo, from the front of the face that wears it.
FaceLight FitFaceLight(const PhotoMapping& mapping, const SkinPose& open);

}  // namespace fsm
