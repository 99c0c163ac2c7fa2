#include "face_fit/complete/photo_edges.h"

#include <gtest/gtest.h>

#include <cmath>

#include "face_fit/image/pixels.h"
#include "tests/face_fit/built_in_figure_test.h"

namespace facefit {
namespace {

constexpr glm::vec3 kSkinColour(200, 150, 130), kHairColour(60, 40, 25), kClothColour(40, 70, 160);

/// The built-in head in a photo that ends so far below its chin, all of the figure; what the lower
/// part shows beside the chin is for the test to say.
class PhotoEdgesTest : public BuiltInFigureTest {
 protected:
  /// `colour(aside_mm)`: of the columns, from the chin down; hair is above the forehead.
  PhotoEdges EdgesOf(float below_chin_mm, auto colour) {
    const glm::vec2 chin = fitted_.pose.PixelOf(fitted_.PositionOf(point::kChin));
    const float forehead = fitted_.pose.PixelOf(fitted_.PositionOf(point::kForehead)).y;
    const float pixels_per_mm = fitted_.pose.PixelsPerMm();
    const int height = static_cast<int>(chin.y + below_chin_mm * pixels_per_mm);
    FigureCutout figure{fsm::FilledImage(kPhoto, height), FloatImage(kPhoto, height, 1)};
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < kPhoto; ++x) {
        const auto row = static_cast<float>(y);
        const float aside_mm = std::abs(static_cast<float>(x) + 0.5F - chin.x) / pixels_per_mm;
        SetRgb(figure.colours, figure.opacity.Index(x, y),
               row < forehead      ? kHairColour
               : row < chin.y - 40 ? kSkinColour
                                   : colour(aside_mm));
      }
    }
    chin_ = chin.x;
    return PhotoEdges(fitted_, figure, kSkinColour);
  }
  /// The kind of the lower edge so far to the left of the chin.
  EdgeKind KindAt(const PhotoEdges& edges, float aside_mm) const {
    return edges.bottom(static_cast<int>(chin_ - aside_mm * fitted_.pose.PixelsPerMm())).kind;
  }
  float chin_ = 0;
};

TEST_F(PhotoEdgesTest, ColoursTellHairFromSkinAndCloth) {
  const PhotoEdges edges = EdgesOf(60, [](float aside_mm) {
    return aside_mm < 30 ? kSkinColour : aside_mm < 45 ? kHairColour : kClothColour;
  });
  EXPECT_EQ(KindAt(edges, 10), EdgeKind::kSkin);
  EXPECT_EQ(KindAt(edges, 38), EdgeKind::kHair);
  EXPECT_EQ(KindAt(edges, 60), EdgeKind::kCloth);
  EXPECT_LT(std::abs(edges.hair().r - kHairColour.r), 2);
  EXPECT_EQ(edges.top(kPhoto / 2).kind, EdgeKind::kHair);
  EXPECT_GT(edges.top(kPhoto / 2).hair_reach_px, 5);
}

TEST_F(PhotoEdgesTest, AboveTheShouldersTheShadeOnABareNeckIsSkin) {
  const PhotoEdges edges =
      EdgesOf(10, [](float aside_mm) { return aside_mm < 20 ? kClothColour : kSkinColour; });
  EXPECT_EQ(KindAt(edges, 10), EdgeKind::kSkin);
}

TEST_F(PhotoEdgesTest, ANeckMayBeInACollarWhereEnoughOfItIsShown) {
  const PhotoEdges edges = EdgesOf(30, [](float) { return kClothColour; });
  EXPECT_EQ(KindAt(edges, 10), EdgeKind::kCloth);
}

TEST_F(PhotoEdgesTest, BesideABareNeckOnlyTipsOfACollarStand) {
  const PhotoEdges edges =
      EdgesOf(10, [](float aside_mm) { return aside_mm < 38 ? kSkinColour : kClothColour; });
  EXPECT_EQ(KindAt(edges, 43), EdgeKind::kTip);
}

TEST_F(PhotoEdgesTest, WhatHangsDownFartherAsideIsHairWhateverItsColour) {
  const PhotoEdges edges =
      EdgesOf(10, [](float aside_mm) { return aside_mm < 38 ? kSkinColour : kClothColour; });
  EXPECT_EQ(KindAt(edges, 56), EdgeKind::kHair);
}

}  // namespace
}  // namespace facefit
