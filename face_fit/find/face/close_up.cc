#include "face_fit/find/face/close_up.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "face_fit/image/filters.h"
#include "face_fit/image/photo.h"

namespace facefit {
namespace {

constexpr float kBesideMm = 330, kAboveMm = 300, kBelowMm = 430;  // reach from the nose
/// Share of a photo above which a close-up counts as all of it.
constexpr float kNearlyAll = 0.95F;

/// Returns pixels per millimetre, measured between the outer corners of the eyes and from forehead
/// to chin; the larger value is the one less foreshortened.
float PixelsPerMm(const FoundFace& face) {
  constexpr float kHeightMm = 132;  // forehead to chin of the built-in head
  return std::max(
      glm::distance(face.points[point::kEyeOuterRight], face.points[point::kEyeOuterLeft]) /
          kEyesApartMm,
      glm::distance(face.points[point::kForehead], face.points[point::kChin]) / kHeightMm);
}

}  // namespace

CloseUp CloseUpOf(const fsm::Image& photo, const fsm::Image& finest, const FoundFace& face) {
  const glm::vec2 size(photo.width, photo.height), all(finest.width, finest.height);
  const glm::vec2 finer = all / size;
  const float pixels_per_mm = PixelsPerMm(face);
  const glm::vec2 nose = face.PixelOf(point::kNoseTip);
  const glm::vec2 low =
      glm::clamp(nose - pixels_per_mm * glm::vec2(kBesideMm, kAboveMm), glm::vec2(0), size);
  const glm::vec2 high =
      glm::clamp(nose + pixels_per_mm * glm::vec2(kBesideMm, kBelowMm), glm::vec2(0), size);
  // Rounding up may put the edge beyond the finest photo.
  const glm::ivec2 from = glm::floor(low * finer);
  const glm::ivec2 to = glm::min(glm::ceil(high * finer), all);
  const glm::ivec2 kept = to - from;
  const glm::vec2 share = glm::vec2(kept) / all;
  const bool whole = std::min(share.x, share.y) > kNearlyAll;
  if (whole || std::min(kept.x, kept.y) < 1) return {photo, face, 1};
  fsm::Image close = ScaledToFit(Cropped(finest, from.x, from.y, kept.x, kept.y), kWorkingSize);
  const glm::vec2 scale = glm::vec2(close.width, close.height) / glm::vec2(kept);
  const auto moved = [&](glm::vec2 p) { return (p * finer - glm::vec2(from)) * scale; };
  const float larger = finer.x * scale.x;
  FoundFace there = face;
  for (glm::vec3& p : there.points) p = glm::vec3(moved(glm::vec2(p)), p.z * larger);
  there.crop.centre = moved(face.crop.centre);
  there.crop.size *= larger;
  return {std::move(close), std::move(there), larger};
}

}  // namespace facefit
