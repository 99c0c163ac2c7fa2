#include "face_fit/find/face/photo_seam.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/face_fit/grey_image.h"
#include "tests/face_fit/straight_mouth.h"

namespace facefit {
namespace {

TEST(PhotoSeamTest, FollowsTheDarkLineBesideTheNetworksPoints) {
  // A mouth whose corners hang, as the points do not say.
  const auto height = [](float x) { return 98 + 5 * std::abs(x - 100) / 50; };
  const fsm::Image photo = GreyImage(200, [&](glm::vec2 p) {
    return 170 - 120 * std::exp(-std::pow((p.y - height(p.x)) / 1.5F, 2.0F));
  });
  const auto line = FindPhotoSeam(photo, StraightMouth(), {0, 1});
  ASSERT_EQ(line.size(), kSeamPoints);
  EXPECT_NEAR(line.front().x, 50, 1);
  EXPECT_NEAR(line.back().x, 150, 1);
  for (const glm::vec2 p : line) EXPECT_NEAR(p.y, height(p.x), 1.2F) << p.x;
}

TEST(PhotoSeamTest, KeepsToThePointsWhereNothingIsDark) {
  const auto line =
      FindPhotoSeam(GreyImage(200, [](glm::vec2) { return 150; }), StraightMouth(), {0, 1});
  for (const glm::vec2 p : line) EXPECT_NEAR(p.y, 100, 0.7F) << p.x;
}

TEST(PhotoSeamTest, TeethTellOpenLipsFromClosedOnes) {
  FoundFace face = StraightMouth();
  EXPECT_FALSE(LipsApart(face));
  face.points[14].y += 12;
  EXPECT_TRUE(LipsApart(face));
}

}  // namespace
}  // namespace facefit
