// How parts of heads from elsewhere take light: what files say of it, and what is seen.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <vector>

#include "fsm/image/image_codec.h"
#include "fsm/mesh/gltf/gltf_head.h"
#include "fsm/mesh/imported_head.h"
#include "fsm/mesh/rig_unrigged_head.h"
#include "fsm/mesh/texture_atlas.h"
#include "fsm/render/renderer.h"
#include "tests/fsm/gltf_maker.h"

namespace fsm {
namespace {

std::string Written(int n) { return std::to_string(n); }

/// A triangle of one material; `more`: further members of the file.
ImportedHead Read(GltfMaker& maker, const std::string& material, const std::string& more = "") {
  const int place = maker.Places({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int uv = maker.Floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
  auto file = ParseGltfHead(
      "a.gltf", maker.File(R"("nodes":[{"mesh":0}],"materials":[)" + material +
                           R"(],"meshes":[{"primitives":[{"material":0,"attributes":{"POSITION":)" +
                           Written(place) + R"(,"TEXCOORD_0":)" + Written(uv) + "}}]}]" + more));
  EXPECT_TRUE(file) << file.error().text;
  return file ? std::move(*file) : ImportedHead{};
}

PbrMaterial MaterialOf(const std::string& material, const std::string& more = "") {
  GltfMaker maker;
  const ImportedHead file = Read(maker, material, more);
  EXPECT_EQ(file.pbr_materials.size(), 1U);
  EXPECT_EQ(file.parts.at(0).pbr, 0);
  return file.pbr_materials.empty() ? PbrMaterial{} : file.pbr_materials[0];
}

TEST(GltfMaterialTest, MetalAndRoughnessAreReadAndAreWholeIfNothingIsSaid) {
  const PbrMaterial said = MaterialOf(
      R"({"pbrMetallicRoughness":{"metallicFactor":0.25,"roughnessFactor":0.5},"emissiveFactor":)"
      R"([0.1,0.2,0.3],"alphaMode":"MASK","extensions":{"KHR_materials_emissive_strength":)"
      R"({"emissiveStrength":2}}})");
  EXPECT_EQ(said.kind, PbrMaterial::Kind::kLit);
  EXPECT_FLOAT_EQ(said.metallic, 0.25F);
  EXPECT_FLOAT_EQ(said.roughness, 0.5F);
  EXPECT_FLOAT_EQ(said.emissive.b, 0.6F);
  EXPECT_TRUE(said.cut_out);
  const PbrMaterial silent = MaterialOf("{}");
  EXPECT_FLOAT_EQ(silent.metallic, 1);
  EXPECT_FLOAT_EQ(silent.roughness, 1);
}

TEST(GltfMaterialTest, UnlitStaysAsItIsButNotWhereItOnlyStandsInForMToon) {
  GltfMaker maker;
  const ImportedHead plain = Read(maker, R"({"extensions":{"KHR_materials_unlit":{}}})");
  EXPECT_TRUE(plain.pbr_materials.empty());
  EXPECT_EQ(plain.parts.at(0).pbr, -1);
  const PbrMaterial toon =
      MaterialOf(R"({"extensions":{"KHR_materials_unlit":{},)"
                 R"("VRMC_materials_mtoon":{"shadeColorFactor":[0.5,0.25,0.125],)"
                 R"("shadingToonyFactor":0.75,"shadingShiftFactor":-0.25}}})");
  EXPECT_EQ(toon.kind, PbrMaterial::Kind::kToon);
  EXPECT_FLOAT_EQ(toon.shade_colour.g, 0.25F);
  EXPECT_FLOAT_EQ(toon.shade_to, 0);
  EXPECT_FLOAT_EQ(toon.light_from, 0.5F);
}

TEST(GltfMaterialTest, OldAvatarsSayItInPropertiesOfTheShader) {
  const auto old = [](const char* shader) {
    return std::string(R"(,"extensions":{"VRM":{"materialProperties":[{"shader":")") + shader +
           R"(","floatProperties":{"_ShadeShift":-0.5,"_ShadeToony":0.8},)"
           R"("vectorProperties":{"_ShadeColor":[0.5,1,0,1]}}]}})";
  };
  const PbrMaterial toon = MaterialOf("{}", old("VRM/MToon"));
  EXPECT_EQ(toon.kind, PbrMaterial::Kind::kToon);
  EXPECT_NEAR(toon.shade_colour.r, 0.214F, 1e-3F) << "a colour of the screen";
  EXPECT_FLOAT_EQ(toon.shade_to, -0.5F);
  EXPECT_FLOAT_EQ(toon.light_from, -0.2F);
  GltfMaker maker;
  EXPECT_TRUE(Read(maker, "{}", old("VRM/UnlitTexture")).pbr_materials.empty());
}

TEST(GltfMaterialTest, PicturesOfLightArePutTogetherBesideTheColour) {
  GltfMaker maker;
  maker.Picture(EncodePng(Image{2, 1, {10, 20, 30, 255, 40, 50, 60, 255}}));  // colour
  maker.Picture(EncodePng(Image{1, 1, {228, 78, 255, 255}}));                 // normal
  maker.Picture(EncodePng(Image{1, 1, {100, 150, 200, 255}}));  // openness, roughness, metal
  const ImportedHead file =
      Read(maker,
           R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":)"
           R"({"index":2}},"normalTexture":{"index":1,"scale":0.5},"occlusionTexture":{"index":2,)"
           R"("strength":0.5}})");
  ASSERT_EQ(file.base_colours.size(), 1U);
  ASSERT_EQ(file.details.size(), 1U);
  EXPECT_EQ(file.details[0].normal_roughness_metal.rgba,
            (std::vector<std::uint8_t>{178, 103, 150, 200}));
  ASSERT_EQ(file.details[0].emission_openness.rgba.size(), 4U);
  EXPECT_EQ(file.details[0].emission_openness.rgba[3], 177) << "half as shut as the picture says";

  TextureAtlas sheet;
  sheet.Add(file.base_colours[0]);
  ASSERT_TRUE(sheet.Make());
  const auto normal_roughness_metal =
      sheet.MakeBeside({file.details[0].normal_roughness_metal}, {128, 128, 255, 255});
  ASSERT_TRUE(normal_roughness_metal);
  const glm::vec2 at = sheet.rect(0).At({0.5F, 0.5F}) *
                       glm::vec2(normal_roughness_metal->width, normal_roughness_metal->height);
  const auto texel = static_cast<std::size_t>(
      4 * (static_cast<int>(at.y) * normal_roughness_metal->width + static_cast<int>(at.x)));
  EXPECT_EQ(normal_roughness_metal->rgba[texel], 178);
  EXPECT_EQ(sheet.MakeBeside({Image{}}, {0, 0, 0, 0}), nullptr);
}

TEST(GltfMaterialTest, APictureThatLiesOtherwiseThanTheColourIsLeftOutWithANotice) {
  GltfMaker maker;
  maker.Picture(EncodePng(Image{1, 1, {10, 20, 30, 255}}));
  maker.Picture(EncodePng(Image{1, 1, {228, 78, 255, 255}}));
  const ImportedHead file =
      Read(maker, R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"normalTexture":)"
                  R"({"index":1,"texCoord":1}})");
  EXPECT_TRUE(file.details.empty());
  ASSERT_EQ(file.notices.size(), 1U);
  EXPECT_NE(file.notices[0].find("textures[1] is left out"), std::string::npos) << file.notices[0];
}

/// A plate of 100 mm before the face's middle, its picture grey; it faces the viewer, or away.
struct Plate {
  PbrMaterial pbr;
  bool two_sided = false, faces_away = false;
  std::vector<std::uint8_t> normal_roughness_metal = {}, emission_openness = {};  // one pixel
};

/// The colour on the screen in the middle of the plate. `front` light only comes from the viewer.
glm::vec3 Seen(const Plate& plate, float key_strength = 1, glm::vec3 key = {0, 0, 1}) {
  UnriggedHead model;
  for (const auto& [x, y] : {std::pair(-1.0F, -1.0F), {1, -1}, {1, 1}, {-1, 1}}) {
    model.Add({50 * x, 50 * y, 80}, Bone::kSkull, glm::vec3(1),
              glm::vec2(0.5F + 0.5F * x, 0.5F - 0.5F * y));
  }
  model.textures.base_colour = std::make_shared<Image>(Image{1, 1, {188, 188, 188, 255}});
  if (!plate.normal_roughness_metal.empty()) {
    model.textures.normal_roughness_metal =
        std::make_shared<Image>(Image{1, 1, plate.normal_roughness_metal});
  }
  if (!plate.emission_openness.empty()) {
    model.textures.emission_openness =
        std::make_shared<Image>(Image{1, 1, plate.emission_openness});
  }
  model.pbr_materials = {plate.pbr};
  auto& indices = model.mesh.BatchOf(Material::kSkin, 0, plate.two_sided).indices;
  indices = plate.faces_away ? std::vector<std::uint32_t>{0, 2, 1, 0, 3, 2}
                             : std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3};
  const auto head = RigUnriggedHead(std::move(model));
  HeadVertices vertices;
  head->Evaluate({}, vertices);
  constexpr int kSide = 64;
  const auto context = RenderContext::MakeHeadless(kSide, kSide);
  const auto renderer = Renderer::Make(*context);
  Scene scene;
  scene.background = glm::vec3(0, 0, 1);
  scene.key.direction = key;
  scene.key.strength = key_strength;
  scene.fill.strength = scene.rim.strength = 0;
  renderer->DrawVertices(*head, vertices, {}, scene);
  Image image;
  renderer->Read(image);
  // The middle of the plate lies a little above the middle of a portrait.
  const std::uint8_t* p = &image.rgba[4 * (26 * kSide + kSide / 2)];
  return {p[0], p[1], p[2]};
}

TEST(PbrMaterialTest, WhatIsLitDarkensWithTheLampsAndWhatGlowsDoesNot) {
  Plate plate{.pbr = {.metallic = 0, .roughness = 1}};
  const float bright = Seen(plate).g, dim = Seen(plate, 0).g;
  EXPECT_GT(bright, 1.6F * dim);
  EXPECT_GT(dim, 10) << "the room has some light";
  plate.pbr.emissive = glm::vec3(0.5F, 0, 0);
  const glm::vec3 glowing = Seen(plate, 0);
  EXPECT_GT(glowing.r, dim + 40);
  EXPECT_NEAR(glowing.g, dim, 2);
}

TEST(PbrMaterialTest, ARoughMetalMirrorsTheLampLessThanASmoothOne) {
  const float smooth = Seen({.pbr = {.metallic = 1, .roughness = 0.35F}}).g;
  const float rough = Seen({.pbr = {.metallic = 1, .roughness = 1}}).g;
  EXPECT_GT(smooth, rough + 30);
  // Roughness and metal may lie in a picture: blue is rough, alpha metal.
  EXPECT_NEAR(
      Seen({.pbr = {.metallic = 1, .roughness = 1}, .normal_roughness_metal = {128, 128, 89, 255}})
          .g,
      smooth, 3);
}

TEST(PbrMaterialTest, ANormalThatLeansToTheLampIsBrighter) {
  const glm::vec3 right{0.8F, 0, 0.6F}, up{0, 0.8F, 0.6F};
  const auto lit = [](std::vector<std::uint8_t> normal_roughness_metal, glm::vec3 key) {
    return Seen({.pbr = {.metallic = 0, .roughness = 1},
                 .normal_roughness_metal = std::move(normal_roughness_metal)},
                1, key)
        .g;
  };
  const float flat = lit({128, 128, 255, 255}, right);
  EXPECT_GT(lit({200, 128, 255, 255}, right), flat + 10) << "red is to the right of the picture";
  EXPECT_LT(lit({56, 128, 255, 255}, right), flat - 10);
  EXPECT_GT(lit({128, 200, 255, 255}, up), flat + 10) << "green is up";
  EXPECT_LT(lit({128, 56, 255, 255}, up), flat - 10);
}

TEST(PbrMaterialTest, OccludedPlacesGetLessOfTheRoomsLightAndAllOfTheLamps) {
  Plate plate{.pbr = {.metallic = 0, .roughness = 1}};
  const float open = Seen(plate, 0).g;
  plate.emission_openness = {255, 255, 255, 64};
  EXPECT_LT(Seen(plate, 0).g, 0.7F * open);
}

TEST(PbrMaterialTest, AToonHasTwoColoursWithAnEdgeBetween) {
  PbrMaterial toon{.kind = PbrMaterial::Kind::kToon, .shade_colour = {0.05F, 0.3F, 0.05F}};
  toon.shade_to = 0.4F;
  toon.light_from = 0.5F;
  const auto at = [&toon](float cosine) {
    return Seen({.pbr = toon}, 1, {std::sqrt(1 - cosine * cosine), 0, cosine});
  };
  const glm::vec3 light = at(0.9F), shade = at(0.2F);
  EXPECT_EQ(at(0.55F), light);
  EXPECT_EQ(at(0.35F), shade);
  EXPECT_NEAR(light.r, light.g, 1) << "the picture's grey";
  EXPECT_GT(shade.g, 2 * shade.r) << "the shade's green";
}

TEST(PbrMaterialTest, OfTwoSidesBothAreSeenAndLit) {
  const PbrMaterial matt{.metallic = 0, .roughness = 1};
  const glm::vec3 front = Seen({.pbr = matt});
  const glm::vec3 gone = Seen({.pbr = matt, .faces_away = true});
  EXPECT_LT(gone.r, 3) << "only the blue behind it";
  EXPECT_EQ(Seen({.pbr = matt, .two_sided = true, .faces_away = true}), front);
}

TEST(PbrMaterialTest, WhereATextureIsSewnTogetherTheNormalIsOne) {
  // A roof: its two slopes meet in doubled vertices.
  UnriggedHead model;
  for (const glm::vec3 p :
       {glm::vec3(-10, 0, 0), {0, 0, 5}, {0, 10, 5}, {0, 0, 5}, {10, 0, 0}, {0, 10, 5}}) {
    model.Add(p, Bone::kSkull, glm::vec3(1));
  }
  model.pbr_materials.emplace_back();
  model.mesh.BatchOf(Material::kSkin, 0, false).indices = {0, 1, 2, 3, 4, 5};
  const auto head = RigUnriggedHead(std::move(model));
  HeadVertices vertices;
  head->Evaluate({}, vertices);
  EXPECT_EQ(vertices.normal[1], vertices.normal[3]);
  EXPECT_NEAR(vertices.normal[2].x, 0, 1e-5F);
}

}  // namespace
}  // namespace fsm
