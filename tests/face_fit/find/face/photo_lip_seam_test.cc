#include "face_fit/find/face/photo_lip_seam.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/face_fit/grey_image.h"
#include "tests/face_fit/straight_mouth.h"

namespace facefit {
namespace {

TEST(PhotoLipSeamTest, FollowsTheDarkLineBesideTheNetworksPoints) {
  // A mouth whose corners hang, as the points do not say.
  const auto height = [](float x) { return 98 + 5 * std::abs(x - 100) / 50; };
  const fsm::Image photo = GreyImage(200, [&](glm::vec2 p) {
    return 170 - 120 * std::exp(-std::pow((p.y - height(p.x)) / 1.5F, 2.0F));
  });
  const PhotoLipSeam seam = TraceLipSeam(photo, StraightMouth(), {0, 1});
  EXPECT_NEAR(seam.PixelAt(0).x, 50, 1);
  EXPECT_NEAR(seam.PixelAt(1).x, 150, 1);
  for (int i = 0; i <= 40; ++i) {
    const glm::vec2 p = seam.PixelAt(static_cast<float>(i) / 40);
    EXPECT_NEAR(p.y, height(p.x), 1.2F) << p.x;
  }
}

TEST(PhotoLipSeamTest, KeepsToThePointsWhereNothingIsDark) {
  const PhotoLipSeam seam =
      TraceLipSeam(GreyImage(200, [](glm::vec2) { return 150; }), StraightMouth(), {0, 1});
  for (int i = 0; i <= 40; ++i) {
    const glm::vec2 p = seam.PixelAt(static_cast<float>(i) / 40);
    EXPECT_NEAR(p.y, 100, 0.7F) << p.x;
  }
}

TEST(PhotoLipSeamTest, TeethTellOpenLipsFromClosedOnes) {
  FoundFace face = StraightMouth();
  EXPECT_FALSE(LipsApart(face));
  face.points[14].y += 12;
  EXPECT_TRUE(LipsApart(face));
}

}  // namespace
}  // namespace facefit
