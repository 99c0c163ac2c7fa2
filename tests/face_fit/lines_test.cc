// What is followed in a photo beside the network's points: the line between the lips, the iris.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "face_fit/dress/openings.h"
#include "face_fit/dress/skin_colours.h"
#include "face_fit/find/iris.h"
#include "face_fit/find/mouth_line.h"
#include "face_fit/fit/base_head.h"

namespace facefit {
namespace {

/// Draws on grey what `brightness` says of each pixel's centre.
template <typename F>
fsm::Image Drawn(int side, F brightness) {
  fsm::Image image{.width = side, .height = side, .rgba = {}};
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const auto v = static_cast<std::uint8_t>(
          brightness(glm::vec2(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F)));
      image.rgba.insert(image.rgba.end(), {v, v, v, 255});
    }
  }
  return image;
}

/// A mouth from x = 50 to 150 whose lips meet at y = 100, by its points.
FoundFace StraightMouth() {
  FoundFace face;
  face.points.assign(kNetworkPoints, glm::vec3(0));
  constexpr std::pair<std::size_t, std::size_t> kInner[] = {{191, 95},  {80, 88},   {81, 178},
                                                            {82, 87},   {13, 14},   {312, 317},
                                                            {311, 402}, {310, 318}, {415, 324}};
  float x = 60;
  for (const auto& [upper, lower] : kInner) {
    face.points[upper] = face.points[lower] = glm::vec3(x, 100, 0);
    x += 10;
  }
  face.points[61] = glm::vec3(50, 100, 0);
  face.points[291] = glm::vec3(150, 100, 0);
  return face;
}

TEST(MouthLineTest, FollowsTheDarkLineBesideTheNetworksPoints) {
  // A mouth whose corners hang, as the points do not say.
  const auto height = [](float x) { return 98 + 5 * std::abs(x - 100) / 50; };
  const fsm::Image photo = Drawn(200, [&](glm::vec2 p) {
    return 170 - 120 * std::exp(-std::pow((p.y - height(p.x)) / 1.5F, 2.0F));
  });
  const auto line = FindMouthLine(photo, StraightMouth(), 0, 1);
  ASSERT_EQ(line.size(), kMouthLinePlaces);
  EXPECT_NEAR(line.front().x, 50, 1);
  EXPECT_NEAR(line.back().x, 150, 1);
  for (const glm::vec2 p : line) EXPECT_NEAR(p.y, height(p.x), 1.2F) << p.x;
}

TEST(MouthLineTest, KeepsToThePointsWhereNothingIsDark) {
  const auto line = FindMouthLine(Drawn(200, [](glm::vec2) { return 150; }), StraightMouth(), 0, 1);
  for (const glm::vec2 p : line) EXPECT_NEAR(p.y, 100, 0.7F) << p.x;
}

TEST(MouthLineTest, TeethTellOpenLipsFromClosedOnes) {
  FoundFace face = StraightMouth();
  EXPECT_FALSE(LipsApart(face));
  face.points[14].y += 12;
  EXPECT_TRUE(LipsApart(face));
}

TEST(OpeningsTest, TeethBetweenOpenLipsAreNoSkinAndTheLipsBesideThemOnlyInPart) {
  FoundFace face = StraightMouth();
  for (const int i : LowerInnerLip()) face.points[static_cast<std::size_t>(i)].y += 12;
  const Openings open(face, 2, true);
  EXPECT_EQ(open.Skin({100, 106}), 0);
  EXPECT_EQ(open.Skin({100, 99}), 0) << "the blurred edge";
  const float part = open.Skin({100, 97.6F});
  EXPECT_GT(part, 0.1F);
  EXPECT_LT(part, 0.9F);
  EXPECT_EQ(open.Skin({100, 90}), 1);
  EXPECT_EQ(open.Skin({20, 20}), 1);
  EXPECT_EQ(Openings(face, 2, false).Skin({100, 106}), 1) << "closed lips are all skin";
}

TEST(SkinColoursTest, AFringeIsNoSkinAndABrightForeheadIs) {
  // From the top: a hat, dark hair, a forehead in the light, the face.
  const fsm::Image map = Drawn(400, [](glm::vec2 p) {
    return p.y < 50 ? 200 : p.y < 100 ? 60 : p.y < 200 ? 240 : 160;
  });
  const Field likeness = SkinLikeness(map, Field(400, 400, 1));
  const auto at = [&](int y) { return likeness.at[likeness.Index(200, y)]; };
  EXPECT_EQ(at(75), 0);
  EXPECT_EQ(at(150), 1);
  EXPECT_EQ(at(300), 1);
  EXPECT_EQ(SkinLikeness(map, Field(400, 400)).at[75 * 400], 1) << "no face was seen";
}

TEST(IrisTest, IsFoundBetweenLidsThatHideHalfOfIt) {
  constexpr glm::vec2 kCentre(98, 94);
  const fsm::Image photo = Drawn(200, [&](glm::vec2 p) {
    if (p.y < 88 || p.y > 104) return 120;  // lids
    return glm::distance(p, kCentre) < 13 ? 60 : 200;
  });
  const IrisRing ring = FindIris(photo, {60, 98}, {140, 98}, {100, 97}, 15);
  EXPECT_GT(ring.contrast, kClearRing);
  EXPECT_LT(glm::distance(ring.centre, kCentre), 3.5F);
  EXPECT_NEAR(ring.radius, 13, 1.6F);
}

TEST(IrisTest, IsNotImaginedInAnEvenPatch) {
  const fsm::Image photo = Drawn(200, [](glm::vec2) { return 90; });
  EXPECT_LT(FindIris(photo, {60, 98}, {140, 98}, {100, 97}, 15).contrast, kClearRing);
}

}  // namespace
}  // namespace facefit
