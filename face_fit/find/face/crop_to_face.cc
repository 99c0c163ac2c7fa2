#include "face_fit/find/face/crop_to_face.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/picture/filters.h"
#include "face_fit/picture/photo.h"

namespace facefit {
namespace {

constexpr float kAside = 330, kAbove = 300, kBelow = 430;  // millimetres from the nose

/// Measured between the outer corners of the eyes and from forehead to chin; the larger of the two
/// is seen less at a slant.
float PixelsPerMm(const FoundFace& face) {
  constexpr float kHeight = 132;  // millimetres, of the built-in head
  return std::max(
      glm::distance(face.points[point::kEyeOuterRight], face.points[point::kEyeOuterLeft]) /
          kEyesApartMm,
      glm::distance(face.points[point::kForehead], face.points[point::kChin]) / kHeight);
}

}  // namespace

FaceCrop CropToFace(const fsm::Image& photo, const fsm::Image& finest, const FoundFace& face) {
  const glm::vec2 size(photo.width, photo.height), all(finest.width, finest.height);
  const glm::vec2 finer = all / size;
  const float pixels_per_mm = PixelsPerMm(face);
  const glm::vec2 nose = face.At(point::kNoseTip);
  const glm::vec2 low =
      glm::clamp(nose - pixels_per_mm * glm::vec2(kAside, kAbove), glm::vec2(0), size);
  const glm::vec2 high =
      glm::clamp(nose + pixels_per_mm * glm::vec2(kAside, kBelow), glm::vec2(0), size);
  // Scaled to the finest photo and rounded up, its edge may come to lie beyond it.
  const glm::ivec2 from = glm::floor(low * finer);
  const glm::ivec2 to = glm::min(glm::ceil(high * finer), all);
  const glm::ivec2 part = to - from;
  const glm::vec2 share = glm::vec2(part) / all;
  const bool whole = std::min(share.x, share.y) > 0.95F;
  if (whole || std::min(part.x, part.y) < 1) return {photo, face};
  FaceCrop out{ScaledToFit(Cropped(finest, from.x, from.y, part.x, part.y), kWorkingSize), face};
  const glm::vec2 scale = glm::vec2(out.photo.width, out.photo.height) / glm::vec2(part);
  const auto place = [&](glm::vec2 p) { return (p * finer - glm::vec2(from)) * scale; };
  const float larger = finer.x * scale.x;
  for (glm::vec3& p : out.face.points) p = glm::vec3(place(glm::vec2(p)), p.z * larger);
  out.face.crop.centre = place(face.crop.centre);
  out.face.crop.size *= larger;
  return out;
}

}  // namespace facefit
