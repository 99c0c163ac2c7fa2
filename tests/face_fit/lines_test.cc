// What is followed in a photo beside the network's points: the line between the lips, the iris.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <utility>
#include <vector>

#include "face_fit/bake/eye_pictures.h"
#include "face_fit/bake/feature_colours.h"
#include "face_fit/bake/openings.h"
#include "face_fit/bake/red_eye.h"
#include "face_fit/bake/skin_colours.h"
#include "face_fit/bake/smile_folds.h"
#include "face_fit/find/face/glasses.h"
#include "face_fit/find/face/iris.h"
#include "face_fit/find/face/mouth_line.h"
#include "face_fit/find/head/base_head.h"
#include "face_fit/fit/fit.h"
#include "face_fit/picture/resample.h"
#include "fsm/head/make_head.h"

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
  ASSERT_EQ(line.size(), kMouthLinePoints);
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
  for (const std::size_t i : point::kLowerInnerLip) face.points[i].y += 12;
  const Openings open(face, 2, true);
  EXPECT_EQ(open.SkinWeight({100, 106}), 0);
  EXPECT_EQ(open.SkinWeight({100, 99}), 0) << "the blurred edge";
  const float part = open.SkinWeight({100, 97.6F});
  EXPECT_GT(part, 0.1F);
  EXPECT_LT(part, 0.9F);
  EXPECT_EQ(open.SkinWeight({100, 90}), 1);
  EXPECT_EQ(open.SkinWeight({20, 20}), 1);
  EXPECT_EQ(Openings(face, 2, false).SkinWeight({100, 106}), 1) << "closed lips are all skin";
}

TEST(SkinColoursTest, AFringeIsNoSkinAndABrightForeheadIs) {
  // From the top: a hat, dark hair, a forehead in the light, the face.
  const fsm::Image map = Drawn(400, [](glm::vec2 p) {
    return p.y < 50 ? 200 : p.y < 100 ? 60 : p.y < 200 ? 240 : 160;
  });
  const FloatImage likeness = SkinLikeness(map, FloatImage(400, 400, 1));
  const auto at = [&](int y) { return likeness(200, y); };
  EXPECT_EQ(at(75), 0);
  EXPECT_EQ(at(150), 1);
  EXPECT_EQ(at(300), 1);
  EXPECT_EQ(SkinLikeness(map, FloatImage(400, 400)).at[75 * 400], 1) << "no face was seen";
}

TEST(SkinColoursTest, BrightStrandsOfAFringeAreNoSkinAndLinesOfTheForeheadAre) {
  // From the top: bright strands, dark ones, forehead with a dark line, brows, cheek.
  FloatImage likeness(400, 400, 1);
  SkinTexels texels(400, 400);
  for (int y = 0; y < 400; ++y) {
    for (int x = 0; x < 400; ++x) {
      const std::size_t i = likeness.Index(x, y);
      texels.at[i].above_brows_mm = static_cast<float>(250 - y) / 5;
      const bool dark = (y > 60 && y < 120) || y == 180 || (y > 255 && y < 270);
      if (dark) likeness.at[i] = 0;
    }
  }
  CutAtHairline(texels, likeness);
  const auto at = [&](int y) { return likeness(200, y); };
  EXPECT_LT(at(30), 0.05F) << "bright strands";
  EXPECT_EQ(at(90), 0) << "dark ones";
  EXPECT_GT(at(150), 0.95F) << "the forehead above its line";
  EXPECT_GT(at(220), 0.95F);
  EXPECT_EQ(at(262), 0) << "the brows";
  EXPECT_EQ(at(330), 1);
}

TEST(SkinColoursTest, LinesMakeASkinRoughAndShadeDoesNot) {
  const auto rough = [](auto brightness, float seen) {
    return Roughness(Drawn(512, brightness), FloatImage(512, 512, seen));
  };
  const auto lined = [](glm::vec2 p) { return 160 + 14 * std::sin(p.y * 0.8F); };
  EXPECT_LT(rough([](glm::vec2 p) { return 110 + 0.2F * p.x; }, 1), 0.006F);
  EXPECT_GT(rough(lined, 1), 0.03F);
  EXPECT_EQ(rough(lined, 0), 0) << "no face was seen";
}

TEST(SmileFoldsTest, ADarkFoldIsFilledAndABeardIsNot) {
  FoundFace face;
  face.points.assign(kNetworkPoints, glm::vec3(0));
  float y = 60;
  for (const auto& [right, left] :
       {std::pair(129, 358), {203, 423}, {206, 426}, {216, 436}, {212, 432}}) {
    face.points[static_cast<std::size_t>(right)] = glm::vec3(60, y, 0);
    face.points[static_cast<std::size_t>(left)] = glm::vec3(140, y, 0);
    y += 20;
  }
  const fsm::Image before = Drawn(200, [](glm::vec2 p) {
    if (p.x > 120) return p.y > 100 ? 60 : 160;  // a beard over half of the left fold
    return p.y > 50 && std::abs(p.x - 60) < 3 ? 80 : 160;
  });
  const auto lit = [&face, &before](float smile, int x, int row) {
    fsm::Image photo = before;
    FillSmileFolds(face, smile, 2, photo);
    return static_cast<int>(photo.rgba[static_cast<std::size_t>(4 * (200 * row + x))]);
  };
  EXPECT_EQ(lit(0, 60, 100), 80) << "of a face at rest they are its own";
  EXPECT_NEAR(lit(1, 60, 100), 160, 8);
  EXPECT_NEAR(lit(0.5F, 60, 100), 120, 6);
  EXPECT_EQ(lit(1, 140, 125), 60);
  EXPECT_EQ(lit(1, 20, 100), 160);
}

TEST(GlassesTest, ABarAcrossTheNoseIsSeenAndAFoldIsNot) {
  FoundFace face;
  face.points.assign(kNetworkPoints, glm::vec3(0));
  face.points[133] = glm::vec3(136, 200, 0);  // inner corners, two pixels to the millimetre
  face.points[362] = glm::vec3(200, 200, 0);
  // A nose that grows darker downwards.
  const auto nose = [](glm::vec2 p) { return 170 - 0.15F * (p.y - 150); };
  const auto seen = [&](auto drawn) { return BridgeContrast(face, Drawn(336, drawn)); };
  EXPECT_LT(seen(nose), 0.03F);
  EXPECT_GT(seen([&](glm::vec2 p) { return p.y > 196 && p.y < 204 ? 60 : nose(p); }),
            kGlassesContrast);
  EXPECT_GT(seen([&](glm::vec2 p) { return p.y > 192 && p.y < 204 ? 230 : nose(p); }),
            kGlassesContrast)
      << "of clear plastic";
  EXPECT_LT(seen([&](glm::vec2 p) { return p.y > 199.5F && p.y < 200.5F ? 120 : nose(p); }),
            kGlassesContrast)
      << "a fold is thin";
  EXPECT_LT(seen([&](glm::vec2 p) { return p.y < 185 ? 50 : nose(p); }), kGlassesContrast)
      << "brows that meet have forehead above them, but farther away";
  EXPECT_LT(seen([&](glm::vec2 p) { return p.y > 196 && p.y < 204 && p.x < 165 ? 60 : nose(p); }),
            kGlassesContrast)
      << "it has to go across";
  EXPECT_LT(seen([&](glm::vec2 p) {
              return p.y > 196 && p.y < 202 && std::abs(p.x - 168) < 10.5F ? 60 : nose(p);
            }),
            kGlassesContrast)
      << "a crease of the brow is deep but short";
}

/// An open eye from x = 60 to 140 about y = 96, its lids 16 pixels apart; the outer corner at the
/// left, or at the right.
OpenEye EyeAcross(bool mirrored) {
  OpenEye eye{.lids = {}, .middle = {100, 97}, .expected = 15};
  for (std::size_t k = 0; k < eye.lids.size(); ++k) {
    const float part = static_cast<float>(k <= 8 ? k : 16 - k) / 8;
    const float open = k % 8 == 0 ? 0.0F : k < 8 ? -8.0F : 8.0F;
    eye.lids[k] = {mirrored ? 140 - 80 * part : 60 + 80 * part, 96 + open};
  }
  return eye;
}

TEST(IrisTest, IsFoundBetweenLidsThatHideHalfOfIt) {
  constexpr glm::vec2 kCentre(98, 94);
  const fsm::Image photo = Drawn(200, [&](glm::vec2 p) {
    if (p.y < 88 || p.y > 104) return 120;  // lids
    return glm::distance(p, kCentre) < 13 ? 60 : 200;
  });
  for (const bool mirrored : {false, true}) {
    const OpenEye eye = EyeAcross(mirrored);
    const IrisCircle ring = FindIrises(photo, std::span(&eye, 1)).at(0);
    EXPECT_GT(ring.contrast, kClearIris);
    EXPECT_LT(glm::distance(ring.centre, kCentre), 3.5F);
    EXPECT_NEAR(ring.radius, 13, 1.6F);
  }
}

TEST(IrisTest, IsFoundBesideACornerInDeepShade) {
  constexpr glm::vec2 kCentre(106, 97);
  const fsm::Image photo = Drawn(200, [&](glm::vec2 p) {
    if (p.y < 88 || p.y > 104) return 120;
    const float far = glm::distance(p, kCentre);
    // An iris that is hardly darker than the shade, round its pupil.
    return far < 5 ? 15 : far < 12 ? 70 : p.x < 88 ? 85 : 180;
  });
  const OpenEye eye = EyeAcross(false);
  const IrisCircle ring = FindIrises(photo, std::span(&eye, 1)).at(0);
  EXPECT_LT(glm::distance(ring.centre, kCentre), 3.5F) << ring.centre.x;
}

TEST(IrisTest, IsWhereItIsDarkWithinNotBetweenTheShadowsOfTwoLashes) {
  // Beside the iris two dark lines as far apart as one is wide, whose outer sides are the clearest
  // steps there are. It is pale with a dark pupil, or dark throughout.
  constexpr glm::vec2 kCentre(108, 97);
  for (const auto& [pupil, pale] : {std::pair(15, 110), {95, 95}}) {
    const fsm::Image photo = Drawn(200, [&](glm::vec2 p) {
      if (p.y < 88 || p.y > 104) return 120;
      const float far = glm::distance(p, kCentre);
      if (far < 13) return far < 5 ? pupil : pale;
      return std::abs(std::abs(p.x - 82) - 11) < 1.6F ? 70 : 170;
    });
    const OpenEye eye = EyeAcross(false);
    const IrisCircle ring = FindIrises(photo, std::span(&eye, 1)).at(0);
    EXPECT_LT(glm::distance(ring.centre, kCentre), 4) << pupil << ": " << ring.centre.x;
  }
}

TEST(IrisTest, IsNotImaginedInAnEvenPatch) {
  const fsm::Image photo = Drawn(200, [](glm::vec2) { return 90; });
  const OpenEye eye = EyeAcross(false);
  EXPECT_LT(FindIrises(photo, std::span(&eye, 1)).at(0).contrast, kClearIris);
}

TEST(RedEyeTest, WhatAFlashThrowsBackIsDarkenedAndIrisesStay) {
  const RedEye eye({215, 190, 155}), warm({210, 140, 80});
  for (const glm::vec3 flash : {glm::vec3(225, 90, 90), {190, 60, 70}, {240, 130, 120}}) {
    const glm::vec3 pupil = eye.Without(flash, eye.Likelihood(flash));
    EXPECT_LT(pupil.r, 80) << flash.r;
    EXPECT_NEAR(pupil.r, pupil.g, 12) << flash.r;
  }
  // Brown in daylight and in weak warm light, amber, blue, a dark pupil, a white reflection.
  for (const glm::vec3 iris : {glm::vec3(110, 70, 40),
                               {70, 45, 35},
                               {150, 100, 45},
                               {90, 120, 160},
                               {25, 18, 16},
                               {250, 245, 240}}) {
    EXPECT_LT(eye.Likelihood(iris), 0.05F) << iris.r;
  }
  EXPECT_LT(warm.Likelihood({90, 45, 15}), 0.05F);
  // Where red has run over the edge it is taken away, too, but nothing else beside it.
  EXPECT_LT(eye.Without({110, 70, 65}, 1).r, 60);
  EXPECT_EQ(eye.Without({200, 195, 185}, 1), glm::vec3(200, 195, 185));
}

TEST(EyePicturesTest, ShowTheWholeIrisAndTheWhiteWithoutIt) {
  // The built-in head as it would be seen by a camera of four pixels to the millimetre, whose eyes
  // look at it and are half hidden by their upper lids.
  BaseHead base;
  base.head = fsm::MakeHead("galatea");
  base.head->Evaluate({}, base.rest);
  base.points.resize(kNetworkPoints);
  FoundFace face;
  face.points.assign(kNetworkPoints, glm::vec3(0));
  Fit fit;
  fit.head.base = &base;
  std::vector<glm::vec2> centres;
  for (const fsm::Side side : fsm::kSides) {
    const glm::vec3 ball = base.head->topology().eyes[side].centre;
    const glm::vec2 centre(500 + 4 * ball.x, 300 - 4 * ball.y);
    centres.push_back(centre);
    fit.irises.circles[side] = {.centre = centre, .radius = 24, .contrast = 0.4F};
    for (std::size_t i = 0; i < 16; ++i) {
      const auto point = EyeOutline(side)[i];
      const float part = static_cast<float>(i <= 8 ? i : 16 - i) / 4 - 1;  // outer -1, inner 1
      const float x = (-13.0F * fsm::SignOf(side)) * part;
      const float open = i % 8 == 0 ? 0.0F : i < 8 ? 3.0F : -6.0F;
      face.points[point] = glm::vec3(centre + 4.0F * glm::vec2(x, -open), 0);
      // The nearest vertex of the skin stands for the place on the mesh.
      float nearest = 1e9F;
      for (std::uint32_t v = 0; v < base.rest.position.size(); ++v) {
        const glm::vec3 off = base.rest.position[v] - ball;
        const float far = glm::distance(glm::vec2(off), {x, open}) + (off.z < 4 ? 100.0F : 0.0F);
        if (far >= nearest) continue;
        nearest = far;
        base.points[point].corner = {v, v, v};
      }
    }
  }
  const fsm::Image photo = Drawn(1000, [&](glm::vec2 p) {
    for (const glm::vec2 centre : centres) {
      const glm::vec2 off = p - centre;
      if (std::abs(off.x) > 60 || off.y < -12 || off.y > 24) continue;
      return glm::length(off) < 24 ? 40 : 220;
    }
    return 130;
  });
  fsm::Image picture{.width = 1024, .height = 512, .rgba = {}};
  picture.rgba.assign(std::size_t{4} * 1024 * 512, 255);
  const auto both = PaintEyes(face, fit, {}, photo, picture);
  ASSERT_TRUE(both);
  for (const fsm::EyePicture& eye : both->InOrder()) {
    const auto shown = [&](const glm::vec4& square, glm::vec2 part) {
      const glm::vec2 at = glm::mix(glm::vec2(square.x, square.y), {square.z, square.w}, part);
      return ColourAt(picture, at * glm::vec2(1024, 512)).g;
    };
    EXPECT_NEAR(shown(eye.iris, {0.5F, 0.5F}), 40, 3);
    EXPECT_NEAR(shown(eye.iris, {0.5F, 0.15F}), 40, 12) << "what the lid hides is completed";
    EXPECT_NEAR(shown(eye.iris, {0.02F, 0.6F}), 220, 12) << "beside it is the white";
    EXPECT_NEAR(shown(eye.ball, {0.5F, 0.5F}), 220, 12) << "no iris is left in the white";
    EXPECT_NEAR(shown(eye.ball, {0.2F, 0.55F}), 220, 12);
  }
  // Nothing of the face is painted there.
  const auto& uv = base.head->topology().uv;
  for (std::size_t v = 0; v < uv.size(); ++v) {
    if (base.rest.position[v].y < -90 || base.rest.position[v].z < 0) continue;
    EXPECT_GT(uv[v].y, 0.14F);
  }
  // Hair before one eye: the other stands in for it, but not if that is hardly open.
  fsm::Image hidden = photo;
  for (int y = 200; y < 400; ++y) {
    const auto row = hidden.rgba.begin() + 4 * (y * 1000 + 500);
    std::fill(row, row + 4 * 500, std::uint8_t{130});
  }
  fit.irises.circles.left.contrast = 0.01F;
  const auto one_hidden = PaintEyes(face, fit, {}, hidden, picture);
  ASSERT_TRUE(one_hidden);
  const auto& [right, left] = *one_hidden;
  for (const glm::vec2 part : {glm::vec2(0.5F, 0.5F), {0.02F, 0.6F}, {0.2F, 0.8F}}) {
    const auto at = [&](const glm::vec4& square, glm::vec2 p) {
      return ColourAt(picture, glm::mix(glm::vec2(square.x, square.y), {square.z, square.w}, p) *
                                   glm::vec2(1024, 512))
          .g;
    };
    EXPECT_NEAR(at(left.iris, part), at(right.iris, {1 - part.x, part.y}), 2) << part.x;
    EXPECT_NEAR(at(left.ball, part), at(right.ball, {1 - part.x, part.y}), 2) << part.x;
  }
  fit.irises.circles.right.contrast = 0.08F;
  EXPECT_FALSE(PaintEyes(face, fit, {}, hidden, picture))
      << "eyes that are not seen clearly are drawn";
}

}  // namespace
}  // namespace facefit
