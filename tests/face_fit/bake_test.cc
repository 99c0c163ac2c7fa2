// How a figure is cut out of its photo and worn: its edge, what goes on behind and beside it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <vector>

#include "face_fit/bake/sheet.h"
#include "face_fit/complete/complete_figure.h"
#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/find/figure/matte.h"
#include "face_fit/picture/filters.h"
#include "face_fit/picture/grain.h"
#include "face_fit/picture/resample.h"
#include "tests/face_fit/network_fixture.h"

namespace facefit {
namespace {

constexpr int kDiscSide = 160;

/// Calls `f(pixel centre)` for the colour of each pixel, 0..255.
template <typename F>
fsm::Image Painted(F f) {
  fsm::Image image{.width = kDiscSide, .height = kDiscSide, .rgba = {}};
  for (int y = 0; y < kDiscSide; ++y) {
    for (int x = 0; x < kDiscSide; ++x) {
      const glm::vec3 c = f(glm::vec2(x, y) + 0.5F);
      for (int k = 0; k < 3; ++k) image.rgba.push_back(static_cast<std::uint8_t>(c[k] + 0.5F));
      image.rgba.push_back(255);
    }
  }
  return image;
}

template <typename F>
FloatImage Of(F f) {
  FloatImage field(kDiscSide, kDiscSide);
  for (int y = 0; y < kDiscSide; ++y) {
    for (int x = 0; x < kDiscSide; ++x) field(x, y) = f(glm::vec2(x, y) + 0.5F);
  }
  return field;
}

/// A disc, soft over `soft` pixels.
float Disc(glm::vec2 p, float radius, float soft) {
  const float off = radius - glm::distance(p, glm::vec2(kDiscSide / 2));
  return glm::clamp(0.5F + off / soft, 0.0F, 1.0F);
}

constexpr glm::vec3 kHair(70, 45, 20), kSky(120, 160, 220);
glm::vec3 Sky(glm::vec2 p) { return kSky + 12.0F * std::sin(p.x / 9) + 10.0F * std::cos(p.y / 14); }
glm::vec3 Hair(glm::vec2 p) { return kHair + 12.0F * std::sin(p.x / 3 + p.y / 5); }

float MeanDifference(const FloatImage& a, const FloatImage& b) {
  float sum = 0, count = 0;
  for (std::size_t i = 0; i < a.at.size(); ++i) {
    if (b.at[i] <= 0 || b.at[i] >= 1) continue;
    sum += std::abs(a.at[i] - b.at[i]);
    ++count;
  }
  return sum / count;
}

TEST(MatteTest, FindsTheSoftEdgeThatTheRoughOutlineMisses) {
  const FloatImage truth = Of([](glm::vec2 p) { return Disc(p, 50, 4); });
  const fsm::Image photo =
      Painted([](glm::vec2 p) { return glm::mix(Sky(p), Hair(p), Disc(p, 50, 4)); });
  // A pixel too large, and as blurred as a network's.
  const FloatImage rough = Blurred(Of([](glm::vec2 p) { return Disc(p, 51, 1); }), 1);
  EXPECT_GT(MeanDifference(rough, truth), 0.2F);
  const FloatImage found = Matte(photo, rough);
  EXPECT_LT(MeanDifference(found, truth), 0.06F);
  // What is as good as nothing or all is that, to the last bit.
  int between = 0, whole = 0;
  for (std::size_t i = 0; i < truth.at.size(); ++i) {
    if (truth.at[i] > 0 && truth.at[i] < 1) continue;
    const bool near = rough.at[i] > 0 && rough.at[i] < 1;
    between += near && found.at[i] > 0 && found.at[i] < 1 ? 1 : 0;
    whole += near ? 1 : 0;
  }
  EXPECT_LT(between, whole / 4) << whole;
}

TEST(MatteTest, BlackHairBeforeAWhiteWallIsParted) {
  // All colours lie on one line, as far apart as can be.
  const FloatImage truth = Of([](glm::vec2 p) { return Disc(p, 50, 4); });
  const fsm::Image photo =
      Painted([](glm::vec2 p) { return glm::vec3(255 * (1 - Disc(p, 50, 4))); });
  const FloatImage rough = Blurred(Of([](glm::vec2 p) { return Disc(p, 51, 1); }), 1);
  EXPECT_LT(MeanDifference(Matte(photo, rough), truth), 0.06F);
}

TEST(MatteTest, StrandsOfHairAreKeptAndTheSkyBetweenThemIsNot) {
  // Thin dark lines stand out of the disc, up and right of its middle.
  const auto strand = [](glm::vec2 p) {
    const bool beyond = glm::distance(p, glm::vec2(kDiscSide / 2)) < 54 && p.y < kDiscSide / 2 - 30;
    return beyond && std::fmod(p.x, 6.0F) < 1.5F ? 1.0F : 0.0F;
  };
  const auto part = [&](glm::vec2 p) { return std::max(Disc(p, 50, 2), strand(p)); };
  const fsm::Image photo = Painted([&](glm::vec2 p) { return glm::mix(Sky(p), Hair(p), part(p)); });
  const FloatImage found = Matte(photo, Blurred(Of([](glm::vec2 p) { return Disc(p, 50, 1); }), 2));
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
      Of([&](glm::vec2 p) { return cap(p) * (p.x < kDiscSide / 2 ? 0.65F : 1.0F); });
  const FloatImage found = Matte(photo, doubt);
  float least = 1;
  for (int x = 35; x < kDiscSide / 2; ++x) {
    least = std::min(least, found(x, kDiscSide / 2));
  }
  EXPECT_GT(least, 0.9F);
}

TEST(MatteTest, ALargePhotoHasTheEdgeOfItsOwnPixels) {
  // A grey picture, whose colours lie on one line, larger than what is solved.
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
  const FloatImage found = Matte(photo, rough);
  for (const int x : {390, 397, 399, 400, 402, 410}) {
    EXPECT_NEAR(found(x, 100), part(x), 0.15F) << x;
  }
}

TEST(MatteTest, TheEdgeLosesTheBackgroundsColour) {
  const FloatImage opacity = Of([](glm::vec2 p) { return Disc(p, 50, 6); });
  const fsm::Image photo =
      Painted([](glm::vec2 p) { return glm::mix(Sky(p), kHair, Disc(p, 50, 6)); });
  const fsm::Image figure = ForegroundColours(photo, opacity);
  float most = 0;
  for (std::size_t i = 0; i < opacity.at.size(); ++i) {
    if (opacity.at[i] < 0.3F) continue;
    const glm::vec3 c(figure.rgba[4 * i], figure.rgba[4 * i + 1], figure.rgba[4 * i + 2]);
    most = std::max(most, glm::distance(c, kHair));
  }
  EXPECT_LT(most, 25);
  const glm::vec3 beyond = ColourAt(figure, glm::vec2(kDiscSide / 2 + 56, kDiscSide / 2));
  EXPECT_LT(glm::distance(beyond, kHair), 25) << "it goes on beyond its edge";
}

TEST(FigureTest, WhatOnlyOneSideOfAHeadShowsIsDoubtedAndRatherThereIfItLooksAlike) {
  FoundFace face;
  face.points.assign(kNetworkPoints, glm::vec3(0));
  face.points[10] = glm::vec3(kDiscSide / 2, 40, 0);
  face.points[152] = glm::vec3(kDiscSide / 2, 140, 0);
  // The network missed an ear on the left, and on the right saw hair that the left has none of.
  const auto ear = [](glm::vec2 p) { return std::abs(p.y - 90) < 10; };
  const fsm::Image photo = Painted([&](glm::vec2 p) {
    const float off = std::abs(p.x - kDiscSide / 2);
    if (off > 50) return kSky;
    return ear(p) || off < 30 ? glm::vec3(220, 170, 140) : p.x < kDiscSide / 2 ? kSky : kHair;
  });
  FloatImage person(kDiscSide, kDiscSide);
  const auto at = [&person](int x, int y) -> float& { return person(x, y); };
  for (int y = 0; y < kDiscSide; ++y) {
    for (int x = kDiscSide / 2 - 30; x < kDiscSide / 2 + 50; ++x) at(x, y) = 1;
  }
  person = DoubtAsymmetry(face, photo, person);
  EXPECT_GT(at(kDiscSide / 2 - 40, 90), 0.75F) << "the ear";
  EXPECT_NEAR(at(kDiscSide / 2 - 40, 60), 0.5F, 0.1F) << "no hair";
  EXPECT_EQ(at(kDiscSide / 2 - 60, 90), 0) << "neither side";
  EXPECT_EQ(at(kDiscSide / 2 - 40, 150), 0) << "clothes need not be alike";
  EXPECT_EQ(at(kDiscSide / 2 + 40, 60), 1);
}

TEST(GrainTest, TheNearestKnownPointIsFound) {
  FloatImage weight(40, 30);
  weight(3, 4) = weight(30, 20) = 1;
  const auto nearest = NearestAbove(weight, 0.95F);
  EXPECT_EQ(nearest[weight.Index(0, 0)], weight.Index(3, 4));
  EXPECT_EQ(nearest[weight.Index(39, 0)], weight.Index(30, 20));
  EXPECT_EQ(nearest[weight.Index(10, 29)], weight.Index(30, 20));
  EXPECT_EQ(nearest[weight.Index(3, 4)], weight.Index(3, 4));
}

TEST(GrainTest, WhatIsFilledInIsAsRoughAsWhatLiesBesideIt) {
  // Stripes, and a hole across the middle.
  const auto hole = [](glm::vec2 p) { return std::abs(p.y - kDiscSide / 2) < 12; };
  fsm::Image image =
      Painted([](glm::vec2 p) { return glm::vec3(std::fmod(p.x, 4.0F) < 2 ? 150 : 90); });
  const FloatImage weight = Of([&](glm::vec2 p) { return hole(p) ? 0.0F : 1.0F; });
  PushPullInpaint(image, weight);
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
  AddGrain(weight, Of([](glm::vec2) { return 1.0F; }), 4, image);
  EXPECT_GT(roughness(), 40);
}

TEST(GrainTest, TheNearestOfManyKnownPointsIsTheNearest) {
  FloatImage weight(60, 50);
  for (std::uint32_t k = 1, at = 7; k < 40; ++k) {
    at = (at * 1103515245U + 12345U) % 3000U;
    weight.at[at] = 1;
  }
  const auto nearest = NearestAbove(weight, 0.95F);
  const auto far = [](std::size_t a, std::size_t b) {
    return glm::distance(glm::vec2(a % 60, a / 60), glm::vec2(b % 60, b / 60));
  };
  int farther = 0;
  for (std::size_t i = 0; i < weight.at.size(); ++i) {
    float least = 1e9F;
    for (std::size_t k = 0; k < weight.at.size(); ++k) {
      if (weight.at[k] > 0) least = std::min(least, far(i, k));
    }
    EXPECT_LT(far(i, nearest[i]), least + 0.5F) << i;
    farther += far(i, nearest[i]) > least + 1e-3F ? 1 : 0;
  }
  EXPECT_LT(farther, 10) << "of 3000";
}

/// Stripes up and down where something is known, an even grey in the gap that was filled.
class GrainGap {
 public:
  GrainGap(float half_gap, float share)
      : weight(Of([half_gap](glm::vec2 p) { return Off(p) < half_gap ? 0.0F : 1.0F; })),
        where(Of([share](glm::vec2) { return share; })),
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

  FloatImage weight, where;
  fsm::Image image;
};

TEST(GrainTest, GrainIsLentInFullAsFarAsItWasAskedForAndChangesNoColour) {
  GrainGap whole(12, 1), half(12, 0.5F), none(12, 0);
  for (GrainGap* gap : {&whole, &half, &none}) AddGrain(gap->weight, gap->where, 4, gap->image);
  constexpr int kRow = kDiscSide / 2 - 8;
  EXPECT_NEAR(whole.Row(kRow).x, 60, 8);
  EXPECT_NEAR(half.Row(kRow).x, 30, 4);
  EXPECT_EQ(none.Row(kRow).x, 0);
  EXPECT_NEAR(whole.Row(kRow).y, 180, 3);
}

TEST(GrainTest, GrainIsNotCarriedFar) {
  GrainGap gap(38, 1);
  AddGrain(gap.weight, gap.where, 4, gap.image);
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
  AddGrain(gap.weight, gap.where, 2, gap.image);
  EXPECT_GT(gap.Row(kDiscSide / 2 - 17).x, 40) << "three pixels within";
  EXPECT_LT(gap.Row(kDiscSide / 2 - 9).x, 6) << "eleven pixels within";
}

TEST(GrainTest, WhatIsHalfKnownTakesHalfTheGrainAndGivesHalf) {
  GrainGap gap(12, 1);
  for (int y = 0; y < kDiscSide; ++y) {
    const float off = GrainGap::Off({0, static_cast<float>(y) + 0.5F});
    for (int x = 0; x < kDiscSide; ++x) {
      float& known = gap.weight(x, y);
      if (off > 9 && off < 12) known = 0.5F;
      // A thin line is all that is known before more that is not.
      if (off > 14 && y < kDiscSide / 2) known = 0;
    }
  }
  AddGrain(gap.weight, gap.where, 4, gap.image);
  EXPECT_NEAR(gap.Row(kDiscSide / 2 + 10).x, 30, 6) << "half of it is its own";
  EXPECT_EQ(gap.Row(kDiscSide / 2 - 5).x, 0) << "beyond the line nothing is known";
}

TEST(EnlargeTest, BesideAHardEdgeColoursStayWithinTheirRange) {
  const fsm::Image image = Painted([](glm::vec2 p) { return glm::vec3(p.x < 80 ? 0 : 255); });
  for (float x = 77; x < 83; x += 0.1F) {
    const float seen = SharpColourAt(image, {x, 50.5F}).r;
    EXPECT_GE(seen, 0);
    EXPECT_LE(seen, 255);
  }
}

TEST(EnlargeTest, ColoursGoThroughTheirPixelsAndContoursAreStraight) {
  const fsm::Image image = Painted([](glm::vec2 p) { return glm::vec3(100 + p.x / 2, p.y, 40); });
  EXPECT_LT(glm::distance(SharpColourAt(image, {70.5F, 30.5F}), ColourAt(image, {70.5F, 30.5F})),
            0.01F);
  // Of a slanted edge in steps of pixels the contour wavers less than between straight lines.
  const FloatImage steps = Of([](glm::vec2 p) { return p.y > 60 + p.x / 4 ? 1.0F : 0.0F; });
  const auto waver = [&](auto&& value) {
    float most = 0;
    for (float x = 40; x < 120; x += 0.25F) {
      float y = 60 + x / 4 - 4;
      while (value(x, y) < 0.5F) y += 0.02F;
      most = std::max(most, std::abs(y - (60 + x / 4)));
    }
    return most;
  };
  const float plain = waver([&](float x, float y) { return steps.Between(x, y); });
  const float smooth = waver([&](float x, float y) { return SmoothAt(steps, {x, y}); });
  EXPECT_LT(smooth, 0.8F * plain);
}

/// The built-in head as if a photo showed it, with shoulders that the photo's sides cut off.
class PhotoSheetTest : public NetworkTest {
 protected:
  static constexpr int kPhoto = 300;
  void SetUp() override {
    NetworkTest::SetUp();
    if (IsSkipped()) return;
    fitted_.base = &Galatea();
    fitted_.pose.focal = 760;
    fitted_.pose.centre = {kPhoto / 2, kPhoto / 2};
    fitted_.posed_vertices = Galatea().rest.position;
    for (const glm::vec3 at : {glm::vec3(0), {50, 0, 0}, {0, 50, 0}, {0, 0, 50}, {50, 50, 20}}) {
      fitted_.points.push_back({at, glm::vec3(0)});
    }
    for (int y = 0; y < kPhoto; ++y) {
      for (int x = 0; x < kPhoto; ++x) {
        const float off = std::abs(static_cast<float>(x - kPhoto / 2));
        const bool head = glm::length(glm::vec2(off, y - kPhoto / 2 + 10)) < 100;
        const bool body = static_cast<float>(y) > Shoulder(off);
        figure_.opacity(x, y) = head || body ? 1.0F : 0.0F;
      }
    }
    figure_.colours.rgba.assign(static_cast<std::size_t>(4 * kPhoto * kPhoto), 200);
  }
  static float Shoulder(float off) { return 240 + 0.3F * std::max(off - 40, 0.0F); }
  Sheet Made() const { return MakeSheet(fitted_, figure_); }
  /// The pixel over which a vertex lies.
  glm::vec2 Over(const fsm::PhotoHead::SheetVertex& vertex) const {
    return fitted_.pose.Pixel(vertex.position);
  }

  FittedHead fitted_;
  Cutout figure_{{.width = kPhoto, .height = kPhoto, .rgba = {}}, FloatImage(kPhoto, kPhoto)};
};

TEST_F(PhotoSheetTest, ShouldersFallBeyondThePhotosSides) {
  const CompletedFigure whole = CompleteFigure(fitted_, figure_);
  EXPECT_TRUE(whole.completed.shoulders);
  const glm::vec2 origin = glm::round(whole.head.pose.centre - fitted_.pose.centre);
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

TEST_F(PhotoSheetTest, IsWrittenFromBackToFront) {
  const Sheet set = Made();
  ASSERT_GT(set.triangles.size(), 600U);
  float last = -1e9F;
  for (std::size_t i = 0; i + 5 < set.triangles.size(); i += 6) {
    const float z =
        set.vertices[set.triangles[i]].position.z + set.vertices[set.triangles[i + 2]].position.z;
    EXPECT_GE(z, last - 1e-3F);
    last = z;
  }
}

TEST_F(PhotoSheetTest, GoesWithTheFaceFromItsExpressionToRest) {
  const Sheet still = Made();
  // In the photo the whole face is 6 mm higher than at rest.
  for (glm::vec3& p : fitted_.posed_vertices) p.y += p.z > 0 ? 6.0F : 0.0F;
  const Sheet moved = Made();
  const glm::vec3 cheek = Galatea().points[234].On(Galatea().rest.position);
  const auto motion = [&](glm::vec2 near) {
    float nearest = 1e9F, by = 0;
    for (const auto& vertex : moved.vertices) {
      const float far = glm::distance(glm::vec2(vertex.position), near);
      if (far >= nearest) continue;
      nearest = far;
      // Where the photo shows this, against where it is now.
      const glm::vec2 pixel =
          glm::vec2(2 * vertex.texcoord.x - 1, vertex.texcoord.y) * float{kPhoto};
      const glm::vec3 q = fitted_.pose.ToCamera(vertex.position);
      by = vertex.position.y - fitted_.pose.PlaceAt(pixel, q.z).y;
    }
    return by;
  };
  EXPECT_NEAR(motion(glm::vec2(cheek)), -6, 2);
  EXPECT_NEAR(motion(glm::vec2(0, cheek.y + 140)), 0, 0.5F) << "far from the face";
  EXPECT_EQ(still.vertices.size(), moved.vertices.size());
}

TEST_F(PhotoSheetTest, NothingOfItLiesBehindEyesAndMouthOfATurnedHead) {
  fitted_.pose.turn.y = glm::radians(25.0F);
  const Sheet set = Made();
  const auto at = [&](std::size_t point) {
    return Galatea().points[point].On(Galatea().rest.position);
  };
  // Within the corners of the mouth, below them, and within the corners of the eyes.
  const glm::vec3 in(5, 0, 0), down(0, 9, 0);
  for (const glm::vec3 opening : {at(78) + in, at(308) - in, at(78) + in - down,
                                  at(308) - in - down, at(33) + in, at(263) - in}) {
    for (std::size_t i = 0; i + 5 < set.triangles.size(); i += 6) {
      const glm::vec3 p = 0.5F * (set.vertices[set.triangles[i]].position +
                                  set.vertices[set.triangles[i + 2]].position);
      // What lies far behind is the hair at the nape.
      if (p.z < opening.z - 80) continue;
      EXPECT_GT(glm::distance(glm::vec2(p), glm::vec2(opening)), 3) << p.x << " " << p.y;
    }
  }
  EXPECT_GT(set.triangles.size(), 600U);
}

TEST_F(PhotoSheetTest, NothingOfItLiesBehindTheMouthWhereItsCellsAreWide) {
  // A head that is small in its photo: a cell is 9 mm wide.
  fitted_.pose.focal = 250;
  fitted_.pose.turn.y = glm::radians(15.0F);
  const Sheet set = Made();
  const glm::vec3 right = Galatea().points[78].On(Galatea().rest.position),
                  left = Galatea().points[308].On(Galatea().rest.position);
  for (std::size_t i = 0; i + 5 < set.triangles.size(); i += 6) {
    const glm::vec3 p = 0.5F * (set.vertices[set.triangles[i]].position +
                                set.vertices[set.triangles[i + 2]].position);
    if (p.z < right.z - 80) continue;
    const bool behind = p.x > right.x && p.x < left.x && p.y < right.y && p.y > right.y - 20;
    EXPECT_FALSE(behind) << p.x << " " << p.y;
  }
}

}  // namespace
}  // namespace facefit
