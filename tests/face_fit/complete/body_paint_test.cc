#include "face_fit/complete/body_paint.h"

#include <gtest/gtest.h>

#include "face_fit/complete/light_on_face.h"
#include "face_fit/image/pixels.h"
#include "tests/face_fit/built_in_figure_test.h"

namespace facefit {
namespace {

/// A photo of light grey skin on a canvas, and a bust of cloth, 160 pixels wide.
class BodyPaintTest : public BuiltInFigureTest {
 protected:
  void SetUp() override {
    BuiltInFigureTest::SetUp();
    if (IsSkipped()) return;
    canvas_ = {.photo_origin = {100, 50},
               .photo_size = {kPhoto, kPhoto},
               .size = {500, 500},
               .pixels_per_mm = fitted_.pose.PixelsPerMm(),
               .chin_px = fitted_.pose.PixelOf(fitted_.PositionOf(point::kChin))};
  }
  void CutAwayBody() {
    for (int y = static_cast<int>(canvas_.chin_px.y) + 10; y < kPhoto; ++y) {
      for (int x = 0; x < kPhoto; ++x)
        figure_.opacity(x, y) = std::abs(x - kPhoto / 2) < 40 ? 1 : 0;
    }
  }
  PhotoEdges Edges() const { return {fitted_, figure_, glm::vec3(200)}; }
  BodyShape Shape(const PhotoEdges& edges) const {
    const auto cover = Mask::From(500, 500, [](int x, int) { return std::abs(x - 250) < 80; });
    return {canvas_, edges, figure_.opacity,
            Bust{cover, cover, Mask(500, 500, 1), VectorImage(500, 500, {0, 0, 1}), 250}};
  }
  static float OpacityAt(const BodyShape& shape, glm::vec2 pixel) {
    return shape.OpacityAt(pixel, shape.SampleAt(pixel));
  }

  Canvas canvas_{};
};

TEST_F(BodyPaintTest, AShoulderThatASideCutsGoesOnAtItsFall) {
  const PhotoEdges edges = Edges();
  const BodyShape shape = Shape(edges);
  EXPECT_TRUE(shape.CutsShoulder());
  for (const PhotoEdge side : kPhotoEdges) {
    EXPECT_NEAR(shape.attachments()[side].row, Shoulder(kPhoto / 2), 2);
    EXPECT_NEAR(shape.attachments()[side].shoulder_slope.value_or(0), 0.3F, 0.05F);
  }
  const float outline = Shoulder(kPhoto / 2) + 3;
  EXPECT_LT(OpacityAt(shape, {-10, outline - 6}), 0.1F);
  EXPECT_GT(OpacityAt(shape, {-10, outline + 6}), 0.9F);
  EXPECT_EQ(OpacityAt(shape, {10, kPhoto + 20}), 1) << "beyond the bust, below the photo";
  EXPECT_EQ(OpacityAt(shape, {150, -20}), 0) << "above the photo";
}

TEST_F(BodyPaintTest, WhereOnlyANeckIsSeenTheBustMeetsItsWidthAndIsNotSeenBesideThePhoto) {
  CutAwayBody();
  const PhotoEdges edges = Edges();
  const BodyShape shape = Shape(edges);
  EXPECT_FALSE(shape.CutsShoulder());
  EXPECT_EQ(shape.attachments().left.row, kPhoto);
  EXPECT_NEAR(shape.attachments().left.width_ratio, 0.5F, 0.03F);
  EXPECT_EQ(OpacityAt(shape, {150 - 36, kPhoto + 0.5F}), 1);
  EXPECT_EQ(OpacityAt(shape, {150 - 50, kPhoto + 0.5F}), 0);
  EXPECT_EQ(OpacityAt(shape, {-10, kPhoto - 5}), 0);
}

TEST_F(BodyPaintTest, SkinGoesOnInThePhotosColourUntilTheNecklineCloses) {
  const PhotoEdges edges = Edges();
  const fsm::FaceLight light = LightOnFace(fitted_, figure_.colours);
  const BodyShape shape = Shape(edges);
  const BodyPaint paint(canvas_, edges, light, shape);
  const Paint near = paint.PaintAt({150, kPhoto + 3});
  EXPECT_EQ(near.opacity, 1);
  EXPECT_NEAR(Brightness(near.colour), 200, 15);
  EXPECT_LT(Brightness(paint.PaintAt({150, kPhoto + 100}).colour), 150) << "cloth below it";
  EXPECT_EQ(paint.PaintAt({-50, 0}).opacity, 0);
}

}  // namespace
}  // namespace facefit
