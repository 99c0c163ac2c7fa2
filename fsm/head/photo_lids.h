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

/// Lids for a face that wears such a photo, looking as `features` says. With glasses nothing above
/// the eye is taken for lashes. A lid that shuts comes out from under the skin above
/// it: what the photo shows there stays where it is, but the lashes of the open eye, and the eye
/// gives way to skin with the grain of the lower lid's. At the top the skin is coloured like that
/// round the eye, as far as that is not darker or brighter than most of it (glasses, brows,
/// reflections); downward it comes out into the light that falls on the face.
std::vector<ShutLid> PaintLids(const PhotoMapping& mapping, const PhotoSkin& skin, bool glasses,
                               const Features& features, const FaceLight& light);

/// The light of a photo, from the front of the face that wears it.
FaceLight FitFaceLight(const PhotoMapping& mapping, const SkinPose& open);

}  // namespace fsm
