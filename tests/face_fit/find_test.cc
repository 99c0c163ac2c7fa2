#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <optional>
#include <string>

#include "face_fit/find/face_finder.h"
#include "face_fit/find/upright.h"
#include "face_fit/fit/fit.h"

namespace facefit {
namespace {

/// The photos are not part of the repository (tests/face_fit/README.md).
std::string Photos() {
  const char* named = std::getenv("GALATEA_PHOTOS");
  return named ? named : std::string(GALATEA_SOURCE_DIR) + "/../shared/data/photos";
}

class FindTest : public testing::Test {
 protected:
  void SetUp() override {
    auto loaded = FaceNetworks::Load("");
    if (!loaded) GTEST_SKIP() << loaded.error().text;
    networks_.emplace(std::move(*loaded));
  }
  std::optional<FaceNetworks> networks_;
};

TEST_F(FindTest, EyesChinAndCornersLieWhereTheyDoInThePhoto) {
  const std::string path = Photos() + "/collins_nasa.png";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no photos in " << Photos();
  const auto photo = ReadPhoto(path);
  ASSERT_TRUE(photo) << photo.error().text;
  const auto faces = FindFaces(*networks_, *photo);
  ASSERT_EQ(faces.size(), 1U);
  const FoundFace face = FindPoints(*networks_, *photo, faces[0]);
  EXPECT_GT(face.certainty, 0.95F);
  // Read off the photo by eye, to the pixel or two that can be told: 240 x 290.
  const std::pair<std::size_t, glm::vec2> seen[] = {
      {33, {82, 101}}, {263, {145, 104}}, {61, {89, 139}}, {291, {134, 142}}, {152, {108, 177}}};
  for (const auto& [point, at] : seen) {
    EXPECT_LT(glm::distance(glm::vec2(face.points[point]), at), 3.0F) << point;
  }
}

TEST_F(FindTest, AnEvenPictureHasNoFaceAndNoFigure) {
  const fsm::Image grey{
      .width = 200, .height = 150, .rgba = std::vector<std::uint8_t>(200 * 150 * 4, 128)};
  EXPECT_TRUE(FindFaces(*networks_, grey).empty());
}

TEST_F(FindTest, APhotoThatLiesIsSetUpright) {
  const std::string path = Photos() + "/collins_nasa.png";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no photos in " << Photos();
  const auto photo = ReadPhoto(path);
  ASSERT_TRUE(photo) << photo.error().text;
  EXPECT_EQ(UprightWay(*networks_, *photo), 1);
  EXPECT_EQ(UprightWay(*networks_, Turned(*photo, 6)), 8);
  EXPECT_EQ(UprightWay(*networks_, Turned(*photo, 8)), 6);
  EXPECT_EQ(UprightWay(*networks_, Turned(*photo, 3)), 3);
}

TEST_F(FindTest, InAGroupEveryFaceIsFound) {
  const std::string path = Photos() + "/collins_nasa.png";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no photos in " << Photos();
  const auto one = ReadPhoto(path);
  ASSERT_TRUE(one) << one.error().text;
  constexpr int kAcross = 5, kDown = 2;
  fsm::Image group{.width = one->width * kAcross, .height = one->height * kDown, .rgba = {}};
  for (int y = 0; y < group.height; ++y) {
    for (int x = 0; x < group.width; ++x) {
      const auto from =
          static_cast<std::size_t>(4 * ((y % one->height) * one->width + x % one->width));
      group.rgba.insert(group.rgba.end(), &one->rgba[from], &one->rgba[from] + 4);
    }
  }
  EXPECT_EQ(FindFaces(*networks_, group).size(), 10U);
}

TEST_F(FindTest, TheBuiltInHeadFittedToItselfHardlyMoves) {
  const BaseHead base = BaseHead::See(*networks_, "galatea");
  // What the network saw of the head, as if it were a photo.
  FoundFace face;
  Pose pose;
  pose.focal = 1500;
  pose.centre = {400, 380};
  pose.turn = {0.05F, -0.1F, 0.07F};
  for (std::size_t i = 0; i < kNetworkPoints; ++i) {
    const glm::vec3 q = pose.ToCamera(base.places[i].On(base.rest.position));
    face.points.emplace_back(pose.Project(q), q.z * pose.PixelsPerMm());
  }
  BaseHead exact{base.name, fsm::Head::Make("galatea"), base.rest, base.places, {}};
  for (const MeshPlace& place : base.places) exact.seen_z.push_back(place.On(base.rest.position).z);
  const Fit fit = FitFace(exact, face);
  EXPECT_LT(glm::distance(fit.pose.turn, pose.turn), 0.01F);
  EXPECT_NEAR(fit.pose.focal, pose.focal, 10);
  for (const auto& point : fit.points) EXPECT_LT(glm::length(point.by), 1.0F);
}

}  // namespace
}  // namespace facefit
