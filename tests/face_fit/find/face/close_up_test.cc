// What of a photo is worked on.

#include "face_fit/find/face/close_up.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "face_fit/image/photo.h"
#include "face_fit/image/resample.h"

namespace facefit {
namespace {

/// Every pixel says where it is: red grows to the right, green downwards.
fsm::Image Map(int width, int height) {
  fsm::Image map{.width = width, .height = height, .rgba = {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      map.rgba.push_back(static_cast<std::uint8_t>(255 * x / width));
      map.rgba.push_back(static_cast<std::uint8_t>(255 * y / height));
      map.rgba.push_back(0);
      map.rgba.push_back(255);
    }
  }
  return map;
}

/// A face whose eyes are so many pixels apart at their outer corners.
FoundFace FaceAt(glm::vec2 nose, float eyes) {
  FoundFace face;
  face.points.fill(glm::vec3(nose, 0));
  face.points[33].x -= eyes / 2;
  face.points[263].x += eyes / 2;
  face.points[4].z = 10;
  face.crop = {nose, 2 * eyes, 0};
  return face;
}

TEST(CloseUpTest, OfASmallFaceWhatIsNearItIsCutFromTheFinestPhoto) {
  // Two pixels of the finest photo to one of that the face was found in, half a millimetre each.
  const fsm::Image photo = Map(1600, 1000), finest = Map(3200, 2000);
  const FoundFace face = FaceAt({500, 400}, 45);
  const auto [near, there, scale] = CloseUpOf(photo, finest, face);
  EXPECT_NEAR(near.width, 660, 2);
  EXPECT_NEAR(near.height, 730, 2);
  EXPECT_NEAR(there.points[263].x - there.points[33].x, 90, 0.01F);
  EXPECT_NEAR(there.points[4].z, 20, 0.01F);
  EXPECT_NEAR(there.crop.size, 180, 0.01F);
  for (const std::size_t point : {1U, 33U, 263U}) {
    EXPECT_LT(
        glm::distance(ColourAt(near, there.points[point]), ColourAt(photo, face.points[point])),
        1.5F)
        << point;
  }
}

TEST(CloseUpTest, AtTheEdgeOfAPhotoLessIsCut) {
  const fsm::Image photo = Map(1600, 1000);
  const auto [near, there, scale] = CloseUpOf(photo, photo, FaceAt({100, 950}, 45));
  EXPECT_NEAR(near.width, 100 + 165, 2);
  EXPECT_NEAR(near.height, 50 + 150, 2);
  EXPECT_LT(glm::distance(glm::vec2(there.points[1]), glm::vec2(100, 150)), 1.5F);
}

TEST(CloseUpTest, AFaceAtTheEdgeIsCutWhateverTheScalesRoundTo) {
  // 1600 times 1920 / 1600, and other such products, come out a little above the width.
  for (const int wide : {1920, 1937, 2048, 2500, 3001}) {
    for (const int high : {1350, 1398, 1537, 1999}) {
      const fsm::Image finest = Map(wide, high), photo = Map(1600, 1600 * high / wide);
      const auto [near, there, scale] =
          CloseUpOf(photo, finest, FaceAt({1560, static_cast<float>(photo.height) - 40}, 45));
      EXPECT_GT(near.width, 100) << wide << " " << high;
      EXPECT_LT(near.width, wide) << wide << " " << high;
    }
  }
}

TEST(CloseUpTest, APortraitStaysAsItIs) {
  const fsm::Image photo = Map(300, 400);
  const FoundFace face = FaceAt({150, 180}, 60);
  const auto [near, there, scale] = CloseUpOf(photo, photo, face);
  EXPECT_EQ(near.rgba, photo.rgba);
  EXPECT_EQ(there.points, face.points);
}

TEST(CloseUpTest, NoMoreIsCutThanIsWorkedOn) {
  const fsm::Image photo = Map(1600, 1600), finest = Map(4000, 4000);
  const auto [near, there, scale] = CloseUpOf(photo, finest, FaceAt({800, 700}, 160));
  EXPECT_LE(std::max(near.width, near.height), kWorkingSize);
  EXPECT_LT(glm::distance(ColourAt(near, there.points[33]), ColourAt(photo, {720, 700})), 1.5F);
}

}  // namespace
}  // namespace facefit
