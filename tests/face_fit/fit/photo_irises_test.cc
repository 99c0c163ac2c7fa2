#include "face_fit/fit/photo_irises.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "face_fit/image/plane.h"
#include "tests/face_fit/grey_image.h"
#include "tests/face_fit/network_fixture.h"

namespace facefit {
namespace {

/// The eyes of the built-in head in a photo of two pixels to a millimetre that leans.
class PhotoIrisesTest : public NetworkTest {
 protected:
  static constexpr float kScale = 2, kLeanRad = 0.3F;
  static glm::vec2 PixelOf(glm::vec3 p) {
    return glm::vec2(300, 200) + kScale * Rotated({p.x, -p.y}, kLeanRad);
  }
  static EyePoints Lids(fsm::Side side) {
    return EyePointsOf(side, [](PointIndex i) { return PixelOf(Galatea().AtRest(i)); });
  }
  static glm::vec2 Centre(fsm::Side side) { return PixelOf(Galatea().head().EyeCentre(side)); }
  /// The shift where the iris is seen so many millimetres below its place.
  static glm::vec2 ShiftFor(float below_mm, bool seen = true) {
    const fsm::Side side = fsm::Side::kLeft;
    const glm::vec2 down = Rotated({0, 1}, kLeanRad);
    const PhotoIris iris{{Centre(side) + kScale * below_mm * down, 10},
                         {Lids(side), Centre(side), 10, kScale},
                         seen};
    return Rotated(LidShiftPx(iris), -kLeanRad) / kScale;
  }
};

TEST_F(PhotoIrisesTest, AnIrisIsExpectedInTheMiddleOfTheBaseHeadsEye) {
  FoundFace face;
  for (PointIndex i = 0; i < kNetworkPoints; ++i) {
    face.points[i] = glm::vec3(PixelOf(Galatea().AtRest(i)), 0);
  }
  const PhotoIrises irises = FindPhotoIrises(Galatea(), face, EvenGreyImage(600));
  for (const fsm::Side side : fsm::kSides) {
    const ExpectedEye& eye = irises.eyes[side].expected;
    EXPECT_LT(glm::distance(eye.iris_centre_px, Centre(side)), 0.01F);
    EXPECT_NEAR(eye.pixels_per_mm, kScale, 0.001F);
  }
}

TEST_F(PhotoIrisesTest, LidsFollowAnIrisThatLiesFarFromTheirMiddleUpToALimit) {
  const auto near = [](glm::vec2 shift_mm, float down_mm) {
    // The line between the corners, which lids are shifted across, is not quite level.
    return std::abs(shift_mm.y - down_mm) < 0.05F && std::abs(shift_mm.x) < 0.3F;
  };
  EXPECT_TRUE(near(ShiftFor(2), 1.5F));
  EXPECT_TRUE(near(ShiftFor(-2), -1.5F));
  EXPECT_TRUE(near(ShiftFor(9), 2.5F));
  EXPECT_TRUE(near(ShiftFor(0.4F), 0));
  EXPECT_TRUE(near(ShiftFor(2, false), 0)) << "an iris that is not seen";
}

}  // namespace
}  // namespace facefit
