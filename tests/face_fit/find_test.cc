#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <string>

#include "face_fit/find/face/upright.h"
#include "face_fit/find/network/face_finder.h"
#include "face_fit/fit/fit.h"
#include "face_fit/picture/filters.h"
#include "face_fit/picture/photo.h"
#include "fsm/base/table_reader.h"
#include "fsm/head/make_head.h"
#include "tests/face_fit/network_fixture.h"
#include "tests/support/test_data.h"

namespace facefit {
namespace {

using FindTest = NetworkTest;

TEST_F(FindTest, EyesChinAndCornersLieWhereTheyDoInThePhoto) {
  const auto photos = support::Photos();
  if (!photos.Has("collins_nasa.png")) GTEST_SKIP() << photos.Missing();
  const std::string path = photos / "collins_nasa.png";
  const auto photo = ReadPhoto(path);
  ASSERT_TRUE(photo) << photo.error().text;
  const auto faces = FindFaces(*networks_, *photo);
  ASSERT_EQ(faces.size(), 1U);
  const FoundFace& face = faces[0];
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
  const auto photos = support::Photos();
  if (!photos.Has("collins_nasa.png")) GTEST_SKIP() << photos.Missing();
  const std::string path = photos / "collins_nasa.png";
  const auto photo = ReadPhoto(path);
  ASSERT_TRUE(photo) << photo.error().text;
  for (const auto& [lying, upright] : {std::pair(1, 1), {6, 8}, {8, 6}, {3, 3}}) {
    fsm::Image turned = Turned(*photo, lying);
    const UprightFaces found = FindUprightFaces(*networks_, turned);
    EXPECT_EQ(found.orientation, upright) << lying;
    EXPECT_EQ(turned.rgba, photo->rgba) << lying;
    ASSERT_EQ(found.faces.size(), 1U) << lying;
    EXPECT_LT(found.faces[0].At(point::kForehead).y, found.faces[0].At(point::kChin).y) << lying;
  }
}

TEST_F(FindTest, InAGroupEveryFaceIsFound) {
  const auto photos = support::Photos();
  if (!photos.Has("collins_nasa.png")) GTEST_SKIP() << photos.Missing();
  const std::string path = photos / "collins_nasa.png";
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

CameraPose SomePose() {
  CameraPose pose;
  pose.focal = 1500;
  pose.centre = {400, 380};
  pose.turn = {0.05F, -0.1F, 0.07F};
  return pose;
}

/// What the network saw of a head, as if it were a photo.
FoundFace SeenOf(const std::vector<MeshPoint>& places, const std::vector<glm::vec3>& vertices) {
  FoundFace face;
  const CameraPose pose = SomePose();
  for (const MeshPoint& place : places) {
    const glm::vec3 q = pose.ToCamera(place.On(vertices));
    face.points.emplace_back(pose.Project(q), q.z * pose.PixelsPerMm());
  }
  return face;
}

/// The head as a network would see it whose depth is true.
BaseHead Exact(const BaseHead& base) {
  BaseHead exact{base.name, fsm::MakeHead("galatea", false), {}, base.rest, base.points, {}};
  for (const MeshPoint& place : base.points) exact.seen.push_back(place.On(base.rest.position));
  return exact;
}

TEST_F(FindTest, TheBuiltInHeadFittedToItselfHardlyMoves) {
  const BaseHead& base = Galatea();
  const FoundFace face = SeenOf(base.points, base.rest.position);
  const BaseHead exact = Exact(base);
  const Fit fit = FitFace(exact, face);
  EXPECT_LT(glm::distance(fit.head.pose.turn, SomePose().turn), 0.01F);
  EXPECT_NEAR(fit.head.pose.focal, SomePose().focal, 10);
  for (const auto& point : fit.head.points) EXPECT_LT(glm::length(point.by), 1.0F);
}

TEST_F(FindTest, ASmileIsTakenBackByTheUnitsOfOnesOwnTable) {
  const BaseHead& base = Galatea();
  // Corners that rise steeply without going outward.
  const fsm::UnitTable own(fsm::Table("own.txt",
                                      "field 12 25 -42 22 25 both 0 11 0\n"
                                      "field 25 7 -38 20 11 above 0 1.4 0.2\n"
                                      "field 25 7 -45 24 16 below 0 -8 0\n"));
  BaseHead built_in = Exact(base), moved = Exact(base);
  moved.MoveBy(own);
  Expression smiling;
  smiling.smile = 0.9F;
  smiling.parted = 0.9F;
  fsm::HeadVertices vertices;
  moved.head->Evaluate(smiling.State(), vertices);
  const FoundFace face = SeenOf(base.points, vertices.position);
  const auto most = [](const Fit& fit) {
    float far = 0;
    for (const auto& point : fit.head.points) far = std::max(far, glm::length(point.by));
    return far;
  };
  const Fit fit = FitFace(moved, face);
  EXPECT_NEAR(fit.head.expression.smile, smiling.smile, 0.1F);
  EXPECT_LT(most(fit), 2);
  EXPECT_GT(most(FitFace(built_in, face)), 4) << "else this would say nothing";
  // The head as worn in the photo smiles by the same table.
  const std::size_t corner = 291;
  EXPECT_LT(glm::distance(fit.head.At(corner), base.points[corner].On(vertices.position)), 2);
}

}  // namespace
}  // namespace facefit
