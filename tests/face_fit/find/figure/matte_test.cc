#include "face_fit/find/figure/matte.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "face_fit/image/filters.h"
#include "face_fit/image/resample.h"
#include "tests/face_fit/disc_image.h"

namespace facefit {
namespace {

glm::vec3 Sky(glm::vec2 p) { return kSky + 12.0F * std::sin(p.x / 9) + 10.0F * std::cos(p.y / 14); }
glm::vec3 Hair(glm::vec2 p) { return kHair + 12.0F * std::sin(p.x / 3 + p.y / 5); }

float MeanDifference(const FloatImage& a, const FloatImage& b) {
  float sum = 0, count = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    if (b.values[i] <= 0 || b.values[i] >= 1) continue;
    sum += std::abs(a.values[i] - b.values[i]);
    ++count;
  }
  return sum / count;
}

TEST(MatteTest, FindsTheSoftEdgeThatTheRoughOutlineMisses) {
  const FloatImage truth = FieldOf([](glm::vec2 p) { return Disc(p, 50, 4); });
  const fsm::Image photo =
      Painted([](glm::vec2 p) { return glm::mix(Sky(p), Hair(p), Disc(p, 50, 4)); });
  // A pixel too large, and as blurred as a network's.
  const FloatImage rough = Blurred(FieldOf([](glm::vec2 p) { return Disc(p, 51, 1); }), 1);
  EXPECT_GT(MeanDifference(rough, truth), 0.2F);
  const FloatImage found = CutOutFigure(photo, rough).opacity;
  EXPECT_LT(MeanDifference(found, truth), 0.06F);
  // What is as good as nothing or all is that, to the last bit.
  int between = 0, whole = 0;
  for (std::size_t i = 0; i < truth.values.size(); ++i) {
    if (truth.values[i] > 0 && truth.values[i] < 1) continue;
    const bool near = rough.values[i] > 0 && rough.values[i] < 1;
    between += near && found.values[i] > 0 && found.values[i] < 1 ? 1 : 0;
    whole += near ? 1 : 0;
  }
  EXPECT_LT(between, whole / 4) << whole;
}

TEST(MatteTest, BlackHairBeforeAWhiteWallIsParted) {
  // All colours lie on one line, as far apart as can be.
  const FloatImage truth = FieldOf([](glm::vec2 p) { return Disc(p, 50, 4); });
  const fsm::Image photo =
      Painted([](glm::vec2 p) { return glm::vec3(255 * (1 - Disc(p, 50, 4))); });
  const FloatImage rough = Blurred(FieldOf([](glm::vec2 p) { return Disc(p, 51, 1); }), 1);
  EXPECT_LT(MeanDifference(CutOutFigure(photo, rough).opacity, truth), 0.06F);
}

TEST(MatteTest, StrandsOfHairAreKeptAndTheSkyBetweenThemIsNot) {
  // Thin dark lines stand out of the disc, up and right of its middle.
  const auto strand = [](glm::vec2 p) {
    const bool beyond = glm::distance(p, glm::vec2(kDiscSide / 2)) < 54 && p.y < kDiscSide / 2 - 30;
    return beyond && std::fmod(p.x, 6.0F) < 1.5F ? 1.0F : 0.0F;
  };
  const auto part = [&](glm::vec2 p) { return std::max(Disc(p, 50, 2), strand(p)); };
  const fsm::Image photo = Painted([&](glm::vec2 p) { return glm::mix(Sky(p), Hair(p), part(p)); });
  const FloatImage found =
      CutOutFigure(photo, Blurred(FieldOf([](glm::vec2 p) { return Disc(p, 50, 1); }), 2)).opacity;
  float hair = 0, hairs = 0, sky = 0, skies = 0;
  for (int y = 20; y < kDiscSide / 2 - 30; ++y) {
    for (int x = kDiscSide / 2 - 20; x < kDiscSide / 2 + 20; ++x) {
      const glm::vec2 p = glm::vec2(x, y) + 0.5F;
      const float off = glm::distance(p, glm::vec2(kDiscSide / 2));
      if (off < 51.5F || off > 53) continue;
      (strand(p) > 0 ? hair : sky) += found(x, y);
      (strand(p) > 0 ? hairs : skies) += 1;
    }
  }
  ASSERT_GT(hairs, 5);
  EXPECT_GT(hair / hairs, 0.5F);
  EXPECT_LT(sky / skies, 0.3F);
}

TEST(MatteTest, DoubtOverAWideAreaIsDecided) {
  // The network sees half of a white cap only in part.
  const auto cap = [](glm::vec2 p) { return Disc(p, 50, 2); };
  const fsm::Image photo =
      Painted([&](glm::vec2 p) { return glm::mix(Sky(p), glm::vec3(235), cap(p)); });
  const FloatImage doubt =
      FieldOf([&](glm::vec2 p) { return cap(p) * (p.x < kDiscSide / 2 ? 0.65F : 1.0F); });
  const FloatImage found = CutOutFigure(photo, doubt).opacity;
  float least = 1;
  for (int x = 35; x < kDiscSide / 2; ++x) {
    least = std::min(least, found(x, kDiscSide / 2));
  }
  EXPECT_GT(least, 0.9F);
}

TEST(MatteTest, ALargePhotoHasTheEdgeOfItsOwnPixels) {
  // A grey image, whose colours lie on one line, larger than what is solved.
  constexpr int kLarge = 1600, kHigh = 200;
  fsm::Image photo{.width = kLarge, .height = kHigh, .rgba = {}};
  FloatImage rough(kLarge, kHigh);
  const auto part = [](int x) { return x < 400 ? 0.0F : 1.0F; };
  for (int y = 0; y < kHigh; ++y) {
    for (int x = 0; x < kLarge; ++x) {
      const auto v = static_cast<std::uint8_t>(200 - 170 * part(x) +
                                               10 * std::sin(static_cast<float>(y) / 30));
      photo.rgba.insert(photo.rgba.end(), {v, v, v, 255});
      rough(x, y) = glm::smoothstep(390.0F, 402.0F, static_cast<float>(x));
    }
  }
  const FloatImage found = CutOutFigure(photo, rough).opacity;
  for (const int x : {390, 397, 399, 400, 402, 410}) {
    EXPECT_NEAR(found(x, 100), part(x), 0.15F) << x;
  }
}

TEST(MatteTest, TheEdgeLosesTheBackgroundsColour) {
  const FloatImage opacity = FieldOf([](glm::vec2 p) { return Disc(p, 50, 6); });
  const fsm::Image photo =
      Painted([](glm::vec2 p) { return glm::mix(Sky(p), kHair, Disc(p, 50, 6)); });
  const fsm::Image figure = ForegroundColours(photo, opacity);
  float most = 0;
  for (std::size_t i = 0; i < opacity.values.size(); ++i) {
    if (opacity.values[i] < 0.3F) continue;
    const glm::vec3 c(figure.rgba[4 * i], figure.rgba[4 * i + 1], figure.rgba[4 * i + 2]);
    most = std::max(most, glm::distance(c, kHair));
  }
  EXPECT_LT(most, 25);
  const glm::vec3 beyond = ColourAt(figure, glm::vec2(kDiscSide / 2 + 56, kDiscSide / 2));
  EXPECT_LT(glm::distance(beyond, kHair), 25) << "it goes on beyond its edge";
}

}  // namespace
}  // namespace facefit
