#include "fsm/head/photo_head.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <vector>

#include "fsm/head/make_head.h"
#include "fsm/head/warp.h"
#include "fsm/render/renderer.h"

namespace fsm {
namespace {

const std::vector<WarpPoint> kPoints = {{{0, 0, 0}, {1, 0, 0}},   {{50, 0, 0}, {0, 2, 0}},
                                        {{0, 50, 0}, {0, 0, 3}},  {{0, 0, 50}, {-1, 1, 0}},
                                        {{50, 50, 0}, {2, 0, 0}}, {{20, 30, 40}, {0, 0, -2}}};

TEST(WarpTest, GoesThroughItsPointsUnlessItSmooths) {
  const Warp exact(kPoints, 0);
  const Warp smooth(kPoints, 30);
  float off = 0;
  for (const auto& point : kPoints) {
    EXPECT_LT(glm::distance(exact.Motion(point.position), point.displacement), 1e-3F);
    off += glm::distance(smooth.Motion(point.position), point.displacement);
  }
  EXPECT_GT(off, 0.1F);
}

TEST(WarpTest, KeepsAnAffineMotionWhole) {
  std::vector<WarpPoint> points = kPoints;
  for (auto& p : points)
    p.displacement = glm::vec3(1 + 0.1F * p.position.x, 0.2F * p.position.y, -0.1F * p.position.z);
  const Warp warp(points, 2);
  EXPECT_LT(glm::distance(warp.Motion({100, -40, 10}), glm::vec3(11, -8, -1)), 1e-2F);
}

TEST(WarpTest, RefusesPointsOfOnePlane) {
  std::vector<WarpPoint> flat = kPoints;
  for (auto& p : flat) p.position.z = 0;
  EXPECT_THROW(Warp(flat, 0), std::runtime_error);
  EXPECT_THROW(Warp({}, 0), std::runtime_error);
}

TEST(PhotoHeadTest, ComesBackAsItWasWritten) {
  PhotoHead set;
  set.points = kPoints;
  set.smooth = 1.5F;
  for (int i = 0; i < 4; ++i)
    set.sheet.push_back(
        {glm::vec3(static_cast<float>(i)), glm::vec2(0.25F * static_cast<float>(i))});
  set.sheet_triangles = {0, 1, 2, 0, 2, 3};
  set.eyes.emplace();
  set.eyes->left = {.shift = {1, 2, -3}, .roll = 0.1F, .size = 1.1F, .upper_mm = -2, .lower_mm = 1};
  set.lip_colour = glm::vec3(0.2F, 0.1F, 0.05F);
  set.iris_size = 0.9F;
  set.glasses = true;
  set.lined = 0.4F;
  const EyePicture eye{{0.1F, 0.2F, 0.3F, 0.4F}, {0.5F, 0.25F, 1, 0.75F}};
  set.eye_pictures = {eye, eye};
  const PhotoHead back = ReadPhotoHead("face.txt", WritePhotoHead(set));
  ASSERT_TRUE(back.eyes && back.lip_colour);
  EXPECT_EQ(back.eyes->left.shift, set.eyes->left.shift);
  EXPECT_NEAR(back.eyes->left.roll, 0.1F, 1e-3F);
  EXPECT_EQ(back.eyes->left.upper_mm, -2);
  EXPECT_EQ(back.eyes->right.size, 1);
  EXPECT_EQ(*back.lip_colour, *set.lip_colour);
  EXPECT_NEAR(back.iris_size, 0.9F, 1e-3F);
  EXPECT_TRUE(back.glasses);
  EXPECT_NEAR(back.lined, 0.4F, 1e-3F);
  ASSERT_TRUE(back.eye_pictures);
  EXPECT_EQ(back.eye_pictures->left.iris, set.eye_pictures->left.iris);
  EXPECT_EQ(back.eye_pictures->right.ball, set.eye_pictures->right.ball);
  ASSERT_EQ(back.points.size(), set.points.size());
  EXPECT_EQ(back.points[5].displacement, set.points[5].displacement);
  EXPECT_EQ(back.smooth, set.smooth);
  EXPECT_EQ(back.sheet[3].texcoord, set.sheet[3].texcoord);
  EXPECT_EQ(back.sheet_triangles, set.sheet_triangles);
}

TEST(PhotoHeadTest, DamageIsReportedWithItsLine) {
  for (const char* text :
       {"smooth 1\nnose 3", "base galatea\nquad 0 1 2 3", "smooth 1\npoint 1 2",
        "smooth 1\niris nan 0 0", "smooth 1\neye middle 0 0 0 0 1 0 0",
        "smooth 1\neye left 0 0 0 0 9 0 0", "smooth 1\neye_picture up 0 0 1 1 0 0 1 1",
        "smooth 1\neye_picture left 0 0 1 1 0.5 0 0.4 1", "smooth 1\nvertex 1e9 0 0 0 0"}) {
    try {
      ReadPhotoHead("face.txt", text);
      ADD_FAILURE() << text;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("face.txt:2"), std::string::npos) << error.what();
    }
  }
}

TEST(PhotoHeadTest, EachEyeSitsAndOpensAsTheFaceSays) {
  PhotoHead set;
  set.points = kPoints;
  for (auto& point : set.points) point.displacement = glm::vec3(0);
  set.atlas = std::make_shared<Image>(Image{1, 1, {0, 0, 0, 255}});
  set.eyes.emplace();
  const auto plain = MakeHead(set);
  set.eyes->right.shift = {-2, 1, 0};
  set.eyes->left.upper_mm = -4;
  const auto own = MakeHead(set);
  EXPECT_LT(glm::distance(own->Landmark("pupil_right"),
                          plain->Landmark("pupil_right") + glm::vec3(-2, 1, 0)),
            0.01F);
  EXPECT_EQ(own->Landmark("pupil_left"), plain->Landmark("pupil_left"));
  // The rim of the left upper lid hangs lower, the right one has gone with its eye.
  const auto rim = [](const Head& head, float side) {
    HeadVertices vertices;
    head.Evaluate({}, vertices);
    float lowest = 1e9F;
    const glm::vec3 eye = head.EyeCentre(side > 0 ? Side::kLeft : Side::kRight);
    for (const auto& part : head.surface().parts) {
      if (part.material != Material::kSkin) continue;
      for (std::uint32_t k = 0; k < part.index_count; ++k) {
        const glm::vec3 p = vertices.position[head.surface().indices[part.first_index + k]];
        const glm::vec3 d = p - eye;
        if (std::abs(d.x) < 3 && d.y > -1 && d.z > 9) lowest = std::min(lowest, p.y);
      }
    }
    return lowest;
  };
  EXPECT_NEAR(rim(*own, 1), rim(*plain, 1) - 4, 1.2F);
  EXPECT_NEAR(rim(*own, -1), rim(*plain, -1) + 1, 0.3F);
}

TEST(PhotoHeadTest, LidsGiveUpThePhotoAsTheyShut) {
  PhotoHead set;
  set.points = kPoints;
  for (auto& point : set.points) point.displacement = glm::vec3(0);
  set.atlas = std::make_shared<Image>(Image{1, 1, {200, 150, 100, 255}});
  const auto head = MakeHead(set);
  const auto& lids = head->surface().portrait.shut_lids;
  EXPECT_GT(std::ranges::count_if(lids, [](const ShutLid& lid) { return lid.weight > 0.7F; }), 40);
  EXPECT_EQ(std::ranges::count_if(lids, [](const ShutLid& lid) { return lid.weight > 1; }), 0);
  FaceState state;
  state.au.left[45] = 1;
  HeadVertices vertices;
  head->Evaluate(state, vertices);
  EXPECT_EQ(vertices.lids_shut.right, 0);
  EXPECT_EQ(vertices.lids_shut.left, 1);
}

/// The most any pixel of the open mouth differs from grey, of 255.
int ColourOfTheMouth(float saturation) {
  PhotoHead set;
  set.points = kPoints;
  for (auto& point : set.points) point.displacement = glm::vec3(0);
  set.atlas = std::make_shared<Image>(Image{1, 1, {0, 0, 0, 255}});
  set.saturation = saturation;
  const auto head = MakeHead(set);
  FaceState state;
  state.au.right[26] = state.au.left[26] = 0.8F;
  state.au.right[25] = state.au.left[25] = 0.6F;
  HeadVertices vertices;
  head->Evaluate(state, vertices);
  const auto context = RenderContext::MakeHeadless(240, 240);
  const auto renderer = Renderer::Make(*context);
  renderer->DrawVertices(*head, vertices, state.figure, Scene{});
  Image image;
  renderer->Read(image);
  int most = 0, brightest = 0;
  for (int y = 130; y < 176; ++y) {
    for (int x = 105; x < 135; ++x) {
      const std::uint8_t* pixel = &image.rgba[static_cast<std::size_t>(y * 240 + x) * 4];
      const auto [low, high] = std::minmax({pixel[0], pixel[1], pixel[2]});
      most = std::max(most, high - low);
      brightest = std::max<int>(brightest, high);
    }
  }
  EXPECT_GT(brightest, 60) << "teeth are seen";
  return most;
}

/// The row of upper teeth: x of the middle incisors, how far the left side stands before the right.
std::pair<float, float> UpperTeethOf(const fsm::PhotoHead& set) {
  const auto head = fsm::MakeHead(set);
  fsm::HeadVertices rest;
  head->Evaluate({}, rest);
  const auto& surface = head->surface();
  const glm::vec3 incisor = rest.position[head->mouth().incisors->upper];
  glm::vec2 z(0), count(0);
  for (const auto& part : surface.parts) {
    if (part.material != fsm::Material::kTeeth) continue;
    for (std::uint32_t k = part.first_index; k < part.first_index + part.index_count; ++k) {
      const glm::vec3 p = rest.position[surface.indices[k]];
      const float side = p.x - incisor.x;
      if (p.y < incisor.y || std::abs(side) < 8 || std::abs(side) > 20) continue;
      z[side > 0] += p.z;
      count[side > 0] += 1;
    }
  }
  z /= count;
  return {incisor.x, z[1] - z[0]};
}

TEST(PhotoHeadTest, TeethGoWithAMouthThatLiesAsideAndLooksToASide) {
  fsm::PhotoHead set;
  set.atlas = std::make_shared<fsm::Image>(fsm::Image{1, 1, {200, 150, 130, 255}});
  for (const glm::vec3 at : {glm::vec3(-70, 0, 0), glm::vec3(70, 0, 0), glm::vec3(0, 80, 60),
                             glm::vec3(0, -110, 40), glm::vec3(0, 20, -60)}) {
    set.points.push_back({at, glm::vec3(0)});
  }
  const auto straight = UpperTeethOf(set);
  for (const float side : {-1.0F, 1.0F}) {
    set.points.push_back({glm::vec3(25 * side, -42, 70), glm::vec3(4, 0, 4 * side)});
  }
  const auto aside = UpperTeethOf(set);
  EXPECT_NEAR(aside.first - straight.first, 4, 1);
  EXPECT_NEAR(aside.second - straight.second, 4.5F, 1.5F);
}

TEST(PhotoHeadTest, ASmoothSkinCreasesLess) {
  const auto depth = [](float lined) {
    PhotoHead set;
    set.points = kPoints;
    set.lined = lined;
    set.atlas = std::make_shared<Image>(Image{1, 1, {200, 150, 130, 255}});
    FaceState surprise;
    for (const std::size_t unit : {1U, 2U}) surprise.au.left[unit] = surprise.au.right[unit] = 1;
    HeadVertices v;
    MakeHead(set)->Evaluate(surprise, v);
    return v.creases[0].right;
  };
  EXPECT_GT(depth(1), 0.5F);
  EXPECT_NEAR(depth(0.3F), 0.3F * depth(1), 1e-3F);
}

TEST(PhotoHeadTest, AGreyPhotoHasAGreyMouth) {
  EXPECT_LE(ColourOfTheMouth(0), 1);
  EXPECT_GT(ColourOfTheMouth(1), 20);
}

TEST(PhotoHeadTest, TheSkinBehindGlassesStaysWhenBrowsAndCheeksMove) {
  PhotoHead set;
  set.points = kPoints;
  for (auto& point : set.points) point.displacement = glm::vec3(0);
  set.atlas = std::make_shared<Image>(Image{1, 1, {0, 0, 0, 255}});
  const auto moved = [&set](glm::vec2 from_eye) {
    const auto head = MakeHead(set);
    HeadVertices rest, frown;
    head->Evaluate({}, rest);
    FaceState state;
    for (const std::size_t unit : {std::size_t{4}, std::size_t{6}}) {
      state.au.left[unit] = state.au.right[unit] = 1;
    }
    head->Evaluate(state, frown);
    const glm::vec3 eye = head->EyeCentre(Side::kLeft);
    float nearest = 1e9F, way = 0;
    for (std::size_t i = 0; i < rest.position.size(); ++i) {
      const glm::vec3 off = rest.position[i] - eye;
      const float far = glm::distance(glm::vec2(off), from_eye) + (off.z < 0 ? 100.0F : 0.0F);
      if (far >= nearest) continue;
      nearest = far;
      way = glm::distance(rest.position[i], frown.position[i]);
    }
    return way;
  };
  constexpr glm::vec2 kUnderRim(-14, 12), kBrow(-12, 26);
  EXPECT_GT(moved(kUnderRim), 0.8F);
  const float brow = moved(kBrow);
  set.glasses = true;
  EXPECT_LT(moved(kUnderRim), 0.2F);
  EXPECT_GT(moved(kBrow), 0.5F * brow);
}

TEST(PhotoHeadTest, AnEyeOfThePhotoIsSeenAndItsIrisGoesWithTheGaze) {
  // Green irises in blue balls, on red skin.
  constexpr int kSide = 64;
  Image photo{kSide, kSide, {}};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const bool iris = y < kSide / 4, ball = !iris && y < kSide / 2;
      for (const int value : {iris || ball ? 0 : 200, iris ? 200 : 0, ball ? 200 : 0, 255}) {
        photo.rgba.push_back(static_cast<std::uint8_t>(value));
      }
    }
  }
  PhotoHead set;
  set.points = kPoints;
  for (auto& point : set.points) point.displacement = glm::vec3(0);
  set.atlas = std::make_shared<Image>(photo);
  set.skin_low = {0.1F, 0.9F};
  set.skin_high = {0.9F, 0.6F};
  const EyePicture eye{{0.1F, 0.05F, 0.9F, 0.2F}, {0.1F, 0.3F, 0.9F, 0.45F}};
  set.eye_pictures = {eye, eye};
  const auto head = MakeHead(set);
  const auto context = RenderContext::MakeHeadless(400, 400);
  const auto renderer = Renderer::Make(*context);
  // Sums over the image of x where green, and of how much is green and blue.
  struct Seen {
    double green = 0, blue = 0, green_x = 0;
  };
  const auto look = [&](float turn) {
    FaceState state;
    state.gaze.left[kToRight] = state.gaze.right[kToRight] = turn;
    HeadVertices vertices;
    head->Evaluate(state, vertices);
    Image image;
    renderer->DrawVertices(*head, vertices, state.figure, {});
    renderer->Read(image);
    Seen seen;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      const int r = image.rgba[i], g = image.rgba[i + 1], b = image.rgba[i + 2];
      if (g > 120 && r < 60 && b < 60) {
        seen.green += 1;
        seen.green_x += static_cast<double>(i / 4 % 400);
      }
      seen.blue += b > 120 && r < 60 && g < 60;
    }
    return seen;
  };
  const Seen ahead = look(0);
  EXPECT_GT(ahead.green, 30);
  EXPECT_GT(ahead.blue, 30);
  const Seen aside = look(20);
  ASSERT_GT(aside.green, 20);
  EXPECT_GT(std::abs(aside.green_x / aside.green - ahead.green_x / ahead.green), 2);
}

}  // namespace
}  // namespace fsm
