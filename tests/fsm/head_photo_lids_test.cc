// Lids of a face that wears a photo of open eyes.

#include <gtest/gtest.h>

#include <cmath>

#include "fsm/head/photo_lids.h"

namespace fsm {
namespace {

constexpr glm::vec3 kLidSkin(0.8f, 0.6f, 0.5f);

/// The agent's left eye, 30 mm wide: 20 rows of an upper lid from its socket (0) to its rim (1) in
/// the upper half of a picture, as many of a lower lid in the other half.
struct Eye {
  std::vector<BakeWeights> skin;
  std::vector<glm::vec2> places;
  std::vector<glm::vec3> open, shut;
  std::vector<glm::vec3> open_normal, shut_normal;  // all to the front
  bool glasses = false;
  Image photo{60, 40, std::vector<std::uint8_t>(4 * 60 * 40, 255)};

  Eye() {
    for (int row = 0; row < 40; ++row) {
      for (int column = 0; column < 30; ++column) {
        BakeWeights weights;
        weights.eye = Side::kLeft;
        const float way = 15 * static_cast<float>(row < 20 ? row : 39 - row) / 19;
        open.emplace_back(15.0f + static_cast<float>(column), row < 20 ? 20 - way : way - 20, 70);
        shut.push_back(open.back());
        if (row < 20) shut.back().y -= 10 * way / 15;
        const float held = static_cast<float>(row < 20 ? row : 39 - row) / 19;
        (row < 20 ? weights.lid_upper : weights.lid_lower) = held;
        skin.push_back(weights);
        places.emplace_back((static_cast<float>(column) + 0.5f) / 30,
                            (static_cast<float>(row) + 0.5f) / 40);
      }
    }
    open_normal.assign(open.size(), glm::vec3(0, 0, 1));
    shut_normal = open_normal;
    for (int row = 0; row < 40; ++row) Paint(row, 0, 60, kLidSkin);
  }
  void Paint(int row, int from, int to, glm::vec3 colour) {
    for (int x = from; x < to; ++x) {
      for (int c = 0; c < 3; ++c) {
        photo.rgba[static_cast<std::size_t>(4 * (row * 60 + x) + c)] =
            static_cast<std::uint8_t>(255 * colour[c]);
      }
    }
  }
  std::vector<ShutLid> Lids() const {
    const PhotoSkin all{skin, {}, {open, open_normal}, {shut, shut_normal}};
    const std::vector<float> weight(places.size(), 1);
    const PhotoMapping mapping{photo, places, weight};
    return PaintLids(mapping, all, glasses, *Features::BuiltIn(), FitFaceLight(mapping, all.open));
  }
};

void ExpectSkinInTheMiddle(const Eye& eye, float tolerance) {
  int checked = 0;
  for (const ShutLid& lid : eye.Lids()) {
    const float held = eye.skin[lid.vertex].lid_upper;
    if (held < 0.75f || held > 0.92f) continue;
    if (std::abs(eye.open[lid.vertex].x - 30) > 7) continue;  // darker to the corners
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(std::sqrt(lid.colour[c]) / kLidSkin[c], 1, tolerance) << held;
    EXPECT_GT(lid.weight, 0.7f) << "most of it is no photo";
    ++checked;
  }
  EXPECT_GE(checked, 28);
}

/// Where the lid takes part in the turn as `held` says.
float GreenInTheMiddle(const Eye& eye, float held) {
  float green = 0;
  for (const ShutLid& lid : eye.Lids()) {
    const bool middle = std::abs(eye.open[lid.vertex].x - 30) <= 3;
    if (middle && std::abs(eye.skin[lid.vertex].lid_upper - held) < 0.03f)
      green = std::sqrt(lid.colour.g);
  }
  return green;
}

/// How much is lid between two heights in the middle of the shut eye.
float MeanPart(const Eye& eye, float from, float to) {
  float part = 0;
  int count = 0;
  for (const ShutLid& lid : eye.Lids()) {
    const glm::vec3 at = eye.shut[lid.vertex];
    if (eye.skin[lid.vertex].lid_upper <= 0 || std::abs(at.x - 30) > 8) continue;
    if (at.y < from || at.y > to) continue;
    part += lid.weight;
    ++count;
  }
  return part / static_cast<float>(std::max(count, 1));
}

TEST(PhotoLidsTest, DarkLashesDoNotColourTheLid) {
  Eye eye;
  for (int row = 6; row < 20; ++row) eye.Paint(row, 0, 60, glm::vec3(0.05f));
  ExpectSkinInTheMiddle(eye, 0.18f);  // a ridge of light lies there
}

TEST(PhotoLidsTest, TheRimOfGlassesAndItsReflectionAreLeftOut) {
  Eye eye;
  for (int row = 0; row < 3; ++row) {
    eye.Paint(row, 0, 24, glm::vec3(0.04f));
    eye.Paint(row, 24, 30, glm::vec3(1));
  }
  ExpectSkinInTheMiddle(eye, 0.2f);
}

TEST(PhotoLidsTest, EachEndOfTheLidIsAsBrightAsTheSkinBesideIt) {
  Eye eye;
  for (int row = 0; row < 40; ++row) eye.Paint(row, 30, 60, 0.6f * kLidSkin);
  float inner = 0, outer = 0;
  for (const ShutLid& lid : eye.Lids()) {
    const BakeWeights& weights = eye.skin[lid.vertex];
    if (std::abs(weights.lid_upper - 0.8f) > 0.05f) continue;
    if (eye.open[lid.vertex].x < 18) inner = std::sqrt(lid.colour.g);
    if (eye.open[lid.vertex].x > 41) outer = std::sqrt(lid.colour.g);
  }
  EXPECT_NEAR(outer / inner, 0.6f, 0.1f);
}

TEST(PhotoLidsTest, LidsGoOverIntoTheSocketAndEndInDarkLashes) {
  const Eye eye;
  int rims = 0;
  for (const ShutLid& lid : eye.Lids()) {
    const BakeWeights& weights = eye.skin[lid.vertex];
    if (std::max(weights.lid_upper, weights.lid_lower) < 0.12f) {
      EXPECT_LT(lid.weight, 0.1f) << "the socket keeps the photo";
    }
    if (weights.lid_upper == 0 && weights.lid_lower < 0.85f) {
      EXPECT_EQ(lid.weight, 0) << "the lower lid keeps it up to its rim";
    }
    if (weights.lid_upper == 1 || weights.lid_lower == 1) {
      EXPECT_LT(std::sqrt(lid.colour.g), 0.7f * kLidSkin.g);
      EXPECT_GT(lid.weight, 0.25f);
      ++rims;
    }
  }
  EXPECT_EQ(rims, 60);
}

TEST(PhotoLidsTest, TheLidHasTheColoursOfTheSkinRoundTheEyeWhereverTheyChange) {
  Eye eye;
  for (int row = 20; row < 40; ++row) eye.Paint(row, 0, 60, 0.7f * kLidSkin);
  const float above = GreenInTheMiddle(eye, 0.55f), below = GreenInTheMiddle(eye, 0.9f);
  EXPECT_GT(above, 0.75f * kLidSkin.g) << "the upper skin's where that begins, in a furrow";
  EXPECT_LT(below, 0.92f * kLidSkin.g) << "and the lower's below";
  EXPECT_GT(below, 0.6f * kLidSkin.g);
}

TEST(PhotoLidsTest, InADarkSocketTheLidBeginsDarkAndGrowsLightDownward) {
  Eye eye;
  for (int row = 0; row < 20; ++row) eye.Paint(row, 0, 60, 0.4f * kLidSkin);
  const float above = GreenInTheMiddle(eye, 0.55f), below = GreenInTheMiddle(eye, 0.9f);
  EXPECT_LT(above, 0.55f * kLidSkin.g);
  EXPECT_GT(below, 1.4f * above);
}

TEST(PhotoLidsTest, WhatIsAboveTheEyeStaysInItsPlaceWhileALidComesDown) {
  const Eye eye;
  int stays = 0;
  for (const ShutLid& lid : eye.Lids()) {
    const auto i = lid.vertex;
    // 35 millimetres of the face, 30 of which are seen in the picture's height less the gap.
    const float way = eye.open[i].y - eye.shut[i].y;
    const glm::vec2 slid = glm::vec2(eye.places[i]) + lid.slide;
    EXPECT_NEAR(lid.slide.x, 0, 1e-3f);
    EXPECT_GE(lid.slide.y, 0) << "down in the photo";
    if (way > 1) {
      EXPECT_GT(lid.slide.y, 0.5f * way / 40);
    }
    if (eye.shut[i].y > 9) {
      EXPECT_LT(lid.weight, 0.1f) << "the photo is seen there";
      EXPECT_LT(slid.y, 0.5f);
      ++stays;
    }
  }
  EXPECT_GT(stays, 100);
}

/// Lit from above: what faces up is bright, what faces down is dark.
Eye LitFromAbove() {
  Eye eye;
  for (std::size_t i = 0; i < eye.skin.size(); ++i) {
    const int row = static_cast<int>(i) / 30;
    const float up = 0.6f - 1.2f * static_cast<float>(row) / 39;
    eye.open_normal[i] = {0, up, std::sqrt(1 - up * up)};
    eye.Paint(row, 0, 60, kLidSkin * std::sqrt(0.5f + 0.6f * up));
  }
  return eye;
}

TEST(PhotoLidsTest, AShutLidIsLitAsItFaces) {
  Eye eye = LitFromAbove();
  eye.shut_normal.assign(eye.shut.size(), glm::vec3(0, 0.6f, 0.8f));
  const float up = GreenInTheMiddle(eye, 0.9f);
  eye.shut_normal.assign(eye.shut.size(), glm::vec3(0, 0, 1));
  const float front = GreenInTheMiddle(eye, 0.9f);
  eye.shut_normal.assign(eye.shut.size(), glm::vec3(0, -0.6f, 0.8f));
  const float down = GreenInTheMiddle(eye, 0.9f);
  EXPECT_GT(up, 1.1f * front);
  EXPECT_LT(down, 0.85f * front);
}

TEST(PhotoLidsTest, TheLashesOfTheOpenEyeAreGoneWhenItIsShutButARimOfGlassesStays) {
  Eye eye;
  // From 3 to 6 millimetres above the open eye's rim; the skin above it is bright.
  for (int row = 12; row < 16; ++row) eye.Paint(row, 0, 60, 0.3f * kLidSkin);
  EXPECT_GT(MeanPart(eye, 9.3f, 10.3f), 0.5f);
  eye.glasses = true;
  EXPECT_LT(MeanPart(eye, 9.3f, 10.3f), 0.1f);
}

TEST(PhotoLidsTest, WhatALensMirrorsStaysBeforeTheLid) {
  Eye eye;
  for (int row = 0; row < 40; ++row) eye.Paint(row, 0, 60, 0.5f * kLidSkin);
  eye.glasses = true;
  EXPECT_GT(MeanPart(eye, 6.4f, 7.6f), 0.8f);
  // From 1 to 5 millimetres above the open eye's rim.
  for (int row = 12; row < 19; ++row) eye.Paint(row, 0, 60, glm::vec3(1));
  EXPECT_LT(MeanPart(eye, 6.4f, 7.6f), 0.3f);
}

TEST(PhotoLidsTest, TheGrainComesFromBelowTheEye) {
  const Eye eye;
  for (const ShutLid& lid : eye.Lids()) {
    if (lid.weight > 0.5f) {
      EXPECT_GT(lid.grain_at.y, 0.5f);
    }
  }
}

TEST(PhotoLidsTest, TheGrainComesFromASkinThatIsNearTheEye) {
  const Eye eye;
  int checked = 0;
  for (const ShutLid& lid : eye.Lids()) {
    if (lid.weight < 0.5f || eye.skin[lid.vertex].lid_upper == 0) continue;
    // The lower rim is at half the picture's height, 15 millimetres below it is the end.
    EXPECT_LT(lid.grain_at.y, 0.5f + 0.5f * 15.6f / 15) << eye.skin[lid.vertex].lid_upper;
    ++checked;
  }
  EXPECT_GT(checked, 100);
}

TEST(PhotoLidsTest, AGreyShineAboveTheEyeDoesNotMakeTheLidGrey) {
  Eye eye;
  for (int row = 0; row < 20; ++row) eye.Paint(row, 0, 60, glm::vec3(0.63f));  // grey of a shine
  int checked = 0;
  for (const ShutLid& lid : eye.Lids()) {
    const float held = eye.skin[lid.vertex].lid_upper;
    if (held < 0.5f || held > 0.9f) continue;
    EXPECT_LT(std::sqrt(lid.colour.b) / std::sqrt(lid.colour.r),
              0.5f * (1 + kLidSkin.b / kLidSkin.r))
        << held;
    ++checked;
  }
  EXPECT_GT(checked, 100);
}

TEST(PhotoLidsTest, AHeadWithoutLidsHasNone) {
  Eye eye;
  eye.skin.assign(eye.skin.size(), BakeWeights{});
  EXPECT_TRUE(eye.Lids().empty());
}

}  // namespace
}  // namespace fsm
