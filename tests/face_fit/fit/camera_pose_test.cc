#include "face_fit/fit/camera_pose.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "face_fit/find/head/portrait_view.h"
#include "fsm/rig/pose.h"

namespace facefit {
namespace {

TEST(CameraPoseTest, TheCameraIsThatOfTheRenderer) {
  // So far away and before that plane a portrait of 330 mm fills the image.
  constexpr int kSide = 600;
  const PortraitView portrait(kSide);
  CameraPose pose;
  pose.centre_px = portrait.PixelOf({0, 0, kFaceDepthMm});
  const float up =
      portrait.PixelOf({0, 0, kFaceDepthMm}).y - portrait.PixelOf({0, 10, kFaceDepthMm}).y;
  pose.focal_px = up / 10 * (kCameraDepthMm - kFaceDepthMm);
  EXPECT_NEAR(kSide / pose.PixelsPerMm(), 330, 1);
  // The renderer's axis runs a little below the head's middle.
  for (const glm::vec3 place :
       {glm::vec3(60, 0, kFaceDepthMm), {-60, 0, kFaceDepthMm}, {0, 80, kFaceDepthMm}}) {
    EXPECT_LT(glm::distance(pose.PixelOf(place), portrait.PixelOf(place)), 0.1F) << place.x;
  }
  const auto width = [&](float z) {
    return portrait.PixelOf({60, 0, z}).x - portrait.PixelOf({0, 0, z}).x;
  };
  EXPECT_NEAR(width(kFaceDepthMm) / width(-kFaceDepthMm),
              (kCameraDepthMm + kFaceDepthMm) / (kCameraDepthMm - kFaceDepthMm), 1e-3F);
}

TEST(CameraPoseTest, PlacesComeBackFromTheirPixels) {
  const CameraPose pose{
      .rotation_rad = {0.1F, -0.4F, 0.2F}, .focal_px = 900, .centre_px = {320, 240}};
  const glm::vec3 place(30, -20, 40);
  EXPECT_LT(glm::distance(pose.PositionOf(pose.PixelOf(place), pose.ToCamera(place).z), place),
            1e-3F);
}

TEST(CameraPoseTest, PositiveAnglesBendDownTurnToThePersonsLeftAndTiltToItsRight) {
  const auto rotated = [](glm::vec3 degrees, glm::vec3 direction) {
    return CameraPose{.rotation_rad = glm::radians(degrees)}.Rotation() * direction;
  };
  const glm::vec3 forward(0, 0, 1), left(1, 0, 0);
  EXPECT_NEAR(rotated({30, 0, 0}, forward).y, -0.5F, 1e-5F);
  EXPECT_NEAR(rotated({0, 30, 0}, forward).x, 0.5F, 1e-5F);
  EXPECT_NEAR(rotated({0, 0, 30}, left).y, 0.5F, 1e-5F);
  // About y first: a face turned by a right angle and bent looks past the camera still.
  EXPECT_NEAR(rotated({30, 90, 0}, forward).x, 1, 1e-5F);
  EXPECT_NEAR(rotated({30, 90, 0}, left).y, 0.5F, 1e-5F);
  const CameraPose pose{.rotation_rad = glm::radians(glm::vec3(10, -20, 5))};
  EXPECT_GT(pose.TowardsCamera().x, 0.3F) << "turned to its right it shows its left side";
}

}  // namespace
}  // namespace facefit
