#include "face_fit/find/face/cut_off.h"

#include <algorithm>
#include <array>
#include <span>

#include "face_fit/find/face/coinciding_corners.h"
#include "face_fit/find/face/joined_names.h"
#include "face_fit/image/pixels.h"

namespace facefit {
namespace {

/// Distance from the network's cheek point to the outer edge of the ear.
constexpr float kEarMm = 10;

}  // namespace

CutOffParts FindCutOffParts(const FoundFace& face, const fsm::Image& photo) {
  const glm::vec2 ear = kEarMm / kEyesApartMm * face.AcrossEyes();
  const auto cut = [&](glm::vec2 pixel) { return !IsInside(photo, pixel); };
  return {.forehead = cut(face.PixelOf(point::kForehead)),
          .chin = cut(face.PixelOf(point::kChin)),
          .ears = {cut(face.PixelOf(point::kCheekRight) - ear),
                   cut(face.PixelOf(point::kCheekLeft) + ear)}};
}

std::string NamesOf(const CutOffParts& cut) {
  return JoinedNames({{cut.forehead, "the forehead"},
                      {cut.ears.right, "the right ear"},
                      {cut.ears.left, "the left ear"},
                      {cut.chin, "the chin"}});
}

vm::Result<void> CheckFeaturesShown(const FoundFace& face, const fsm::Image& photo) {
  const auto cut = [&](std::span<const PointIndex> points) {
    return std::ranges::any_of(points,
                               [&](PointIndex i) { return !IsInside(photo, face.PixelOf(i)); });
  };
  const std::string names =
      JoinedNames({{cut(point::kEyeOutline[fsm::Side::kRight]), "the right eye"},
                   {cut(point::kEyeOutline[fsm::Side::kLeft]), "the left eye"},
                   {cut(std::array{point::kNoseTip, point::kNoseBottom}), "the nose"},
                   {cut(point::kUpperOuterLip) || cut(point::kLowerOuterLip), "the mouth"}});
  if (names.empty()) {
    const auto why = CoincidingCorners([&](PointIndex i) { return face.PixelOf(i); });
    if (why) return vm::Fail(vm::Errc::kBadValue, *why);
    return {};
  }
  return vm::Fail(vm::Errc::kBadValue,
                  "the photo cuts off " + names +
                      "; a face needs both eyes, the nose and the mouth, and better all of the "
                      "head");
}

}  // namespace facefit
