#include "face_fit/fit/pose_fit.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <vector>

namespace facefit {
namespace {

/// Places on a face, not in one plane.
const std::vector<glm::vec3> kFacePlaces = {{-45, 30, 40},  {45, 30, 40},  {0, 0, 85},
                                            {-25, -42, 65}, {25, -42, 65}, {0, -90, 60},
                                            {0, 75, 60},    {-65, -20, 0}, {65, -20, 0}};
constexpr CameraPose kTruth{
    .rotation_rad = {0.1F, -0.35F, 0.15F}, .focal_px = 1400, .centre_px = {310, 260}};

std::vector<PointMatch> Matches() {
  std::vector<PointMatch> matches;
  for (const glm::vec3& place : kFacePlaces) matches.push_back({place, kTruth.PixelOf(place)});
  return matches;
}

TEST(PoseFitTest, ThePoseThatShowsTheMatchesIsFound) {
  const auto matches = Matches();
  const CameraPose found = FitPose(matches, {.focal_px = 1000, .centre_px = {300, 300}});
  EXPECT_LT(glm::distance(found.rotation_rad, kTruth.rotation_rad), 1e-3F);
  EXPECT_NEAR(found.focal_px, kTruth.focal_px, 1);
  EXPECT_LT(MeanDistanceMm(found, matches), 1e-2F);
}

TEST(PoseFitTest, AMatchFarOffCountsLittle) {
  auto matches = Matches();
  matches.back().pixel.x += 100;  // some 50 mm
  const CameraPose found = FitPose(matches, {.focal_px = 1000, .centre_px = {300, 300}});
  EXPECT_LT(glm::distance(found.rotation_rad, kTruth.rotation_rad), 0.1F);
}

TEST(PoseFitTest, WithTheTurnGivenSizeAndPlaceAreFound) {
  std::vector<glm::vec2> pixels;
  for (const glm::vec3& place : kFacePlaces) pixels.push_back(kTruth.PixelOf(place));
  const CameraPose found = PoseWithRotation(kFacePlaces, pixels, kTruth.rotation_rad);
  EXPECT_NEAR(found.focal_px, kTruth.focal_px, 0.5F);
  EXPECT_LT(glm::distance(found.centre_px, kTruth.centre_px), 0.5F);
}

TEST(PoseFitTest, TheMeanDistanceCountsMatchesByTheirWeight) {
  const CameraPose pose{.focal_px =
                            kCameraDepthMm - kFaceDepthMm};  // a pixel is a millimetre on the face
  const glm::vec3 place(0, 0, kFaceDepthMm);
  const std::vector<PointMatch> matches = {{place, {0, 0}, 3}, {place, {0, 8}, 1}};
  EXPECT_FLOAT_EQ(MeanDistanceMm(pose, matches), 2);
}

}  // namespace
}  // namespace facefit
