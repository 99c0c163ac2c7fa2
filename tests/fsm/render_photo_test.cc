// A head that wears a photo: the sheet of hair and clothes, and the skin that fades into it.

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "fsm/head/make_head.h"
#include "fsm/head/photo_head.h"
#include "fsm/render/camera.h"
#include "tests/fsm/render_support.h"

namespace fsm {
namespace {

constexpr int kSide = 400;
constexpr glm::vec3 kSkin(200, 40, 40), kHair(40, 200, 40);

/// A face of `kSkin`, and a sheet of `kHair` of some opacity across it.
PhotoHead RedFaceAndGreenSheet(int opacity, std::initializer_list<float> depths) {
  PhotoHead set;
  for (const glm::vec3 at : {glm::vec3(0), {50, 0, 0}, {0, 50, 0}, {0, 0, 50}, {50, 50, 20}}) {
    set.points.push_back({at, glm::vec3(0)});
  }
  Image photo{2, 1, {}};
  for (const auto& [colour, a] : {std::pair(kSkin, 255), std::pair(kHair, opacity)}) {
    for (int c = 0; c < 3; ++c) photo.rgba.push_back(static_cast<std::uint8_t>(colour[c]));
    photo.rgba.push_back(static_cast<std::uint8_t>(a));
  }
  set.atlas = std::make_shared<Image>(photo);
  set.skin_low = {0.24F, 0.9F};
  set.skin_high = {0.26F, 0.1F};
  for (const float z : depths) {
    const auto first = static_cast<std::uint32_t>(set.sheet.size());
    for (const glm::vec2 p : {glm::vec2(-90, 120), {-90, -60}, {90, -60}, {90, 120}}) {
      set.sheet.push_back({{p, z}, {0.75F, 0.5F}});
    }
    for (const std::uint32_t k : {0U, 1U, 2U, 0U, 2U, 3U}) set.sheet_triangles.push_back(first + k);
  }
  return set;
}

/// Screen colours 0..255 at places of the head's frame, the mean of 3 x 3 pixels.
std::vector<glm::vec3> Drawn(const PhotoHead& set, const std::vector<glm::vec3>& places,
                             const FaceState& state = {}) {
  const auto head = MakeHead(set);
  HeadVertices vertices;
  head->Evaluate(state, vertices);
  Scene scene;
  scene.background = glm::vec3(0, 0, 1);
  const auto context = RenderContext::MakeHeadless(kSide, kSide);
  const auto renderer = Renderer::Make(*context);
  renderer->DrawVertices(*head, vertices, state.figure, scene);
  Image image;
  renderer->Read(image);
  const FrameCamera view = ViewOfPortrait(state.figure, scene.camera, kSide, kSide);
  std::vector<glm::vec3> seen;
  for (const glm::vec3 place : places) {
    const glm::vec4 clip = view.world_to_clip * view.figure_to_world * glm::vec4(place, 1);
    const int x = static_cast<int>((0.5F + 0.5F * clip.x / clip.w) * kSide);
    const int y = static_cast<int>((0.5F - 0.5F * clip.y / clip.w) * kSide);
    glm::vec3 sum(0);
    for (int k = 0; k < 9; ++k) {
      const auto i = static_cast<std::size_t>((y + k / 3 - 1) * kSide + x + k % 3 - 1) * 4;
      sum += glm::vec3(image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]);
    }
    seen.push_back(sum / 9.0F);
  }
  return seen;
}

TEST(PhotoTest, ASheetIsAsTransparentAsThePhotoSays) {
  const auto seen = Drawn(RedFaceAndGreenSheet(102, {60}), {{-75, 60, 60}});
  const glm::vec3 should = glm::mix(glm::vec3(0, 0, 255), kHair, 0.4F);
  EXPECT_LT(glm::distance(seen[0], should), 6) << seen[0].x << " " << seen[0].y << " " << seen[0].z;
}

TEST(PhotoTest, WhatLiesBehindASoftEdgeIsSeenThroughIt) {
  // Two sheets, the farther first, as face_fit writes them.
  const auto seen = Drawn(RedFaceAndGreenSheet(102, {20, 60}), {{-75, 60, 60}});
  const glm::vec3 should = glm::mix(glm::vec3(0, 0, 255), kHair, 1 - 0.6F * 0.6F);
  EXPECT_LT(glm::distance(seen[0], should), 6) << seen[0].x << " " << seen[0].y << " " << seen[0].z;
}

TEST(PhotoTest, LevelEdgesAreSoftAsThoseOfPhotos) {
  const PhotoHead set = RedFaceAndGreenSheet(255, {60});
  const auto head = MakeHead(set);
  HeadVertices vertices;
  head->Evaluate({}, vertices);
  Scene scene;
  scene.background = glm::vec3(0, 0, 1);
  for (const auto& [width, height] : {std::pair(401, 399), std::pair(400, 17), std::pair(1, 1)}) {
    const auto context = RenderContext::MakeHeadless(width, height);
    const auto renderer = Renderer::Make(*context);
    renderer->DrawVertices(*head, vertices, {}, scene);
    Image image;
    renderer->Read(image);
    if (height < 100) continue;  // that it is drawn at all
    // Down beside the head: background, the sheet's upper edge, the sheet.
    int between = 0, before = 0;
    for (int y = 0; y < height / 2; ++y) {
      const auto i = static_cast<std::size_t>(y * width + width / 4) * 4;
      const int green = image.rgba[i + 1];
      EXPECT_GE(green, before);
      between += green > 10 && green < 190;
      before = green;
    }
    EXPECT_GT(before, 195);
    EXPECT_GE(between, 2);
  }
}

TEST(PhotoTest, SkinIsSeenWhereTheSheetComesNearlyAsFar) {
  const auto base = MakeHead("galatea");
  const glm::vec3 nasion = base->Landmark("nasion");
  const glm::vec3 forehead = nasion + glm::vec3(0, 30, 0);
  HeadVertices rest;
  base->Evaluate({}, rest);
  float z = -1e9F;
  for (const glm::vec3 p : rest.position) {
    if (glm::distance(glm::vec2(p), glm::vec2(forehead)) < 5) z = std::max(z, p.z);
  }
  const glm::vec3 place(forehead.x, forehead.y, z);
  EXPECT_GT(Drawn(RedFaceAndGreenSheet(255, {z + 2}), {place})[0].r, 150);
  EXPECT_LT(Drawn(RedFaceAndGreenSheet(255, {z + 20}), {place})[0].r, 60);
}

TEST(PhotoTest, HairBesideAnEyeDoesNotCreaseAndSkinDoes) {
  PhotoHead set = RedFaceAndGreenSheet(255, {});
  const glm::vec3 corner = MakeHead(set)->Landmark("exocanthion_left");
  constexpr int kRows = 9;
  std::vector<glm::vec3> places;
  for (int i = 0; i < kRows * kRows; ++i) {
    const glm::vec3 p = corner + glm::vec3(-4 + 3 * static_cast<float>(i % kRows),
                                           12 - 3 * static_cast<float>(i / kRows), 19);
    set.sheet.push_back({p, {0.75F, 0.5F}});
    if (i % kRows == 0 || i < kRows) continue;
    places.push_back(p + glm::vec3(-1.5F, 1.5F, 0));
    const auto v = static_cast<std::uint32_t>(i), above = v - kRows;
    for (const std::uint32_t k : {above - 1, v - 1, v, above - 1, v, above}) {
      set.sheet_triangles.push_back(k);
    }
  }
  FaceState smile;
  for (const std::size_t unit : {6U, 12U}) smile.au.left[unit] = smile.au.right[unit] = 1;
  const auto darkest = [&](const PhotoHead& s, float glm::vec3::*channel) {
    float least = 255;
    for (const glm::vec3 c : Drawn(s, places, smile)) least = std::min(least, c.*channel);
    return least;
  };
  EXPECT_GT(darkest(set, &glm::vec3::g), kHair.g - 14) << "hair";
  set.sheet_triangles.clear();
  EXPECT_LT(darkest(set, &glm::vec3::r), kSkin.r - 8) << "skin";
}

TEST(PhotoTest, LashesHangFromLidsThatShutAndOpenOnesHaveThePhotosOwn) {
  PhotoHead set = RedFaceAndGreenSheet(255, {});
  auto bright = std::make_shared<Image>(*set.atlas);
  std::ranges::fill(bright->rgba, std::uint8_t{230});
  set.atlas = bright;
  set.white_colour = glm::vec3(1);
  set.lined = 0;
  const auto head = MakeHead(set);
  const auto& topology = head->surface();
  const auto cover = [](const HeadSurface& t) {
    float sum = 0;
    for (const auto& part : t.parts) {
      if (part.material != Material::kShutLash) continue;
      for (std::uint32_t k = 0; k < part.index_count; ++k) {
        sum += t.opacity[t.indices[part.first_index + k]];
      }
    }
    return sum;
  };
  // How dark it is in the middle of hairs of either eye.
  const auto dark = [&](float blink, float side) {
    FaceState state;
    state.blink.left = state.blink.right = blink;
    HeadVertices vertices;
    head->Evaluate(state, vertices);
    std::vector<glm::vec3> places;
    for (const auto& part : topology.parts) {
      if (part.material != Material::kShutLash) continue;
      for (std::uint32_t k = part.first_index; k < part.first_index + part.index_count; ++k) {
        const std::uint32_t v = topology.indices[k];
        const glm::vec3 p = vertices.position[v];
        if (topology.opacity[v] > 0.5F && p.x * side > 0) places.push_back(p);
      }
    }
    float sum = 0;
    for (const glm::vec3 c : Drawn(set, places, state)) sum += 1 - c.g / 230;
    return sum / static_cast<float>(places.size());
  };
  for (const float side : {-1.0F, 1.0F}) {
    EXPECT_GT(dark(1, side), 0.25F);
    EXPECT_LT(dark(0, side), 0.05F);
  }
  set.lined = 1;
  EXPECT_LT(cover(MakeHead(set)->surface()), 0.6F * cover(topology)) << "old people's are thin";
}

TEST(PhotoTest, ShouldersFollowATurningHeadALittle) {
  PhotoHead set = RedFaceAndGreenSheet(255, {});
  const auto first = static_cast<std::uint32_t>(set.sheet.size());
  // A shoulder, and hair beside the face as far from the middle.
  for (const float y : {-220.0f, -219.0f, 0.0f}) set.sheet.push_back({{120, y, 0}, {0.75f, 0.5f}});
  set.sheet_triangles.insert(set.sheet_triangles.end(), {first, first + 1, first + 2});
  const auto head = MakeHead(set);
  FaceState turned;
  turned.head_rotation[1] = 20;
  HeadVertices rest, after;
  head->Evaluate({}, rest);
  head->Evaluate(turned, after);
  std::uint32_t shoulder = 0, hair = 0;
  for (const auto& part : head->surface().parts) {
    if (part.material != Material::kTextured) continue;
    const auto end = head->surface().indices.begin() + part.first_index + part.index_count;
    shoulder = end[-3];
    hair = end[-1];
  }
  const auto way = [&](std::uint32_t i) {
    return glm::distance(rest.position[i], after.position[i]);
  };
  EXPECT_GT(way(shoulder), 0.08f * way(hair));
  EXPECT_LT(way(shoulder), 0.3f * way(hair));
}

TEST(PhotoTest, TheNeckGoesWithTheJawAndClothesAndHairStay) {
  PhotoHead set = RedFaceAndGreenSheet(255, {});
  const glm::vec3 chin = MakeHead("galatea")->Landmark("gnathion");
  set.skin_bottom_y = chin.y - 8;
  struct At {
    glm::vec2 from_chin;
    float least, most;  // of the chin's way
  };
  constexpr At kPlaces[] = {{{0, 0}, 0.4F, 1},       {{0, -20}, 0.2F, 0.85F}, {{0, -75}, 0, 0.02F},
                            {{85, -5}, 0, 0.02F},    {{-85, 30}, 0, 0.02F},   {{0, 30}, 0, 0.02F},
                            {{-30, 8}, 0.4F, 1.05F}, {{78, 40}, 0, 0.02F}};
  for (const At& at : kPlaces) {
    const auto first = static_cast<std::uint32_t>(set.sheet.size());
    for (int k = 0; k < 3; ++k) {
      set.sheet.push_back({{chin.x + at.from_chin.x, chin.y + at.from_chin.y, 60}, {0.75F, 0.5F}});
    }
    set.sheet_triangles.insert(set.sheet_triangles.end(), {first, first + 1, first + 2});
  }
  const auto head = MakeHead(set);
  FaceState open;
  open.au.left[26] = open.au.right[26] = 1;
  HeadVertices rest, opened;
  head->Evaluate({}, rest);
  head->Evaluate(open, opened);
  float way = 0;
  std::uint32_t sheet = 0;
  for (const auto& part : head->surface().parts) {
    if (part.material == Material::kTextured) sheet = head->surface().indices[part.first_index];
  }
  for (std::size_t i = 0; i < sheet; ++i) {
    way = std::max(way, rest.position[i].y - opened.position[i].y);
  }
  EXPECT_GT(way, 8);
  for (std::size_t k = 0; k < std::size(kPlaces); ++k) {
    const std::size_t i = sheet + 3 * k;
    const float part = (rest.position[i].y - opened.position[i].y) / way;
    EXPECT_GE(part, kPlaces[k].least - 0.01F) << k;
    EXPECT_LE(part, kPlaces[k].most) << k;
  }
}

TEST(PhotoTest, WhatASmileTurnsIsLitAsItFacesThen) {
  PhotoHead set = RedFaceAndGreenSheet(255, {});
  // Skin lit from above, painted round its vertices.
  constexpr int kMap = 128, kRound = 4;
  Image lit{kMap, kMap, std::vector<std::uint8_t>(4 * kMap * kMap, 255)};
  set.skin_low = {0, 1};
  set.skin_high = {1, 0};
  const auto plain = MakeHead(set);
  HeadVertices bare;
  plain->Evaluate({}, bare);
  for (std::size_t i = 0; i < bare.position.size(); ++i) {
    const glm::vec2 place = plain->surface().textures.texcoord[i];
    const float light = std::max(0.4F + 0.5F * bare.normal[i].y, 0.05F);
    for (int k = 0; k < (2 * kRound + 1) * (2 * kRound + 1); ++k) {
      const int x = static_cast<int>(place.x * kMap) + k % (2 * kRound + 1) - kRound;
      const int y = static_cast<int>(place.y * kMap) + k / (2 * kRound + 1) - kRound;
      if (x < 0 || y < 0 || x >= kMap || y >= kMap) continue;
      std::fill_n(&lit.rgba[static_cast<std::size_t>(4 * (y * kMap + x))], 3,
                  static_cast<std::uint8_t>(255 * std::sqrt(light)));
    }
  }
  set.atlas = std::make_shared<Image>(lit);
  const auto head = MakeHead(set);
  const auto& topology = head->surface();
  EXPECT_GT(topology.portrait.light.y, 0.18F);
  FaceState smile;
  for (const std::size_t unit : {6U, 12U}) smile.au.left[unit] = smile.au.right[unit] = 1;
  HeadVertices rest, smiling;
  head->Evaluate({}, rest);
  for (std::size_t i = 0; i < topology.portrait.relit.size(); ++i) {
    for (const Side side : kSides) {
      const glm::vec2 eye(head->EyeCentre(side));
      if (glm::distance(glm::vec2(rest.position[i]), eye) > 10) continue;
      EXPECT_EQ(topology.portrait.relit[i], 0) << "round the eyes it stays";
    }
  }
  head->Evaluate(smile, smiling);
  const float nasion = head->Landmark("nasion").y, chin = head->Landmark("gnathion").y;
  // Of cheeks, by whether they turn up or down: how bright they become, the photo being the same.
  std::array<float, 2> change{};
  std::array<int, 2> count{};
  std::vector<glm::vec3> places, were;
  std::vector<std::size_t> turned;
  for (std::size_t i = 0; i < rest.position.size(); ++i) {
    const glm::vec3 p = rest.position[i];
    if (topology.textures.weight[i] != 1 || topology.portrait.relit[i] < 1) continue;
    const bool cheek = p.z > 50 && std::abs(p.x) > 18 && std::abs(p.x) < 45 && p.y < nasion - 25 &&
                       p.y > chin + 30;
    const float up = smiling.normal[i].y - rest.normal[i].y;
    if (!cheek || std::abs(up) < 0.1F || smiling.normal[i].z < 0.6F) continue;
    turned.push_back(up > 0 ? 0 : 1);
    were.push_back(p);
    places.push_back(smiling.position[i]);
  }
  const auto before = Drawn(set, were), after = Drawn(set, places, smile);
  for (std::size_t k = 0; k < places.size(); ++k) {
    change[turned[k]] += after[k].g / before[k].g - 1;
    ++count[turned[k]];
  }
  ASSERT_GT(std::min(count[0], count[1]), 8);
  const float up = change[0] / static_cast<float>(count[0]);
  const float down = change[1] / static_cast<float>(count[1]);
  EXPECT_GT(up - down, 0.05F) << up << " " << down;
}

TEST(PhotoTest, TheSkinFadesAtItsSidesAndEndsAtTheJaw) {
  const auto head = MakeHead(RedFaceAndGreenSheet(255, {-20}));
  const auto& topology = head->surface();
  HeadVertices rest;
  head->Evaluate({}, rest);
  const glm::vec3 chin = head->Landmark("gnathion");
  int fading = 0;
  for (const auto& part : topology.parts) {
    if (part.material != Material::kSkin) continue;
    for (std::uint32_t k = part.first_index; k < part.first_index + part.index_count; ++k) {
      const std::uint32_t v = topology.indices[k];
      const glm::vec3 p = rest.position[v];
      const float cover = topology.opacity[v];
      if (p.z > 60 && p.y > chin.y + 8) {
        EXPECT_EQ(cover, 1) << p.x << " " << p.y;
      }
      fading += cover > 0.1F && cover < 0.9F;
      // The neck, which faces the camera again behind the jaw.
      const bool neck = p.z < 20 && std::abs(p.x) > 42 && p.y < chin.y + 20;
      EXPECT_TRUE(!neck || cover == 0) << p.x << " " << p.y << " " << p.z << ": " << cover;
    }
  }
  EXPECT_GT(fading, 60);
}

}  // namespace
}  // namespace fsm
