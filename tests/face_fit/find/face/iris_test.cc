#include "face_fit/find/face/iris.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <utility>

#include "tests/face_fit/grey_image.h"

namespace facefit {
namespace {

/// An open eye from x = 60 to 140 about y = 96, its lids 16 pixels apart; the outer corner at the
/// left, or at the right.
ExpectedEye EyeAcross(bool mirrored) {
  ExpectedEye eye{.lids = {}, .iris_centre_px = {100, 97}, .iris_radius_px = 15};
  for (std::size_t k = 0; k < eye.lids.size(); ++k) {
    const float part = static_cast<float>(k <= 8 ? k : 16 - k) / 8;
    const float open = k % 8 == 0 ? 0.0F : k < 8 ? -8.0F : 8.0F;
    eye.lids[k] = {mirrored ? 140 - 80 * part : 60 + 80 * part, 96 + open};
  }
  return eye;
}

TEST(IrisTest, IsFoundBetweenLidsThatHideHalfOfIt) {
  constexpr glm::vec2 kCentre(98, 94);
  const fsm::Image photo = GreyImage(200, [&](glm::vec2 p) {
    if (p.y < 88 || p.y > 104) return 120;  // lids
    return glm::distance(p, kCentre) < 13 ? 60 : 200;
  });
  for (const bool mirrored : {false, true}) {
    const ExpectedEye eye = EyeAcross(mirrored);
    const IrisCircle ring = FindIrises(photo, {eye, eye}).right;
    EXPECT_GT(ring.contrast, kClearIris);
    EXPECT_LT(glm::distance(ring.centre_px, kCentre), 3.5F);
    EXPECT_NEAR(ring.radius_px, 13, 1.6F);
  }
}

TEST(IrisTest, IsFoundBesideACornerInDeepShade) {
  constexpr glm::vec2 kCentre(106, 97);
  const fsm::Image photo = GreyImage(200, [&](glm::vec2 p) {
    if (p.y < 88 || p.y > 104) return 120;
    const float far = glm::distance(p, kCentre);
    // An iris that is hardly darker than the shade, round its pupil.
    return far < 5 ? 15 : far < 12 ? 70 : p.x < 88 ? 85 : 180;
  });
  const ExpectedEye eye = EyeAcross(false);
  const IrisCircle ring = FindIrises(photo, {eye, eye}).right;
  EXPECT_LT(glm::distance(ring.centre_px, kCentre), 3.5F) << ring.centre_px.x;
}

TEST(IrisTest, IsWhereItIsDarkWithinNotBetweenTheShadowsOfTwoLashes) {
  // Beside the iris two dark lines as far apart as one is wide, whose outer sides are the clearest
  // steps there are. It is pale with a dark pupil, or dark throughout.
  constexpr glm::vec2 kCentre(108, 97);
  for (const auto& [pupil, pale] : {std::pair(15, 110), {95, 95}}) {
    const fsm::Image photo = GreyImage(200, [&](glm::vec2 p) {
      if (p.y < 88 || p.y > 104) return 120;
      const float far = glm::distance(p, kCentre);
      if (far < 13) return far < 5 ? pupil : pale;
      return std::abs(std::abs(p.x - 82) - 11) < 1.6F ? 70 : 170;
    });
    const ExpectedEye eye = EyeAcross(false);
    const IrisCircle ring = FindIrises(photo, {eye, eye}).right;
    EXPECT_LT(glm::distance(ring.centre_px, kCentre), 4) << pupil << ": " << ring.centre_px.x;
  }
}

TEST(IrisTest, IsNotImaginedInAnEvenPatch) {
  const fsm::Image photo = GreyImage(200, [](glm::vec2) { return 90; });
  const ExpectedEye eye = EyeAcross(false);
  EXPECT_LT(FindIrises(photo, {eye, eye}).right.contrast, kClearIris);
}

}  // namespace
}  // namespace facefit
