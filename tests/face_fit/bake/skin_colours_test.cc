#include "face_fit/bake/skin_colours.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/face_fit/grey_image.h"

namespace facefit {
namespace {

TEST(SkinColoursTest, AFringeIsNoSkinAndABrightForeheadIs) {
  // From the top: a hat, dark hair, a forehead in the light, the face.
  const fsm::Image map = GreyImage(400, [](glm::vec2 p) {
    return p.y < 50 ? 200 : p.y < 100 ? 60 : p.y < 200 ? 240 : 160;
  });
  const FloatImage likeness = SkinLikeness(map, FloatImage(400, 400, 1));
  const auto at = [&](int y) { return likeness(200, y); };
  EXPECT_EQ(at(75), 0);
  EXPECT_EQ(at(150), 1);
  EXPECT_EQ(at(300), 1);
  EXPECT_EQ(SkinLikeness(map, FloatImage(400, 400)).values[75 * 400], 1) << "no face was seen";
}

TEST(SkinColoursTest, BrightStrandsOfAFringeAreNoSkinAndLinesOfTheForeheadAre) {
  // From the top: bright strands, dark ones, forehead with a dark line, brows, cheek.
  FloatImage likeness(400, 400, 1);
  SkinTexels texels(400, 400);
  for (int y = 0; y < 400; ++y) {
    for (int x = 0; x < 400; ++x) {
      const std::size_t i = likeness.Index(x, y);
      texels[i] = {.y_mm = static_cast<float>(250 - y) / 5};
      const bool dark = (y > 60 && y < 120) || y == 180 || (y > 255 && y < 270);
      if (dark) likeness.values[i] = 0;
    }
  }
  likeness = CutAtHairline(texels, 0, likeness);
  const auto at = [&](int y) { return likeness(200, y); };
  EXPECT_LT(at(30), 0.05F) << "bright strands";
  EXPECT_EQ(at(90), 0) << "dark ones";
  EXPECT_GT(at(150), 0.95F) << "the forehead above its line";
  EXPECT_GT(at(220), 0.95F);
  EXPECT_EQ(at(262), 0) << "the brows";
  EXPECT_EQ(at(330), 1);
}

TEST(SkinColoursTest, LinesMakeASkinRoughAndShadeDoesNot) {
  const auto rough = [](auto brightness, float coverage) {
    return Roughness(GreyImage(512, brightness), FloatImage(512, 512, coverage));
  };
  const auto lined = [](glm::vec2 p) { return 160 + 14 * std::sin(p.y * 0.8F); };
  EXPECT_LT(rough([](glm::vec2 p) { return 110 + 0.2F * p.x; }, 1), 0.006F);
  EXPECT_GT(rough(lined, 1), 0.03F);
  EXPECT_EQ(rough(lined, 0), 0) << "no face was seen";
}

}  // namespace
}  // namespace facefit
