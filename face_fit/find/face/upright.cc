#include "face_fit/find/face/upright.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "face_fit/find/network/face_finder.h"
#include "face_fit/image/filters.h"

namespace facefit {
namespace {

/// How clearly faces are seen upright. Each face counts 0..1, upside down 0. All faces count: in a
/// group the largest may lean far to one side.
struct Clearness {
  float upright = 0;  ///< sum over the faces
  /// The sum weighted by the detector's score, because the landmark network alone draws an upright
  /// face onto one that stands on its head.
  float detected = 0;
};

Clearness ClearnessOf(std::span<const FoundFace> faces) {
  Clearness clear;
  for (const FoundFace& face : faces) {
    const glm::vec2 eyes = face.AcrossEyes();
    const float cosine = eyes.x / std::max(glm::length(eyes), 1e-3F);
    const float upright = face.certainty * std::max(cosine, 0.0F);
    clear.upright += upright;
    clear.detected += face.score * upright;
  }
  return clear;
}

/// Mean clearness above which a photo counts as upright, for one face and for several: some of
/// several people may lean, but not all to the same side.
constexpr float kUprightOne = 0.93F, kUprightGroup = 0.75F;
/// By how much for each face another orientation must be better: photos that lie on a side are
/// rare.
constexpr float kClearer = 0.04F;

}  // namespace

UprightPhoto SetUpright(FaceNetworks& networks, fsm::Image photo) {
  std::vector<FoundFace> faces = FindFaces(networks, photo);
  int orientation = 1;
  const auto count = static_cast<float>(faces.size());
  const Clearness clear = ClearnessOf(faces);
  if (clear.upright <= count * (count > 1 ? kUprightGroup : kUprightOne)) {
    float best = clear.detected + kClearer * std::max(count, 1.0F);
    for (const int other : {6, 8, 3}) {
      auto turned_faces = FindFaces(networks, OrientedByExif(photo, other));
      const float detected = ClearnessOf(turned_faces).detected;
      if (detected <= best) continue;
      best = detected;
      orientation = other;
      faces = std::move(turned_faces);
    }
  }
  if (orientation != 1) photo = OrientedByExif(photo, orientation);
  return {std::move(photo), orientation, std::move(faces)};
}

}  // namespace facefit
