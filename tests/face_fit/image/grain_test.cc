#include "face_fit/image/grain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "face_fit/image/filters.h"
#include "tests/face_fit/disc_image.h"

namespace facefit {
namespace {

TEST(GrainTest, WhatIsFilledInIsAsRoughAsWhatLiesBesideIt) {
  // Stripes, and a hole across the middle.
  const auto hole = [](glm::vec2 p) { return std::abs(p.y - kDiscSide / 2) < 12; };
  fsm::Image image =
      Painted([](glm::vec2 p) { return glm::vec3(std::fmod(p.x, 4.0F) < 2 ? 150 : 90); });
  const Mask known = FieldOf([&](glm::vec2 p) { return hole(p) ? 0.0F : 1.0F; });
  PushPullInpaint(image, known);
  const auto roughness = [&image] {
    float sum = 0;
    for (int x = 20; x < 140; ++x) {
      sum += std::abs(
          static_cast<float>(
              image.rgba[static_cast<std::size_t>(4 * (kDiscSide / 2 * kDiscSide + x))]) -
          static_cast<float>(
              image.rgba[static_cast<std::size_t>(4 * (kDiscSide / 2 * kDiscSide + x + 2))]));
    }
    return sum / 120;
  };
  EXPECT_LT(roughness(), 10);
  AddGrain(known, FieldOf([](glm::vec2) { return 1.0F; }), 4, image);
  EXPECT_GT(roughness(), 40);
}

/// Stripes up and down where something is known, an even grey in the gap that was filled.
class GrainGap {
 public:
  GrainGap(float half_gap, float share)
      : known(FieldOf([half_gap](glm::vec2 p) { return Off(p) < half_gap ? 0.0F : 1.0F; })),
        amount(FieldOf([share](glm::vec2) { return share; })),
        image(Painted([half_gap](glm::vec2 p) {
          return glm::vec3(Off(p) < half_gap ? 180 : std::fmod(p.x, 4.0F) < 2 ? 150 : 90);
        })) {}
  static float Off(glm::vec2 p) { return std::abs(p.y - kDiscSide / 2); }
  /// How far the stripes of a row stand out, and its mean.
  glm::vec2 Row(int y) const {
    glm::vec2 sum(0);
    for (int x = 40; x < 120; ++x) {
      const float v = image.rgba[static_cast<std::size_t>(4 * (y * kDiscSide + x))];
      sum += glm::vec2(x % 4 < 2 ? v : -v, v) / glm::vec2(40, 80);
    }
    return sum;
  }

  Mask known, amount;
  fsm::Image image;
};

TEST(GrainTest, GrainIsLentInFullAsFarAsItWasAskedForAndChangesNoColour) {
  GrainGap whole(12, 1), half(12, 0.5F), none(12, 0);
  for (GrainGap* gap : {&whole, &half, &none}) AddGrain(gap->known, gap->amount, 4, gap->image);
  constexpr int kRow = kDiscSide / 2 - 8;
  EXPECT_NEAR(whole.Row(kRow).x, 60, 8);
  EXPECT_NEAR(half.Row(kRow).x, 30, 4);
  EXPECT_EQ(none.Row(kRow).x, 0);
  EXPECT_NEAR(whole.Row(kRow).y, 180, 3);
}

TEST(GrainTest, AFigureTakesNoGrainFromAPhotoWhosePixelsAreAsCoarse) {
  GrainGap fine(12, 1), coarse(12, 1);
  AddGrainToFigure(fine.known, fine.amount, 1.7F, fine.image);
  AddGrainToFigure(coarse.known, coarse.amount, 0.6F, coarse.image);
  EXPECT_NEAR(fine.Row(kDiscSide / 2 - 8).x, 60, 8);
  EXPECT_EQ(coarse.Row(kDiscSide / 2 - 8).x, 0);
}

TEST(GrainTest, GrainIsNotCarriedFar) {
  GrainGap gap(38, 1);
  AddGrain(gap.known, gap.amount, 4, gap.image);
  EXPECT_GT(gap.Row(kDiscSide / 2 - 33).x, 40);
  EXPECT_EQ(gap.Row(kDiscSide / 2 - 2).x, 0) << "36 pixels from the edge, eight times 4 are 32";
}

TEST(GrainTest, GrainComesFromAsFarOnTheOtherSideOfTheEdge) {
  GrainGap gap(20, 1);
  // Only the six rows before the edge are striped.
  for (int y = 0; y < kDiscSide; ++y) {
    if (GrainGap::Off({0, static_cast<float>(y) + 0.5F}) < 26) continue;
    for (int i = 0; i < 4 * kDiscSide; ++i) {
      gap.image.rgba[static_cast<std::size_t>(4 * y * kDiscSide + i)] = 120;
    }
  }
  AddGrain(gap.known, gap.amount, 2, gap.image);
  EXPECT_GT(gap.Row(kDiscSide / 2 - 17).x, 40) << "three pixels within";
  EXPECT_LT(gap.Row(kDiscSide / 2 - 9).x, 6) << "eleven pixels within";
}

TEST(GrainTest, WhatIsHalfKnownTakesHalfTheGrainAndGivesHalf) {
  GrainGap gap(12, 1);
  for (int y = 0; y < kDiscSide; ++y) {
    const float off = GrainGap::Off({0, static_cast<float>(y) + 0.5F});
    for (int x = 0; x < kDiscSide; ++x) {
      float& share = gap.known(x, y);
      if (off > 9 && off < 12) share = 0.5F;
      // A thin line is all that is known before more that is not.
      if (off > 14 && y < kDiscSide / 2) share = 0;
    }
  }
  AddGrain(gap.known, gap.amount, 4, gap.image);
  EXPECT_NEAR(gap.Row(kDiscSide / 2 + 10).x, 30, 6) << "half of it is its own";
  EXPECT_EQ(gap.Row(kDiscSide / 2 - 5).x, 0) << "beyond the line nothing is known";
}

}  // namespace
}  // namespace facefit
