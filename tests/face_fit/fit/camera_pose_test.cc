#include "face_fit/fit/camera_pose.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "face_fit/find/head/portrait_view.h"

namespace facefit {
namespace {

TEST(CameraPoseTest, TheCameraIsThatOfTheRenderer) {
  // So far away and before that plane a portrait of 330 mm fills the picture.
  constexpr int kSide = 600;
  const PortraitView portrait(kSide);
  CameraPose pose;
  pose.centre = portrait.Pixel({0, 0, kFaceZ});
  const float up = portrait.Pixel({0, 0, kFaceZ}).y - portrait.Pixel({0, 10, kFaceZ}).y;
  pose.focal = up / 10 * (kCameraZ - kFaceZ);
  EXPECT_NEAR(kSide / pose.PixelsPerMm(), 330, 1);
  // The renderer's axis runs a little below the head's middle.
  for (const glm::vec3 place : {glm::vec3(60, 0, kFaceZ), {-60, 0, kFaceZ}, {0, 80, kFaceZ}}) {
    EXPECT_LT(glm::distance(pose.Pixel(place), portrait.Pixel(place)), 0.1F) << place.x;
  }
  const auto width = [&](float z) {
    return portrait.Pixel({60, 0, z}).x - portrait.Pixel({0, 0, z}).x;
  };
  EXPECT_NEAR(width(kFaceZ) / width(-kFaceZ), (kCameraZ + kFaceZ) / (kCameraZ - kFaceZ), 1e-3F);
}

TEST(CameraPoseTest, PlacesComeBackFromTheirPixels) {
  const CameraPose pose{.turn_rad = {0.1F, -0.4F, 0.2F}, .focal = 900, .centre = {320, 240}};
  const glm::vec3 place(30, -20, 40);
  EXPECT_LT(glm::distance(pose.PlaceAt(pose.Pixel(place), pose.ToCamera(place).z), place), 1e-3F);
}

TEST(CameraPoseTest, AnglesAreThoseOfTheTurn) {
  const CameraPose pose{.turn_rad = glm::radians(glm::vec3(10, -20, 5))};
  EXPECT_GT(pose.TowardsCamera().x, 0.3F) << "turned to its right it shows its left side";
  const CameraPose nod{.turn_rad = glm::radians(glm::vec3(10, 0, 0))};
  EXPECT_NEAR(AnglesOf(nod.Rotation())[0], 10, 1e-3F);
  const CameraPose turn{.turn_rad = glm::radians(glm::vec3(0, -20, 0))};
  EXPECT_NEAR(AnglesOf(turn.Rotation())[1], -20, 1e-3F);
}

}  // namespace
}  // namespace facefit
