// Kept pictures: of built-in heads, of mouths that speak, of a head that wears a photo and of one
// out of a glTF file.

#include <cstdlib>

#include "fsm/asset/asset_members.h"
#include "fsm/asset/asset_writer.h"
#include "fsm/faces/face_of_name.h"
#include "fsm/faces/head_of_file.h"
#include "fsm/head/make_head.h"
#include "fsm/motion/inputs/motion_tables.h"
#include "tests/fsm/golden_picture.h"
#include "tests/fsm/render_support.h"

namespace fsm {
namespace {

using MakesHead = std::unique_ptr<Head> (*)();

std::unique_ptr<Head> Galatea() { return MakeHead("galatea"); }
std::unique_ptr<Head> Pygmalion() { return MakeHead("pygmalion"); }
std::unique_ptr<Head> Baucis() { return MakeHead("baucis"); }

/// The photo of data/worn, as face_fit put it on.
std::unique_ptr<Head> Worn() {
  setenv("GALATEA_FACES", GALATEA_SOURCE_DIR "/tests/fsm/data", 1);
  return MakeHeadOfName("worn");
}

const MotionTables& Tables() {
  static const auto tables = MotionTables::Load();
  if (!tables) throw std::runtime_error(tables.error().text);
  return *tables;
}

/// A head of some glTF file: mesh, materials, colours and ARKit's shapes of a built-in head,
/// without what would tell us that it is ours.
std::unique_ptr<Head> OfGltf() {
  const std::string own = kAssetExtension, other = "EXAMPLE_head";
  std::string file = WriteAsset(*MakeSymmetricHead("pygmalion"), ArkitShapes(Tables()));
  for (auto at = file.find(own); at != std::string::npos; at = file.find(own, at)) {
    file.replace(at, own.size(), other);
  }
  const TemporaryFolder folder;
  WriteBytes(folder / "head.glb", {file.begin(), file.end()});
  return MakeHeadOfFile(folder / "head.glb", {}).head;
}

/// One kept picture: a face, how it moves and how it is seen.
struct Golden {
  const char* name;
  MakesHead make_head;
  std::vector<std::pair<std::size_t, float>> units;
  float turn_degrees;
  Camera camera;
  const char* viseme = nullptr;  ///< of the set of 14, at full articulation
};

constexpr Camera kAtMouth{.distance = 0.25F, .height_mm = -48};

const Golden kGoldens[] = {
    {"rest", Galatea, {}, 0, {}},
    {"smile", Galatea, {{6, 0.8F}, {12, 0.9F}, {25, 0.4F}}, 0, {.distance = 0.6F, .height_mm = 10}},
    {"brows",
     Pygmalion,
     {{1, 1.0F}, {2, 1.0F}, {26, 0.4F}},
     0,
     {.distance = 0.6F, .height_mm = 30}},
    {"turned", Galatea, {}, 40, {}},
    {"eyes", Baucis, {{5, 0.5F}}, -10, {.distance = 0.3F, .height_mm = 25}},
    {"viseme_m", Galatea, {}, 0, kAtMouth, "m"},
    {"viseme_a", Galatea, {}, 0, kAtMouth, "a"},
    {"viseme_o", Galatea, {}, 0, kAtMouth, "o"},
    {"photo", Worn, {{1, 0.6F}, {2, 0.6F}, {12, 0.6F}, {26, 0.5F}}, 12, {.distance = 0.65F}},
    {"gltf", OfGltf, {{4, 0.7F}, {12, 0.8F}, {26, 0.6F}}, -20, {.distance = 0.7F}},
};

FaceState StateOf(const Golden& golden) {
  FaceState state;
  for (const auto& [unit, strength] : golden.units) {
    state.au.left[unit] = state.au.right[unit] = strength;
  }
  state.head_rotation[1] = golden.turn_degrees;
  if (golden.viseme == nullptr) return state;
  const MouthPose& pose = FindViseme(Tables().set(VisemeSetId::k14).visemes, golden.viseme)->pose;
  state.mouth = pose.mouth;
  state.seal = pose.seal;
  state.tongue = pose.tongue;
  return state;
}

Image Draw(const Head& head, const FaceState& state, const Camera& camera) {
  constexpr int kSide = 176;
  Scene scene;
  scene.camera = camera;
  const auto context = RenderContext::MakeHeadless(kSide, kSide);
  const auto renderer = Renderer::Make(*context);
  HeadVertices vertices;
  head.Evaluate(state, vertices);
  renderer->DrawVertices(head, vertices, state.figure, scene);
  Image image;
  renderer->Read(image);
  return image;
}

class GoldenTest : public ::testing::TestWithParam<Golden> {};

TEST_P(GoldenTest, LooksAsKept) {
  const Golden& golden = GetParam();
  ExpectGolden(Draw(*golden.make_head(), StateOf(golden), golden.camera),
               std::string(GALATEA_SOURCE_DIR "/tests/fsm/data/golden/") + golden.name + ".png",
               kPlainBackground);
}

INSTANTIATE_TEST_SUITE_P(All, GoldenTest, ::testing::ValuesIn(kGoldens),
                         [](const auto& test) { return std::string(test.param.name); });

/// The lower corners show the shirt, on triangles the picture's edge cuts through.
TEST(ClippedTest, ClothThatLeavesThePictureKeepsItsColour) {
  for (const std::string& identity : Identities()) {
    const Image image = Draw(*MakeHead(identity), {}, {.distance = 0.55F, .height_mm = -40});
    for (const int x : {1, 20, image.width - 21, image.width - 2}) {
      const auto i = static_cast<std::size_t>((image.height - 2) * image.width + x) * 4;
      const int light = image.rgba[i] + image.rgba[i + 1] + image.rgba[i + 2];
      EXPECT_GT(light, 90) << identity << " at x " << x;
    }
  }
}

}  // namespace
}  // namespace fsm
