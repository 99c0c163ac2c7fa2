#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <map>
#include <string>
#include <vector>

#include "fsm/asset/asset_writer.h"
#include "fsm/head/make_head.h"
#include "fsm/mesh/align_imported_head.h"
#include "fsm/mesh/gltf/gltf_document.h"
#include "fsm/mesh/gltf/gltf_head.h"
#include "fsm/mesh/imported_head.h"
#include "fsm/mesh/rig_unrigged_head.h"
#include "fsm/mesh/rigging/blendshape_rig.h"
#include "fsm/rig/unit_table.h"
#include "tests/fsm/ball_head.h"

namespace fsm {
namespace {

ExportedShape Shape(const char* name, std::size_t unit, bool left, bool right) {
  ExportedShape shape{name, {}};
  shape.state.asymmetry = 0;
  shape.state.au.left[unit] = left ? 1 : 0;
  shape.state.au.right[unit] = right ? 1 : 0;
  return shape;
}

TEST(GltfHeadTest, OurHeadWrittenIsReadAgainWithItsShapes) {
  const auto head = MakeSymmetricHead("galatea");
  const std::vector<ExportedShape> shapes = {Shape("jawOpen", 27, true, true),
                                             Shape("mouthSmileLeft", 12, true, false)};
  const auto file = ParseGltfHead("head.glb", WriteAsset(*head, shapes));
  ASSERT_TRUE(file) << file.error().text;
  ASSERT_EQ(file->shapes.size(), 2U);
  EXPECT_EQ(file->shapes[1].name, "mouthSmileLeft");
  std::size_t corners = 0;
  for (const auto& part : file->parts) corners += part.indices.size();
  EXPECT_EQ(corners, head->surface().indices.size());
  // By place: every vertex that moves must be where the head itself puts it.
  HeadVertices rest, moved;
  head->Evaluate({}, rest);
  head->Evaluate(shapes[0].state, moved);
  glm::vec3 chin(0), lowest(0);
  float nearest = 1e9F, fall = 0;
  for (std::size_t i = 0; i < rest.position.size(); ++i) {
    const float far = glm::distance(rest.position[i], head->Landmark("gnathion"));
    if (far < nearest) {
      nearest = far;
      chin = rest.position[i];
      fall = moved.position[i].y - rest.position[i].y;
    }
  }
  nearest = 1e9F;
  for (const auto& delta : file->shapes[0].moves) {
    const float far = glm::distance(1000.0F * file->position[delta.vertex], chin);
    if (far < nearest) {
      nearest = far;
      lowest = delta.offset;
    }
  }
  EXPECT_LT(nearest, 0.01F);
  EXPECT_NEAR(1000 * lowest.y, fall, 0.01F);
  ASSERT_LT(fall, -5);
}

TEST(GltfHeadTest, OnlyWhatMovesIsStored) {
  const auto head = MakeSymmetricHead("galatea");
  const auto none = WriteAsset(*head, {});
  const std::vector<ExportedShape> one = {Shape("browOuterUpLeft", 2, true, false)};
  EXPECT_LT(WriteAsset(*head, one).size() - none.size(), 150000U);
}

TEST(GltfHeadTest, UnitsOfOnesOwnMoveAHeadByItsOwnShapes) {
  const std::shared_ptr<const Head> source = MakeSymmetricHead("galatea");
  std::vector<ExportedShape> shapes;
  std::vector<ShapeMeaning> meanings;
  for (const auto& [name, unit] : {std::pair("a", 26), {"b", 12}, {"c", 2}, {"d", 4}}) {
    shapes.push_back(Shape(name, static_cast<std::size_t>(unit), true, true));
    meanings.push_back({name, shapes.back().state});
  }
  const auto file = ParseGltfHead("head.glb", WriteAsset(*source, shapes));
  ASSERT_TRUE(file) << file.error().text;
  const Similarity place{.scale = 1000};
  const auto moved_as = [&](const Head& moved) -> std::unique_ptr<Head> {
    UnriggedHead model = AlignImportedHead(*file, place, -43);
    auto skin = MakeBlendshapeRig(*file, place, model, {*source, meanings}, moved).rig;
    return skin ? RigUnriggedHead(std::move(model), std::move(*skin)) : nullptr;
  };
  const UnitTable units(Table("u", "jaw 26 6 0.75\nfield 2 43 47 20 20 both 0 5 0\n"));
  const auto head = moved_as(*source), own = moved_as(*source->WithUnits(units));
  ASSERT_TRUE(head && own);
  const auto farthest = [](const Head& moved, const FaceState& state) {
    HeadVertices rest, now;
    moved.Evaluate({}, rest);
    moved.Evaluate(state, now);
    float most = 0;
    for (std::size_t i = 0; i < rest.position.size(); ++i) {
      most = std::max(most, glm::distance(rest.position[i], now.position[i]));
    }
    return most;
  };
  EXPECT_GT(farthest(*head, shapes[1].state), 5);
  EXPECT_LT(farthest(*own, shapes[1].state), 0.1F) << "these units know no smile";
  EXPECT_LT(farthest(*own, shapes[0].state), 0.7F * farthest(*head, shapes[0].state));
}

// 8 x 8 pixels of one red.
constexpr const char* kRedJpeg =
    "/9j/4AAQSkZJRgABAQAAAQABAAD/2wBDAA0JCgsKCA0LCgsODg0PEyAVExISEyccHhcgLikxMC4pLSwzOko+MzZGNy"
    "wtQFdBRkxOUlNSMj5aYVpQYEpRUk//2wBDAQ4ODhMREyYVFSZPNS01T09PT09PT09PT09PT09PT09PT09PT09PT09P"
    "T09PT09PT09PT09PT09PT09PT09PT0//wAARCAAIAAgDASIAAhEBAxEB/8QAFQABAQAAAAAAAAAAAAAAAAAAAAX/xA"
    "AUEAEAAAAAAAAAAAAAAAAAAAAA/8QAFQEBAQAAAAAAAAAAAAAAAAAABQb/xAAUEQEAAAAAAAAAAAAAAAAAAAAA/9oA"
    "DAMBAAIRAxEAPwCAALVz/9k=";

TEST(GltfHeadTest, PicturesMayBeJpeg) {
  const std::string json =
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,)"
      R"("uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],)"
      R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],)"
      R"("textures":[{"source":0}],"images":[{"uri":"data:image/jpeg;base64,)" +
      std::string(kRedJpeg) + R"("}]})";
  const auto file = ParseGltfHead("a.gltf", json);
  ASSERT_TRUE(file) << file.error().text;
  ASSERT_EQ(file->base_colours.size(), 1U);
  EXPECT_NEAR(file->base_colours[0].rgba[0], 0xc0, 4);
  EXPECT_NEAR(file->base_colours[0].rgba[1], 0x20, 4);
}

TEST(GltfHeadTest, EveryCutFileIsRefusedInWords) {
  const BallHead ball;
  const std::vector<ExportedShape> shapes = {Shape("jawOpen", 26, true, true)};
  const std::string whole = WriteAsset(ball, shapes);
  for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 97) {
    const auto file = ParseGltfHead("cut.glb", std::string_view(whole).substr(0, size));
    ASSERT_FALSE(file) << size;
    EXPECT_NE(file.error().text.find("cut.glb"), std::string::npos) << file.error().text;
  }
}

struct GltfDamage {
  const char* json;
  const char* words;
};

class DamagedGltfTest : public testing::TestWithParam<GltfDamage> {};

TEST_P(DamagedGltfTest, IsRefusedWithItsPlace) {
  const auto file = ParseGltfHead("a.gltf", GetParam().json);
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().text.find(GetParam().words), std::string::npos) << file.error().text;
}

// AAAAAAAAAAAAAAAAAAAAAAAAAAAA... is a buffer of zeros.
#define BUFFER                                                                  \
  R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)" \
  R"(AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"}],)"

INSTANTIATE_TEST_SUITE_P(
    All, DamagedGltfTest,
    testing::Values(
        GltfDamage{"", "no glTF"}, GltfDamage{"[1,2]", "no glTF"}, GltfDamage{"{}", "no glTF"},
        GltfDamage{R"({"asset":{"version":"1.0"}})", "version 2"},
        GltfDamage{R"({"asset":{"version":"2.0"}})", "no mesh"},
        GltfDamage{R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"data:x,y"}]})",
                   "buffers[0]: its data URI is not base64"},
        GltfDamage{
            R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"../../etc/passwd"}]})",
            "cannot be read from beside it"},
        GltfDamage{
            R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{}]}]})",
            "accessors[-1]"},
        GltfDamage{"{" BUFFER R"("asset":{"version":"2.0"},"nodes":[{"mesh":0}],
               "bufferViews":[{"buffer":0,"byteOffset":30,"byteLength":36}],
               "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
               "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})",
                   "bufferViews[0]: bytes 30"},
        GltfDamage{"{" BUFFER R"("asset":{"version":"2.0"},"nodes":[{"mesh":0}],
               "bufferViews":[{"buffer":0,"byteLength":36}],
               "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}],
               "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})",
                   "accessors[0]: its elements are not in its bufferView"},
        GltfDamage{"{" BUFFER R"("asset":{"version":"2.0"},"nodes":[{"mesh":0}],
               "bufferViews":[{"buffer":0,"byteLength":36}],
               "accessors":[{"bufferView":0,"componentType":5126,"count":999999999,"type":"VEC3"}],
               "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})",
                   "more than"},
        GltfDamage{R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],
               "accessors":[{"componentType":5126,"count":2000000,"type":"VEC3"}],
               "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})",
                   "accessors[0]: more than 4194304 numbers"},
        GltfDamage{"{" BUFFER
                   R"("asset":{"version":"2.0"},"nodes":[{"children":[1]},{"children":[1]}]})",
                   "their own parents"}));

TEST(ShapeNameTest, MakersAgreeOnSidesOnceSpelledAlike) {
  EXPECT_EQ(PlainShapeName("mouthSmile_L"), "mouthsmileleft");
  EXPECT_EQ(PlainShapeName("mouthSmileLeft"), "mouthsmileleft");
  EXPECT_EQ(PlainShapeName("blendShape1.Eye_Blink_R"), "eyeblinkright");
}

}  // namespace
}  // namespace fsm
