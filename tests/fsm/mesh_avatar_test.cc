#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fsm/head/face_channels.h"
#include "fsm/head/make_head.h"
#include "fsm/image/image_codec.h"
#include "fsm/mesh/align_imported_head.h"
#include "fsm/mesh/gltf/gltf_head.h"
#include "fsm/mesh/imported_head.h"
#include "fsm/mesh/rig_unrigged_head.h"
#include "fsm/mesh/rigging/blendshape_rig.h"
#include "fsm/render/renderer.h"
#include "fsm/rig/pose.h"
#include "fsm/rig/simulation.h"
#include "tests/fsm/ball_head.h"
#include "tests/fsm/gltf_maker.h"

namespace fsm {
namespace {

const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

std::string Number(int n) { return std::to_string(n); }

void ExpectPlace(glm::vec3 is, glm::vec3 wanted) {
  EXPECT_LT(glm::distance(is, wanted), 1e-5F) << is.x << " " << is.y << " " << is.z;
}

ImportedHead Read(const std::string& json) {
  auto file = ParseGltfHead("a.gltf", json);
  EXPECT_TRUE(file) << file.error().text;
  return file ? std::move(*file) : ImportedHead{};
}

TEST(GltfPlaceTest, SkinnedMeshStandsWhereItsBonesHoldIt) {
  // Made ten times too large; the skeleton is scaled by a tenth and lies a metre up. The third
  // vertex is half of each bone, the place of its own node counts for nothing.
  GltfMaker maker;
  const int place = maker.Places({0, 0, 0, 10, 0, 0, 0, 10, 0});
  const int joints = maker.Bytes({0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0}, "VEC4", 4);
  const int weights = maker.Floats({1, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0}, "VEC4", 4);
  const int inverse = maker.Floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                    1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                                   "MAT4", 16);
  const ImportedHead file = Read(
      maker.File(R"("nodes":[{"scale":[0.1,0.1,0.1],"translation":[0,1,0],"children":[1,2]},{},)"
                 R"({"translation":[0,0,20]},{"mesh":0,"skin":0,"translation":[5,5,5]}],)"
                 R"("skins":[{"joints":[1,2],"inverseBindMatrices":)" +
                 Number(inverse) + R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":)" +
                 Number(place) + R"(,"JOINTS_0":)" + Number(joints) + R"(,"WEIGHTS_0":)" +
                 Number(weights) + "}}]}]"));
  ASSERT_EQ(file.position.size(), 3U);
  ExpectPlace(file.position[0], {0, 1, 0});
  ExpectPlace(file.position[1], {1, 1, 0});
  ExpectPlace(file.position[2], {0, 2, 1});
}

TEST(GltfPlaceTest, OnlyTheSceneIsShownAndMirroredPartsKeepTheirOutside) {
  GltfMaker maker;
  const int place = maker.Places(kTriangle);
  const std::string mesh =
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":)" + Number(place) + "}}]}]";
  const ImportedHead file = Read(maker.File(
      R"("scenes":[{"nodes":[1]}],"nodes":[{"mesh":0},{"mesh":0,"scale":[-1,1,1]}],)" + mesh));
  ASSERT_EQ(file.position.size(), 3U);
  const auto& t = file.parts.at(0).indices;
  const glm::vec3 outward = glm::cross(file.position[t[1]] - file.position[t[0]],
                                       file.position[t[2]] - file.position[t[0]]);
  EXPECT_GT(outward.z, 0);
}

TEST(GltfPlaceTest, ShapesOfShortsWithOneVertexNamedMoveThatVertex) {
  GltfMaker maker;
  const int place = maker.Shorts({0, 0, 0, 32767, 0, 0, 0, 32767, 0}, "VEC3", 3);
  const int by = maker.SparseShorts(3, 2, {0, -16384, 0});
  const ImportedHead file = Read(maker.File(
      R"("nodes":[{"mesh":0,"scale":[2,2,2]}],"meshes":[{"extras":{"targetNames":["jawOpen"]},)"
      R"("primitives":[{"attributes":{"POSITION":)" +
      Number(place) + R"(},"targets":[{"POSITION":)" + Number(by) + "}]}]}]"));
  ASSERT_EQ(file.shapes.size(), 1U);
  ASSERT_EQ(file.shapes[0].moves.size(), 1U);
  EXPECT_EQ(file.shapes[0].moves[0].vertex, 2U);
  EXPECT_NEAR(file.shapes[0].moves[0].offset.y, -1, 1e-3F);
  ExpectPlace(file.position[2], {0, 2, 0});
}

TEST(GltfPlaceTest, PrimitivesShareVerticesOnlyWhereAllAttributesAreTheSame) {
  GltfMaker maker;
  const std::string place = R"({"attributes":{"POSITION":)" + Number(maker.Places(kTriangle));
  const std::string red =
      place + R"(,"COLOR_0":)" + Number(maker.Places({1, 0, 0, 1, 0, 0, 1, 0, 0})) + "}}";
  const std::string green =
      place + R"(,"COLOR_0":)" + Number(maker.Places({0, 1, 0, 0, 1, 0, 0, 1, 0})) + "}}";
  const ImportedHead file = Read(maker.File(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[)" +
                                            red + "," + red + "," + green + "]}]"));
  ASSERT_EQ(file.parts.size(), 3U);
  EXPECT_EQ(file.parts[0].indices, file.parts[1].indices);
  ASSERT_EQ(file.vertex_colour.size(), 6U);
  EXPECT_EQ(file.vertex_colour[file.parts[0].indices[0]], glm::vec3(1, 0, 0));
  EXPECT_EQ(file.vertex_colour[file.parts[2].indices[0]], glm::vec3(0, 1, 0));
}

TEST(GltfPlaceTest, PackedGeometryIsRefusedByName) {
  for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
    const auto file = ParseGltfHead("a.glb", std::string(R"({"asset":{"version":"2.0"},)") +
                                                 R"("extensionsRequired":[")" + name + "\"]}");
    ASSERT_FALSE(file);
    EXPECT_NE(file.error().text.find(name), std::string::npos) << file.error().text;
    EXPECT_NE(file.error().text.find("uncompressed"), std::string::npos) << file.error().text;
  }
  // Draco beside a fallback that is not there.
  const auto file = ParseGltfHead(
      "a.gltf",
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"accessors":[{"componentType":5126,)"
      R"("count":3,"type":"VEC3"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},)"
      R"("extensions":{"KHR_draco_mesh_compression":{"bufferView":0}}}]}]})");
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().text.find("meshes[0]: its geometry"), std::string::npos);
}

/// Two pixels: light grey opaque, white half transparent.
std::vector<std::uint8_t> TwoPixels() {
  return EncodePng(Image{2, 1, {188, 188, 188, 255, 255, 255, 255, 100}});
}

ImportedHead Painted(const std::string& material) {
  GltfMaker maker;
  const int place = maker.Places(kTriangle);
  const int uv = maker.Floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
  maker.Picture(TwoPixels());
  return Read(maker.File(R"("nodes":[{"mesh":0}],"materials":[)" + material +
                         R"(],"meshes":[{"primitives":[{"material":0,"attributes":{"POSITION":)" +
                         Number(place) + R"(,"TEXCOORD_0":)" + Number(uv) + "}}]}]"));
}

TEST(GltfTexturesTest, FactorIsPaintedIntoThePictureAsLight) {
  // 188 is half of the light (sRGB); half of that is 137.
  const ImportedHead file = Painted(
      R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"baseColorFactor":[0.5,1,0,1]}})");
  ASSERT_EQ(file.base_colours.size(), 1U);
  EXPECT_NEAR(file.base_colours[0].rgba[0], 137, 1);
  EXPECT_EQ(file.base_colours[0].rgba[1], 188);
  EXPECT_EQ(file.base_colours[0].rgba[2], 0);
  EXPECT_EQ(file.base_colours[0].rgba[7], 255) << "opaque: its alpha means nothing";
  EXPECT_FALSE(file.parts[0].cut_out);
}

TEST(GltfTexturesTest, WhatIsBelowTheCutOffIsLeftOut) {
  const ImportedHead cut =
      Painted(R"({"alphaMode":"MASK","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})");
  EXPECT_EQ(cut.base_colours.at(0).rgba[3], 255);
  EXPECT_EQ(cut.base_colours.at(0).rgba[7], 0);
  EXPECT_TRUE(cut.parts[0].cut_out);
  const ImportedHead low = Painted(R"({"alphaMode":"MASK","alphaCutoff":0.3,)"
                                   R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})");
  EXPECT_EQ(low.base_colours.at(0).rgba[7], 255);
  const ImportedHead smooth =
      Painted(R"({"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})");
  EXPECT_EQ(smooth.base_colours.at(0).rgba[7], 100);
}

TEST(GltfTexturesTest, PicturesMayBeMovedScaledAndTurned) {
  const ImportedHead file =
      Painted(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":)"
              R"({"KHR_texture_transform":{"offset":[0.25,0.5],"scale":[0.5,0.25],)"
              R"("rotation":1.5707963}}}}})");
  // (1, 0) is scaled to (0.5, 0), turned to (0, -0.5) and moved.
  EXPECT_NEAR(file.texcoord.at(1).x, 0.25F, 1e-5F);
  EXPECT_NEAR(file.texcoord.at(1).y, 0, 1e-5F);
  EXPECT_NEAR(file.texcoord.at(2).x, 0.5F, 1e-5F);
}

TEST(GltfTexturesTest, CoordinatesThatATransformMakesInfiniteCountAsZero) {
  const ImportedHead file =
      Painted(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":)"
              R"({"KHR_texture_transform":{"offset":[3e38,0.5],"scale":[3e38,1]}}}}})");
  for (const glm::vec2 uv : file.texcoord) EXPECT_TRUE(std::isfinite(uv.x) && std::isfinite(uv.y));
}

TEST(GltfTexturesTest, PictureOfAnotherKindIsLeftOutWithANotice) {
  GltfMaker maker;
  const int place = maker.Places(kTriangle);
  maker.Picture({'R', 'I', 'F', 'F', 0, 0, 0, 0, 'W', 'E', 'B', 'P'});
  const ImportedHead file = Read(maker.File(
      R"("nodes":[{"mesh":0}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":)"
      R"({"index":0}}}],"meshes":[{"primitives":[{"material":0,"attributes":{"POSITION":)" +
      Number(place) + "}}]}]"));
  ASSERT_EQ(file.notices.size(), 1U);
  EXPECT_NE(file.notices[0].find("images[0] is left out"), std::string::npos) << file.notices[0];
  EXPECT_EQ(file.parts.at(0).base_colour, -1);
}

/// A mesh of two triangles, one of them an eye's, with four shapes; the extension is the caller's.
std::string Avatar(const std::string& extension) {
  GltfMaker maker;
  const int place = maker.Places(
      {0, 0, 0, 0.1F, 0, 0, 0, 0.1F, 0, 0.03F, 0, 0.1F, 0.04F, 0, 0.1F, 0.03F, 0.01F, 0.1F});
  const int joints = maker.Bytes(
      {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
  const int weights = maker.Floats(
      {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
  std::string targets;
  for (int t = 0; t < 4; ++t) {
    std::vector<float> by(18, 0);
    by[static_cast<std::size_t>(3 * t + 1)] = -0.01F;
    targets += std::string(t > 0 ? "," : "") + R"({"POSITION":)" + Number(maker.Places(by)) + "}";
  }
  // The skin says nothing of how it was bound: identity, so the bones' places add to the mesh.
  return maker.File(
      R"("nodes":[{"children":[1,2]},{"translation":[0,0,0]},{"translation":[0,0,0]},)"
      R"({"mesh":0,"skin":0,"name":"Face"}],"skins":[{"joints":[0,1,2]}],)"
      R"("meshes":[{"extras":{"targetNames":["t0","t1","t2","t3"]},"primitives":[{"attributes":)"
      R"({"POSITION":)" +
      Number(place) + R"(,"JOINTS_0":)" + Number(joints) + R"(,"WEIGHTS_0":)" + Number(weights) +
      R"(},"targets":[)" + targets + R"(]}]}],"extensions":{)" + extension + "}");
}

TEST(VrmTest, OldAvatarsAreTurnedToTheViewerWithBonesGazeAndExpressions) {
  const ImportedHead file = Read(Avatar(
      R"("VRM":{"humanoid":{"humanBones":[{"bone":"leftEye","node":1},{"bone":"rightEye","node":2}]},)"
      R"("firstPerson":{"lookAtTypeName":"Bone","lookAtHorizontalOuter":{"xRange":60,"yRange":12}},)"
      R"("blendShapeMaster":{"blendShapeGroups":[{"name":"A","presetName":"a","binds":)"
      R"([{"mesh":0,"index":0,"weight":50},{"mesh":0,"index":1,"weight":100}]},)"
      R"({"name":"Surprised","presetName":"unknown","binds":[{"mesh":0,"index":2,"weight":100}]}]}})"));
  ExpectPlace(file.position[1], {-0.1F, 0, 0});
  ExpectPlace(file.position[3], {-0.03F, 0, -0.1F});
  ASSERT_EQ(file.eye.size(), 6U);
  EXPECT_EQ(file.eye[2], std::nullopt);
  EXPECT_EQ(file.eye[4], Side::kLeft);
  ASSERT_TRUE(file.eye_rig.pivot);
  ASSERT_TRUE(file.eye_rig.gaze_ranges);
  EXPECT_EQ(file.eye_rig.gaze_ranges->outer.gaze_deg, 60);
  EXPECT_EQ(file.eye_rig.gaze_ranges->outer.output, 12);
  EXPECT_FALSE(file.gaze_by_shape);
  ASSERT_EQ(file.shapes.size(), 6U);
  EXPECT_EQ(file.shapes[4].name, "vrma");
  ASSERT_EQ(file.shapes[4].moves.size(), 2U);
  EXPECT_NEAR(file.shapes[4].moves[0].offset.y, -0.005F, 1e-6F);
  EXPECT_EQ(file.shapes[5].name, "vrmSurprised");
}

TEST(VrmTest, NewAvatarsLookWithShapesAndHaveExpressionsOfTheirOwn) {
  const ImportedHead file = Read(Avatar(
      R"("VRMC_vrm":{"specVersion":"1.0","lookAt":{"type":"expression","rangeMapVerticalUp":)"
      R"({"inputMaxValue":30,"outputScale":0.5}},"expressions":{"preset":{"aa":)"
      R"({"morphTargetBinds":[{"node":3,"index":0,"weight":1}]},"oh":)"
      R"({"morphTargetBinds":[{"node":0,"index":0,"weight":1}]}},"custom":{"JawOpen":)"
      R"({"morphTargetBinds":[{"node":3,"index":2,"weight":1}]}}}})"));
  ExpectPlace(file.position[1], {0.1F, 0, 0});
  EXPECT_TRUE(file.gaze_by_shape);
  ASSERT_EQ(file.shapes.size(), 6U) << "what no node has is no shape";
  EXPECT_EQ(file.shapes[4].name, "vrmaa");
  EXPECT_EQ(file.shapes[5].name, "vrmJawOpen");
}

/// A chain of three joints of hair, 10 cm long each, hanging beside the head, and a strip of flesh
/// on it: two vertices at each joint and two between the first and the second.
std::string HairAvatar(const std::string& extensions) {
  GltfMaker maker;
  // Nothing says how it was bound: places are from the joint that holds them.
  const int place = maker.Places({0, 0, 0, 0, 0, 0.02F, 0, -0.05F, 0, 0, -0.05F, 0.02F,
                                  0, 0, 0, 0, 0, 0.02F, 0, 0,      0, 0, 0,      0.02F});
  const int joints = maker.Bytes({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0,
                                  2, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 3, 0, 0, 0},
                                 "VEC4", 4);
  std::vector<float> held;
  for (int i = 0; i < 8; ++i) held.insert(held.end(), {1, 0, 0, 0});
  const int weights = maker.Floats(held, "VEC4", 4);
  return maker.File(
      R"("nodes":[{"children":[1],"translation":[0,1.5,0]},)"
      R"({"children":[2],"translation":[0.1,0.1,0]},{"children":[3],"translation":[0,-0.1,0]},)"
      R"({"translation":[0,-0.1,0]},{"mesh":0,"skin":0,"name":"Hair"}],)"
      R"("skins":[{"joints":[0,1,2,3]}],"meshes":[{"primitives":[{"attributes":{"POSITION":)" +
      Number(place) + R"(,"JOINTS_0":)" + Number(joints) + R"(,"WEIGHTS_0":)" + Number(weights) +
      R"(}}]}],"extensions":{)" + extensions + "}");
}

/// By how much the springs of a file carry each of its vertices, in sum: 0, 1 and 2.
std::vector<std::array<float, 3>> Hung(const ImportedHead& file) {
  std::vector<std::array<float, 3>> hung(file.position.size());
  for (const auto& [vertex, spring, weight] : file.spring_rig.weights)
    hung.at(vertex).at(spring) += weight;
  return hung;
}

TEST(VrmTest, HairOfOldAvatarsSwingsByItsSecondaryAnimation) {
  const ImportedHead file = Read(
      HairAvatar(R"("VRM":{"secondaryAnimation":{"boneGroups":[{"stiffiness":1,"gravityPower":0,)"
                 R"("dragForce":0.4,"bones":[1],"colliderGroups":[0]}]}})"));
  ASSERT_EQ(file.spring_rig.springs.size(), 3U);
  ExpectPlace(file.spring_rig.springs[0].rest, {-0.1F, 1.5F, 0});
  ExpectPlace(file.spring_rig.springs[1].rest, {-0.1F, 1.4F, 0});
  ExpectPlace(file.spring_rig.springs[2].rest, {-0.1F, 1.33F, 0});
  ExpectPlace(file.spring_rig.springs[2].root, {-0.1F, 1.6F, 0});
  EXPECT_NEAR(file.spring_rig.springs[0].frequency_hz, 3.90F, 0.01F);  // sqrt(60 / 0.1) / 2 pi
  EXPECT_NEAR(file.spring_rig.springs[0].damping, 0.626F,
              0.001F);  // 30 ln(1 / 0.6) / sqrt(60 / 0.1)
  EXPECT_NEAR(file.spring_rig.springs[1].frequency_hz, 3.90F / std::sqrt(2.0F), 0.01F);
  EXPECT_EQ(file.spring_rig.springs[0].hang, 0);
  const auto hung = Hung(file);
  EXPECT_EQ(hung[0], (std::array<float, 3>{0, 0, 0})) << "where the chain begins";
  EXPECT_NEAR(hung[2][0], 0.5F, 1e-3F) << "between";
  EXPECT_NEAR(hung[4][0], 1, 1e-3F);
  EXPECT_NEAR(hung[6][1], 1, 1e-3F);
}

TEST(VrmTest, HairOfNewAvatarsSwingsByItsSpringBones) {
  const ImportedHead file = Read(HairAvatar(
      R"("VRMC_vrm":{"specVersion":"1.0"},"VRMC_springBone":{"specVersion":"1.0","springs":[)"
      R"({"joints":[{"node":1,"stiffness":0.5,"gravityPower":0.5,"dragForce":0.3},)"
      R"({"node":2,"stiffness":0.5,"dragForce":0.3},{"node":3}]},)"
      R"({"joints":[{"node":99},{"node":-5}]},{"joints":"none"}]})"));
  ASSERT_EQ(file.spring_rig.springs.size(), 2U)
      << "the last joint only says where the one before ends";
  ExpectPlace(file.spring_rig.springs[1].rest, {0.1F, 1.4F, 0});
  EXPECT_EQ(file.spring_rig.springs[0].hang, 0.5F);
  EXPECT_EQ(file.spring_rig.springs[1].hang, 0);
  EXPECT_EQ(file.spring_rig.springs[0].outward, glm::vec3(0)) << "nothing is in its way";
  EXPECT_NEAR(Hung(file)[6][1], 1, 1e-3F) << "the end of the chain";
}

TEST(VrmTest, HairOfAnAvatarSwingsAsItsHeadTurns) {
  const ImportedHead file = Read(HairAvatar(
      R"("VRM":{"secondaryAnimation":{"boneGroups":[{"stiffiness":0.3,"dragForce":0.1,"bones":[1]},)"
      R"({"bones":[0]}]}})"));
  constexpr float kMillimetres = 1000;
  const Similarity place{.scale = kMillimetres, .translation = {0, -1500, 0}};
  const auto head = RigUnriggedHead(AlignImportedHead(file, place, -43));
  const RigData& rig = head->rig().data();
  ASSERT_EQ(rig.spring_rig.springs.size(), 4U);
  Simulation simulation(rig.spring_rig.springs);
  const auto turning = [](Simulation::Time t) {
    FaceState state;
    state.head_rotation[1] = 30 * std::clamp(static_cast<float>(t.count()) / 2e5F, 0.0F, 1.0F);
    return state;
  };
  const Simulation::Time now = std::chrono::milliseconds(150);
  simulation.RunTo(now, turning);
  HeadVertices still, swung;
  head->Evaluate(turning(now), still);
  head->Evaluate(turning(now), swung, simulation.offsets());
  EXPECT_GT(glm::distance(still.position[6], swung.position[6]), 3);
  EXPECT_LT(glm::distance(still.position[0], swung.position[0]), 0.01F);
}

TEST(VrmTest, SpringsOfTheBodyAreLeftOut) {
  const ImportedHead file = Read(
      HairAvatar(R"("VRM":{"secondaryAnimation":{"boneGroups":[{"stiffiness":1,"bones":[1]}]}})"));
  const Similarity place{.scale = 1000, .translation = {0, -2500, 0}};
  EXPECT_TRUE(RigUnriggedHead(AlignImportedHead(file, place, -43))
                  ->rig()
                  .data()
                  .spring_rig.springs.empty());
}

TEST(VrmTest, EyesTurnAsFarAsTheAvatarSays) {
  UnriggedHead model;
  model.has_eyes = true;
  model.eye_rig.centre.right = {-30, 0, 60};
  model.eye_rig.centre.left = {30, 0, 60};
  model.eye_rig.pivot = {glm::vec3(-30, 0, 40), glm::vec3(30, 0, 40)};
  model.eye_rig.gaze_ranges.emplace().outer = {.gaze_deg = 40, .output = 8};
  for (const glm::vec3 p : {glm::vec3(30, 0, 70), glm::vec3(31, 0, 70), glm::vec3(30, 1, 70)}) {
    model.Add(p, Bone::kEyeLeft, glm::vec3(1));
  }
  model.mesh.Triangle(Material::kSkin, 0, 1, 2);
  const auto head = RigUnriggedHead(std::move(model));
  FaceState state;
  state.gaze.left[kToRight] = 20;  // to the viewer's right, outward for the agent's left eye
  HeadVertices moved;
  head->Evaluate(state, moved);
  EXPECT_NEAR(moved.position[0].x, 30 + 30 * std::sin(4.0F / 57.29578F), 0.01F);
}

TEST(OwnShapesTest, WhatShapesMoveIsNotMovedByTheJawAgainAndCustomOnesAreKnown) {
  ImportedHead file;
  file.position = {{0, -40, 70}, {5, -40, 70}, {0, -45, 70}};
  file.parts.push_back({.name = "teeth", .indices = {0, 1, 2}});
  std::vector<ShapeMeaning> meanings;
  for (const char* name : {"jawopen", "browdownleft", "browdownright", "mouthpucker"}) {
    FaceState state;
    const std::size_t unit = name[0] == 'j' ? 27 : name[0] == 'm' ? 18 : 4;
    if (name != std::string("browdownleft")) state.au.right[unit] = 1;
    if (name != std::string("browdownright")) state.au.left[unit] = 1;
    meanings.push_back({name, state});
    file.shapes.push_back({"vrm" + std::string(name), {}});
  }
  file.shapes[0].moves = {{0, {0, -10, 0}}, {1, {0, -10, 0}}, {2, {0, -10, 0}}};
  UnriggedHead model = AlignImportedHead(file, {}, -30);
  ASSERT_EQ(model.mesh.bone[0], Bone::kJaw);
  const auto source = MakeSymmetricHead("galatea");
  auto skin = MakeBlendshapeRig(file, {}, model, {*source, meanings}, *source).rig;
  ASSERT_TRUE(skin);
  EXPECT_EQ(model.mesh.bone[0], Bone::kSkin);
  const auto head = RigUnriggedHead(std::move(model), std::move(*skin));
  HeadVertices moved;
  head->Evaluate(meanings[0].state, moved);
  EXPECT_NEAR(moved.position[0].y, -50, 0.5F);
}

/// A file of shapes that each move a vertex of their own by a millimetre.
ImportedHead OfShapes(std::initializer_list<const char*> names) {
  ImportedHead file;
  for (const char* name : names) {
    const auto vertex = static_cast<std::uint32_t>(file.position.size());
    file.position.emplace_back(5 * static_cast<float>(vertex), 40, 70);
    file.shapes.push_back({name, {{vertex, {0, 1, 0}}}});
  }
  file.parts.push_back({.name = "face", .indices = {0, 1, 2}});
  return file;
}

/// The rig of a file by some of ARKit's shapes, and which shapes it leaves out.
struct OwnShapes {
  explicit OwnShapes(const ImportedHead& file) : model(AlignImportedHead(file, {}, -43)) {
    const auto source = MakeSymmetricHead("galatea");
    const auto add = [&](const char* name, std::size_t unit, bool right, bool left) {
      FaceState state;
      state.asymmetry = 0;
      state.au.right[unit] = right ? 1 : 0;
      state.au.left[unit] = left ? 1 : 0;
      meanings.push_back({name, state});
    };
    add("browinnerup", 1, true, true);
    add("cheekpuff", 34, true, true);
    add("jawopen", 27, true, true);
    add("jawleft", 30, false, true);
    add("browdownleft", 4, false, true);
    add("browdownright", 4, true, false);
    auto made = MakeBlendshapeRig(file, {}, model, {*source, meanings}, *source);
    skin = std::move(made.rig);
    unused = std::move(made.unused);
  }
  std::vector<ShapeMeaning> meanings;
  UnriggedHead model;
  std::vector<std::string> unused;
  std::optional<RigData> skin;
};

TEST(OwnShapesTest, HalvesOfAShapeOfBothSidesAreDrivenByTheirSide) {
  const ImportedHead file = OfShapes({"browInnerUp_L", "browInnerUp_R", "browDown_L", "browDown_R",
                                      "jawOpen", "Head.CheekPuffLeft", "Smirk"});
  OwnShapes shapes(file);
  EXPECT_EQ(shapes.unused, (std::vector<std::string>{"Smirk"}));
  ASSERT_TRUE(shapes.skin);
  const auto head = RigUnriggedHead(std::move(shapes.model), std::move(*shapes.skin));
  const auto rises = [&](std::size_t unit, bool right, bool left) {
    FaceState state;
    state.au.right[unit] = right ? 1 : 0;
    state.au.left[unit] = left ? 1 : 0;
    HeadVertices moved;
    head->Evaluate(state, moved);
    std::vector<int> tenths;
    for (std::size_t i : {0U, 1U, 5U}) {
      tenths.push_back(static_cast<int>(std::lround(10 * (moved.position[i].y - 40))));
    }
    return tenths;
  };
  EXPECT_EQ(rises(1, true, true), (std::vector<int>{10, 10, 0}));
  EXPECT_EQ(rises(1, false, true), (std::vector<int>{10, 0, 0}));
  EXPECT_EQ(rises(1, true, false), (std::vector<int>{0, 10, 0}));
  EXPECT_EQ(rises(34, false, true), (std::vector<int>{0, 0, 10}));
}

TEST(OwnShapesTest, HalvesBesideTheWholeAreNotUsedAndTooFewShapesNeither) {
  OwnShapes whole(OfShapes({"browInnerUp", "browInnerUp_L", "browInnerUp_R", "browDown_L",
                            "browDown_R", "jawOpen", "vrmBrowInnerUp"}));
  EXPECT_TRUE(whole.skin);
  EXPECT_EQ(whole.unused, (std::vector<std::string>{"browInnerUp_L", "browInnerUp_R"}));
  OwnShapes few(OfShapes({"browDown_L", "browDown_R", "jawOpen", "Smirk"}));
  EXPECT_FALSE(few.skin);
  EXPECT_EQ(few.unused, (std::vector<std::string>{"Smirk"}));
}

TEST(OwnShapesTest, WhatNoShapeCanShowDrivesNone) {
  OwnShapes shapes(OfShapes({"browInnerUp", "browDown_L", "browDown_R", "jawOpen", "jawLeft"}));
  ASSERT_TRUE(shapes.skin);
  std::set<int> units;
  for (const Channel& channel : shapes.skin->channels) {
    for (const Channel::Driver& driver : channel.drivers) {
      if (driver.drive.kind == Drive::Kind::kUnit) units.insert(driver.drive.number);
    }
  }
  for (const int unit : {1, 4, 26, 27, 30}) EXPECT_TRUE(units.contains(unit)) << unit;
  for (const int unit : {6, 9, 12, 15, 16, 34}) EXPECT_FALSE(units.contains(unit)) << unit;
}

/// A face whose lower half falls with unit 27.
std::shared_ptr<const Head> FallingBall() {
  return std::make_shared<BallHead>([](HeadAsset& asset) {
    RigData& rig = asset.rig;
    const auto channel = [](std::uint16_t unit) {
      Channel made;
      made.drivers = {
          {{.kind = Drive::Kind::kUnit, .number = unit, .side = Drive::WhichSide::kLeft}}};
      return made;
    };
    Channel fall = channel(27);
    std::vector<Displacement> rises;
    const auto count = static_cast<std::uint32_t>(rig.rest.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      const float y = rig.rest[i].y;
      if (y < -30 && y > -100) fall.moves.push_back({i, {0, -10, 0}});
      if (y > 0) rises.push_back({i, {0, 10, 0}});
    }
    // Two more vertices are its lips.
    for (int k = 0; k < 2; ++k) {
      rig.rest.emplace_back(0, -40, 100);
      rig.rest_normal.emplace_back(0, 0, 1);
      rig.bone.push_back(Bone::kSkin);
      rig.weights.emplace_back();
      asset.surface.albedo.emplace_back(0);
      asset.surface.openness.push_back(1);
    }
    rig.mouth = {.seam = {{count, count + 1}}, .corners = {{count, count}}, .incisors = {}};
    fall.moves.push_back({count + 1, {0, -10, 0}});
    rig.channels = {fall};
    rig.units = BuiltInUnits();
    for (const std::uint16_t unit : std::initializer_list<std::uint16_t>{1, 2, 4}) {
      rig.channels.push_back(channel(unit));
      rig.channels.back().moves = rises;
    }
    rig.steps = {RigStep::kChannels};
  });
}

TEST(OwnShapesTest, LipsThatAreShutWithUsAreNotOpenedByTheirShapes) {
  ImportedHead file;
  file.position = {{0, -40, 70}, {5, -40, 70}, {0, -45, 70}, {0, 40, 70}};
  file.parts.push_back({.name = "face", .indices = {0, 1, 2, 1, 2, 3}});
  std::vector<ShapeMeaning> meanings;
  for (const auto& [name, unit] :
       {std::pair("jawopen", 27U), {"browinnerup", 1U}, {"browouterup", 2U}, {"browdown", 4U}}) {
    FaceState state;
    state.au.left[unit] = 1;
    meanings.push_back({name, state});
    file.shapes.push_back({name, {{unit == 27 ? 0U : 3U, {0, unit == 27 ? -10 : 10, 0}}}});
  }
  UnriggedHead model = AlignImportedHead(file, {}, -30);
  const auto source = FallingBall();
  auto skin = MakeBlendshapeRig(file, {}, model, {*source, meanings}, *source).rig;
  ASSERT_TRUE(skin);
  const float rest = model.mesh.position[0].y;
  const auto head = RigUnriggedHead(std::move(model), std::move(*skin));
  const auto fall = [&](const FaceState& state) {
    HeadVertices moved;
    head->Evaluate(state, moved);
    return rest - moved.position[0].y;
  };
  FaceState state = meanings[0].state;
  EXPECT_NEAR(fall(state), 10, 0.5F);
  state.seal = 0.5F;
  EXPECT_NEAR(fall(state), 5, 0.5F) << "no wider than ours";
  state.seal = 1;
  EXPECT_NEAR(fall(state), 0, 0.1F);
}

}  // namespace
}  // namespace fsm
