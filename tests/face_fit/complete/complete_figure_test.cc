// What is drawn where a photo cuts the figure, on photos of people cut like those of a passport.

#include "face_fit/complete/complete_figure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <utility>

#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/find/network/face_finder.h"
#include "face_fit/fit/fit.h"
#include "face_fit/image/filters.h"
#include "face_fit/image/photo.h"
#include "face_fit/image/pixels.h"
#include "tests/face_fit/built_in_figure_test.h"
#include "tests/support/test_data.h"

namespace facefit {
namespace {

/// A part of a photo, pixels.
struct Part {
  const char* photo;
  int left = 0, top = 0, width = 0, height = 0;  ///< width 0: all of it
};

/// Cut through the neck just below the chin, as many photos on documents are.
constexpr Part kCollinsNeck{"collins_nasa.png", 34, 14, 160, 162};
constexpr Part kLincolnNeck{"lincoln_1863_gardner.jpg", 141, 90, 701, 709};

class CompleteFigureTest : public NetworkTest {
 protected:
  struct Made {
    fsm::Image photo;
    FigureCutout figure;
    CompletedFigure whole;
    glm::vec2 origin;  ///< pixel of the canvas that shows the photo's first
    glm::vec2 chin;    ///< pixel of the canvas
    float pixels_per_mm;

    /// How far the figure reaches to either side of the chin, millimetres, so far below it.
    float WidthBelowChin(float mm) const {
      const FloatImage& opacity = whole.figure.opacity;
      const int y = static_cast<int>(chin.y + mm * pixels_per_mm);
      float sum = 0;
      for (int x = 0; x < opacity.width; ++x) sum += opacity(x, y);
      return sum / pixels_per_mm;
    }
  };
  /// Nothing, and the test is skipped, where the photo is not there.
  std::unique_ptr<Made> Make(const Part& part) {
    const auto photos = support::Photos();
    if (!photos.Has(part.photo)) return nullptr;
    fsm::Image photo = vm::OrThrow(ReadPhoto(photos / part.photo));
    if (part.width > 0) photo = Cropped(photo, part.left, part.top, part.width, part.height);
    const auto faces = FindFaces(*networks_, photo);
    const FoundFace& face = faces.at(0);
    const FaceFit fit = FitFace(Galatea(), face, photo);
    FigureCutout figure = FindFigureOf(*networks_, photo, face);
    CompletedFigure whole = CompleteFigure(fit.head, figure);
    const glm::vec2 origin = glm::round(whole.pose.centre_px - fit.head.pose.centre_px);
    const glm::vec2 chin = whole.pose.PixelOf(fit.head.PositionOf(point::kChin));
    return std::make_unique<Made>(std::move(photo), std::move(figure), std::move(whole), origin,
                                  chin, fit.head.pose.PixelsPerMm());
  }
};

TEST_F(CompleteFigureTest, APhotoCutAtTheNeckGetsANeckThatWidensIntoShoulders) {
  for (const Part& part : {kCollinsNeck, kLincolnNeck}) {
    const auto made = Make(part);
    if (!made) GTEST_SKIP() << support::Photos().Missing();
    EXPECT_TRUE(made->whole.completed.neck) << part.photo;
    const float neck = made->WidthBelowChin(28), shoulders = made->WidthBelowChin(120);
    EXPECT_GT(neck, 75) << part.photo;
    EXPECT_LT(neck, 170) << part.photo;
    EXPECT_GT(shoulders, 220) << part.photo;
  }
}

TEST_F(CompleteFigureTest, NothingBelowAPhotoIsItsMirrorImage) {
  const auto made = Make(kCollinsNeck);
  if (!made) GTEST_SKIP() << support::Photos().Missing();
  const fsm::Image& colours = made->whole.figure.colours;
  const int end = static_cast<int>(made->origin.y) + made->photo.height;
  float difference = 0, count = 0;
  for (int d = 8; d < 30; ++d) {
    for (int x = -25; x <= 25; ++x) {
      const int column = static_cast<int>(made->chin.x) + x;
      const glm::vec3 below = Rgb(colours, made->whole.figure.opacity.Index(column, end + d));
      const glm::vec3 above = Rgb(colours, made->whole.figure.opacity.Index(column, end - 1 - d));
      difference += glm::distance(below, above);
      ++count;
    }
  }
  EXPECT_GT(difference / count, 20);
}

TEST_F(CompleteFigureTest, TheWallBesideAFaceThatFillsItsPhotoIsLeftOut) {
  const auto made = Make(kCollinsNeck);
  if (!made) GTEST_SKIP() << support::Photos().Missing();
  // It is the only thing as light and grey beside the head.
  const FloatImage& opacity = made->figure.opacity;
  float wall = 0, taken = 0;
  for (int y = 0; y < opacity.height; ++y) {
    for (const int x : {0, 1, 2, 3, 4, 5, opacity.width - 4, opacity.width - 3}) {
      const std::size_t i = opacity.Index(x, y);
      const glm::vec3 colour = Rgb(made->photo, i);
      if (std::min({colour.r, colour.g, colour.b}) < 170) continue;
      ++wall;
      taken += opacity.values[i];
    }
  }
  ASSERT_GT(wall, 300);
  EXPECT_LT(taken / wall, 0.05F);
}

TEST_F(CompleteFigureTest, AGreyPhotoIsCompletedInGrey) {
  const auto made = Make(kLincolnNeck);
  if (!made) GTEST_SKIP() << support::Photos().Missing();
  const FloatImage& opacity = made->whole.figure.opacity;
  for (std::size_t i = 0; i < opacity.values.size(); ++i) {
    if (opacity.values[i] < 0.5F) continue;
    const glm::vec3 c = Rgb(made->whole.figure.colours, i);
    ASSERT_LE(std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b}), 3) << i;
  }
}

TEST_F(CompleteFigureTest, HairThatTheUpperEdgeCutsIsRoundedOff) {
  const auto made = Make(kLincolnNeck);
  if (!made) GTEST_SKIP() << support::Photos().Missing();
  EXPECT_TRUE(made->whole.completed.hair);
  const FloatImage& opacity = made->whole.figure.opacity;
  const auto width = [&](float mm) {
    float sum = 0;
    const int y = static_cast<int>(made->origin.y - mm * made->pixels_per_mm);
    for (int x = 0; x < opacity.width; ++x) sum += opacity(x, y);
    return sum / made->pixels_per_mm;
  };
  const float at_edge = width(-1), above = width(5);
  EXPECT_GT(above, 0.4F * at_edge);
  EXPECT_LT(above, 0.95F * at_edge);
  EXPECT_LT(made->pixels_per_mm, made->origin.y) << "there is room above";
  EXPECT_LT(width(made->origin.y / made->pixels_per_mm - 0.5F), 1);
}

TEST_F(CompleteFigureTest, AWholePortraitKeepsItsNeckAndEveryPixel) {
  const auto made = Make({"hopper_usnavy.jpg"});
  if (!made) GTEST_SKIP() << support::Photos().Missing();
  EXPECT_FALSE(made->whole.completed.neck);
  EXPECT_TRUE(made->whole.completed.shoulders);
  const glm::ivec2 from(made->origin);
  for (int y = 0; y < made->photo.height; ++y) {
    for (int x = 0; x < made->photo.width; ++x) {
      const std::size_t i = made->figure.opacity.Index(x, y);
      const std::size_t on = made->whole.figure.opacity.Index(x + from.x, y + from.y);
      ASSERT_EQ(Rgb(made->figure.colours, i), Rgb(made->whole.figure.colours, on));
      ASSERT_GE(made->whole.figure.opacity.values[on], made->figure.opacity.values[i]);
    }
  }
}

using CutShouldersTest = BuiltInFigureTest;

TEST_F(CutShouldersTest, ShouldersFallBeyondThePhotosSides) {
  const CompletedFigure whole = CompleteFigure(fitted_, figure_);
  EXPECT_TRUE(whole.completed.shoulders);
  const glm::vec2 origin = glm::round(whole.pose.centre_px - fitted_.pose.centre_px);
  const FloatImage& opacity = whole.figure.opacity;
  int beside = 0;
  for (int y = 0; y < opacity.height; ++y) {
    for (int x = 0; x < opacity.width; ++x) {
      const glm::vec2 p = glm::vec2(x, y) + 0.5F - origin;
      const float out = std::max(-p.x, p.x - kPhoto);
      if (out < 8 || p.y > kPhoto - 4) continue;
      const float outline = Shoulder(kPhoto / 2) + 0.3F * out;
      if (p.y < outline - 2) {
        EXPECT_LT(opacity(x, y), 0.1F) << p.x << " " << p.y;
      }
      if (p.y < outline + 2 + out * out / 60) continue;
      ++beside;
      EXPECT_GT(opacity(x, y), 0.9F) << p.x << " " << p.y;
    }
  }
  EXPECT_GT(beside, 50);
}

}  // namespace
}  // namespace facefit
