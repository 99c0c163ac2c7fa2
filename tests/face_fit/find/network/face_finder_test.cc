#include "face_fit/find/network/face_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <string>
#include <utility>

#include "face_fit/image/photo.h"
#include "tests/face_fit/group_photo.h"
#include "tests/face_fit/network_fixture.h"
#include "tests/support/test_data.h"

namespace facefit {
namespace {

using FaceFinderTest = NetworkTest;

TEST_F(FaceFinderTest, EyesChinAndCornersLieWhereTheyDoInThePhoto) {
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
  const std::pair<std::size_t, glm::vec2> places[] = {
      {33, {82, 101}}, {263, {145, 104}}, {61, {89, 139}}, {291, {134, 142}}, {152, {108, 177}}};
  for (const auto& [point, at] : places) {
    EXPECT_LT(glm::distance(glm::vec2(face.points[point]), at), 3.0F) << point;
  }
}

TEST_F(FaceFinderTest, AnEvenImageHasNoFaceAndNoFigure) {
  const fsm::Image grey{
      .width = 200, .height = 150, .rgba = std::vector<std::uint8_t>(200 * 150 * 4, 128)};
  EXPECT_TRUE(FindFaces(*networks_, grey).empty());
}

TEST_F(FaceFinderTest, InAGroupEveryFaceIsFound) {
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

TEST_F(FaceFinderTest, PeopleBesideTheLargestAreFoundThoughSmallerAndTurned) {
  const std::vector<Person> people = {{"galatea", 0, 0, 560, 300, 520},
                                      {"pygmalion", 25, 0, 80, 380, 300},
                                      {"baucis", -25, 10, 1180, 320, 280},
                                      {"galatea", -15, -10, 340, 60, 240},
                                      {"pygmalion", 10, 20, 1000, 60, 240}};
  const auto faces = FindFaces(*networks_, GroupPhoto(1600, 1000, people));
  EXPECT_EQ(faces.size(), people.size());
  for (const Person& person : people) {
    const auto side = static_cast<float>(person.side);
    EXPECT_EQ(std::ranges::count_if(
                  faces,
                  [&](const FoundFace& face) {
                    const glm::vec2 at = face.crop.centre - glm::vec2(person.x, person.y);
                    return std::min(at.x, at.y) > 0.2F * side && std::max(at.x, at.y) < 0.8F * side;
                  }),
              1)
        << person.face << " at " << person.x << ", " << person.y;
  }
}

}  // namespace
}  // namespace facefit
