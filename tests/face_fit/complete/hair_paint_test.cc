#include "face_fit/complete/hair_paint.h"

#include <gtest/gtest.h>

#include "face_fit/image/pixels.h"
#include "tests/face_fit/built_in_figure_test.h"

namespace facefit {
namespace {

/// A head with dark hair that the upper edge cuts between columns 80 and 220; light skin below.
class HairPaintTest : public BuiltInFigureTest {
 protected:
  static constexpr std::uint8_t kHair = 40, kSkin = 200;
  void SetUp() override {
    BuiltInFigureTest::SetUp();
    if (IsSkipped()) return;
    const float forehead = fitted_.pose.PixelOf(fitted_.PositionOf(point::kForehead)).y;
    for (int y = 0; y < kPhoto; ++y) {
      const bool hair = static_cast<float>(y) < forehead;
      for (int x = 0; x < kPhoto; ++x) {
        const std::size_t i = figure_.opacity.Index(x, y);
        SetRgb(figure_.colours, i, glm::vec3(hair ? kHair : kSkin));
        if (hair) figure_.opacity.values[i] = x >= 80 && x < 220 ? 1 : 0;
      }
    }
    canvas_ = {.photo_origin = {100, 100},
               .photo_size = {kPhoto, kPhoto},
               .size = {500, 600},
               .pixels_per_mm = fitted_.pose.PixelsPerMm(),
               .chin_px = fitted_.pose.PixelOf(fitted_.PositionOf(point::kChin))};
  }
  Canvas canvas_{};
};

TEST_F(HairPaintTest, HairThatTheUpperEdgeCutsIsRoundedOffUpToTheCrown) {
  const PhotoEdges edges(fitted_, figure_, glm::vec3(kSkin));
  const HairPaint hair(canvas_, edges, figure_.colours, -20);
  EXPECT_TRUE(hair.CutsHair());
  EXPECT_GT(hair.PaintAt({150, -5}).opacity, 0.9F);
  EXPECT_NEAR(Brightness(hair.PaintAt({150, -5}).colour), kHair, 2);
  EXPECT_EQ(hair.PaintAt({150, -21}).opacity, 0) << "above the crown";
  EXPECT_EQ(hair.PaintAt({90, -15}).opacity, 0) << "the dome is round";
  EXPECT_EQ(hair.PaintAt({60, -5}).opacity, 0) << "beside what the edge cuts";
  EXPECT_EQ(hair.PaintAt({150, kPhoto + 5}).opacity, 0) << "no hair reaches the lower edge";
  EXPECT_EQ(hair.PaintAt({-5, 50}).opacity, 0) << "nor a side";
}

TEST_F(HairPaintTest, APhotoThatCutsNoHairGetsNone) {
  for (int x = 0; x < kPhoto; ++x) {
    for (int y = 0; y < 5; ++y) figure_.opacity(x, y) = 0;
  }
  const PhotoEdges edges(fitted_, figure_, glm::vec3(kSkin));
  const HairPaint hair(canvas_, edges, figure_.colours, 5);
  EXPECT_FALSE(hair.CutsHair());
  EXPECT_EQ(hair.PaintAt({150, -1}).opacity, 0);
}

}  // namespace
}  // namespace facefit
