// A head written as one file and read again.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fsm/asset/asset_members.h"
#include "fsm/asset/asset_reader.h"
#include "fsm/asset/asset_writer.h"
#include "fsm/asset/check_asset.h"
#include "fsm/asset/describe.h"
#include "fsm/head/make_head.h"
#include "fsm/head/photo_head.h"
#include "fsm/mesh/gltf/gltf_document.h"
#include "tests/fsm/ball_head.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

/// States that use every part of a rig.
std::vector<FaceState> States() {
  std::vector<FaceState> states(5);
  for (std::size_t unit = 1; unit < kActionUnits; ++unit) {
    states[1].au.left[unit] = unit % 3 == 0 ? 0.7F : 0;
    states[1].au.right[unit] = unit % 4 == 0 ? 0.9F : 0;
  }
  for (std::size_t k = 0; k < states[2].mouth.size(); ++k)
    states[2].mouth[k] = 0.4F * std::sin(static_cast<float>(k));
  states[3].blink.left = 1;
  states[3].head_rotation = {10, 20, 5};
  states[4].au.left[12] = states[4].au.right[26] = 1;
  states[4].mouth[kUpperOuterY] = 1;
  return states;
}

void ExpectSameHead(const Head& read, const Head& written) {
  HeadVertices a, b;
  for (const FaceState& state : States()) {
    written.Evaluate(state, a);
    read.Evaluate(state, b);
    ASSERT_EQ(a.position, b.position);
    ASSERT_EQ(a.normal, b.normal);
    EXPECT_EQ(a.creases, b.creases);
    EXPECT_EQ(a.lids_shut, b.lids_shut);
    EXPECT_EQ(written.MeasureMouth(state).gap_mm, read.MeasureMouth(state).gap_mm);
  }
  EXPECT_EQ(written.landmarks(), read.landmarks());
  // Whatever else there is of a head is in the file, and comes out of it the same.
  EXPECT_EQ(WriteAsset(written, {}), WriteAsset(read, {}));
}

Head ReadAgain(const Head& head) {
  auto asset = ParseAsset("head.glb", WriteAsset(head, {}));
  if (!asset) throw std::runtime_error(asset.error().text);
  return Head(std::move(*asset));
}

/// A face of one colour, worn by the built-in head.
PhotoHead OneColour() {
  PhotoHead set;
  for (const glm::vec3 at : {glm::vec3(0), {50, 0, 0}, {0, 50, 0}, {0, 0, 50}, {50, 50, 20}}) {
    set.points.push_back({at, glm::vec3(0)});
  }
  set.atlas = std::make_shared<Image>(Image{2, 1, {200, 40, 40, 255, 40, 200, 40, 255}});
  set.skin_low = {0.24F, 0.9F};
  set.skin_high = {0.26F, 0.1F};
  return set;
}

TEST(AssetFileTest, EveryBuiltInHeadComesBackAsItWas) {
  for (const std::string& identity : Identities()) {
    SCOPED_TRACE(identity);
    const auto head = MakeHead(identity);
    ExpectSameHead(ReadAgain(*head), *head);
  }
}

TEST(AssetFileTest, AHeadThatWearsAPhotoComesBackAsItWas) {
  const auto head = MakeHead(OneColour());
  const Head read = ReadAgain(*head);
  ExpectSameHead(read, *head);
  ASSERT_TRUE(read.surface().textures.base_colour);
  EXPECT_EQ(read.surface().textures.base_colour->rgba, head->surface().textures.base_colour->rgba);
}

TEST(AssetFileTest, AParallelViewAndAMaterialComeBack) {
  const BallHead ball([](HeadAsset& asset) {
    asset.view = ParallelView{{1, 2, 3}, 44};
    asset.surface.pbr_materials.push_back({.kind = PbrMaterial::Kind::kToon, .roughness = 0.3F});
    asset.surface.parts[0].pbr = 0;
  });
  const Head read = ReadAgain(ball);
  ASSERT_TRUE(read.view());
  EXPECT_EQ(read.view()->half_mm, 44);
  ASSERT_EQ(read.surface().pbr_materials.size(), 1U);
  EXPECT_EQ(read.surface().pbr_materials[0].kind, PbrMaterial::Kind::kToon);
  EXPECT_EQ(read.surface().parts[0].pbr, 0);
}

TEST(AssetFileTest, CreasesAtRestAreFourAsInFilesThatThereAre) {
  const std::string file = WriteAsset(*MakeHead("baucis"), {});
  const std::size_t from = file.find("\"creases\":[");
  ASSERT_NE(from, std::string::npos);
  const std::string list = file.substr(from, file.find(']', from) - from);
  EXPECT_EQ(std::ranges::count(list, ','), 3) << list;
}

TEST(AssetFileTest, TheUnitsTableStandsInItAsText) {
  const auto head = MakeHead("galatea");
  const std::string text = head->rig().data().units.Text();
  EXPECT_NE(text.find("\nlid 5 "), std::string::npos);
  EXPECT_EQ(UnitTable(Table("units", text)).Text(), text);
}

/// The file with a changed JSON.
std::string Changed(const std::string& file,
                    const std::function<void(nlohmann::json& extension)>& change) {
  const auto word = [&](std::size_t at) {
    std::size_t value = 0;
    for (std::size_t k = 4; k-- > 0;) value = value << 8 | static_cast<std::uint8_t>(file[at + k]);
    return value;
  };
  auto json = nlohmann::json::parse(file.substr(20, word(12)));
  change(json["extensions"][kAssetExtension]);
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto bytes = [](std::size_t value) {
    std::string out;
    for (int k = 0; k < 4; ++k) out += static_cast<char>(value >> (8 * k) & 0xff);
    return out;
  };
  const std::string rest = file.substr(20 + word(12));
  return file.substr(0, 8) + bytes(20 + text.size() + rest.size()) + bytes(text.size()) +
         file.substr(16, 4) + text + rest;
}

TEST(AssetFileTest, ADamagedFileIsRefusedByFileAndMember) {
  using nlohmann::json;
  const std::string whole = WriteAsset(*MakeHead("galatea"), {});
  ASSERT_TRUE(ParseAsset("head.glb", Changed(whole, [](json&) {})));
  const std::pair<std::function<void(json&)>, const char*> faults[] = {
      {[](json& e) { e["version"] = 3; }, "version: 4 expected"},
      {[](json& e) { e["version"] = 5; }, "version: 4 expected"},
      {[](json& e) { e.erase("rig"); }, "no member \"rig\""},
      {[](json& e) { e["rig"]["steps"] = 7000000; }, "rig.steps"},
      {[](json& e) { e["rig"]["bone"] = e["rig"]["rest"]; }, "rig.bone: accessors["},
      {[](json& e) { e["rig"]["rest"] = json::array(); }, "rig.rest: no vertices"},
      {[](json& e) { e["rig"]["rest_normal"] = json::array(); }, "rig.rest_normal: 0 elements for"},
      {[](json& e) { e["rig"]["weights"].erase("jaw"); }, "rig.weights: no member \"jaw\""},
      {[](json& e) { e["rig"]["weights"]["jaw"] = e["rig"]["lids"]["vertices"]["upper"]; },
       "rig.weights.jaw: as many as in the first column expected"},
      {[](json& e) { e["rig"]["channels"][0]["drivers"][0]["drive"]["number"] = 4000; },
       "rig.channels[0]: number 4000"},
      {[](json& e) { e["rig"]["channels"][0]["drivers"][0]["drive"]["kind"] = 9; },
       "rig.channels[0].drivers[0].drive.kind: 9 found"},
      {[](json& e) { e["rig"]["unit_effects"] = "field 1 2"; }, "rig.unit_effects:1:"},
      {[](json& e) {
         e["rig"]["jaw_hinge"] = {1, 2};
       },
       "rig.jaw_hinge: a list of 3 expected"},
      {[](json& e) {
         e["rig"]["mouth"]["corners"] = {1, 900000};
       },
       "rig.mouth.corners[1]: vertex 900000 of"},
      {[](json& e) { e["surface"]["parts"][0]["index_count"] = 300000000; },
       "surface.parts[0]: its triangles are not among the indices"},
      {[](json& e) { e["surface"]["parts"][0]["material"] = "skin"; },
       "surface.parts[0].material: a whole number expected"},
      {[](json& e) { e["surface"]["image"] = 3; }, "surface.image:"},
      {[](json& e) {
         e["landmarks"] = {{"nasion", "here"}};
       },
       "landmarks.nasion: a list of 3"}};
  for (const auto& [change, expected] : faults) {
    const auto read = ParseAsset("head.glb", Changed(whole, change));
    ASSERT_FALSE(read) << expected;
    EXPECT_NE(read.error().text.find("head.glb: GALATEA_head: "), std::string::npos)
        << read.error().text;
    EXPECT_NE(read.error().text.find(expected), std::string::npos) << read.error().text;
  }
  EXPECT_FALSE(ParseAsset("head.glb", whole.substr(0, whole.size() / 2)));
  EXPECT_FALSE(ParseAsset("head.glb", "glTF"));
}

TEST(AssetFileTest, MembersThatAreNoMoreArePassedOver) {
  const auto head = MakeHead("galatea");
  const std::string old = Changed(WriteAsset(*head, {}), [](nlohmann::json& e) {
    // What told lids and lips while the head was made was once written, too.
    for (const char* gone : {"eye", "lid_upper", "lid_lower", "lip_column", "lip_weight"})
      e["rig"]["weights"][gone] = e["rig"]["weights"]["jaw"];
  });
  auto asset = ParseAsset("head.glb", old);
  ASSERT_TRUE(asset) << asset.error().text;
  ExpectSameHead(Head(std::move(*asset)), *head);
}

TEST(AssetFileTest, GazeRangesAndLightOfMaterialsComeBack) {
  const BallHead ball([](HeadAsset& asset) {
    asset.rig.eyes.gaze_ranges =
        GazeRanges{.inner = {30, 1}, .outer = {40, 2}, .up = {50, 3}, .down = {60, 4}};
    asset.surface.pbr_materials.push_back({.emissive = {0.1F, 0.2F, 0.3F}});
  });
  const Head read = ReadAgain(ball);
  ExpectSameHead(read, ball);
  EXPECT_EQ(read.rig().data().eyes.gaze_ranges->down.output, 4);
  EXPECT_EQ(read.surface().pbr_materials[0].emissive.z, 0.3F);
}

TEST(AssetFileTest, OtherProgramsSeeAMeshWithShapes) {
  const auto head = MakeSymmetricHead("galatea");
  ExportedShape smile{"mouthSmileLeft", {}};
  smile.state.au.left[12] = 1;
  const GltfDocument gltf(WriteAsset(*head, std::vector{smile}));
  const auto& mesh = gltf.At("meshes", 0);
  EXPECT_EQ(mesh["extras"]["targetNames"][0], "mouthSmileLeft");
  ASSERT_GT(mesh["primitives"].size(), 5U);
  const auto moved = gltf.Numbers(mesh["primitives"][0]["targets"][0]["POSITION"], 3);
  HeadVertices rest, state;
  head->Evaluate({}, rest);
  head->Evaluate(smile.state, state);
  ASSERT_EQ(moved.size(), 3 * rest.position.size());
  for (std::size_t i = 0; i < rest.position.size(); ++i) {
    const glm::vec3 by = state.position[i] - rest.position[i];
    for (int k = 0; k < 3; ++k)
      ASSERT_NEAR(moved[3 * i + static_cast<std::size_t>(k)], by[k], 0.011F);
  }
}

/// What CheckAsset says, "" where it says nothing.
std::string FlawOf(const HeadAsset& asset) {
  try {
    CheckAsset(asset);
  } catch (const vm::Failure& failure) {
    return failure.what();
  }
  return "";
}

TEST(CheckAssetTest, WhatTheBakersMakeFitsTogether) {
  for (const auto& head : {MakeHead("galatea"), MakeHead(OneColour())}) {
    HeadAsset asset{head->surface(), head->rig().data(), head->landmarks(), head->view()};
    EXPECT_EQ(FlawOf(asset), "");
    asset.rig.lips.followers.push_back({3, 10000, 1});
    EXPECT_NE(FlawOf(asset), "");
  }
}

HeadAsset BallAsset() {
  const BallHead ball;
  return {ball.surface(), ball.rig().data(), {}, {}};
}

TEST(CheckAssetTest, StepsOutOfOrderAreRefusedByTheirNames) {
  using enum RigStep;
  HeadAsset asset = BallAsset();
  const auto flaw = [&asset](std::vector<RigStep> steps) {
    asset.rig.steps = std::move(steps);
    return FlawOf(asset);
  };
  EXPECT_EQ(flaw({kTeeth, kLips, kTeeth, kNeck, kNormals}), "");
  EXPECT_EQ(flaw({kNormals, kChannels}), "rig.steps[1]: channels cannot come after normals");
  EXPECT_EQ(flaw({kNeck, kBones}), "rig.steps[1]: bones cannot come after neck");
  EXPECT_EQ(flaw({kJaw, kNormals, kNormals}), "rig.steps[2]: normals cannot come after normals");
  EXPECT_EQ(flaw(std::vector(33, kJaw)), "rig.steps: 33, at most 32 expected");
}

TEST(CheckAssetTest, AFileWithStepsOutOfOrderIsNotRead) {
  HeadAsset asset = BallAsset();
  asset.rig.steps = {RigStep::kNormals, RigStep::kChannels};
  const auto read = ParseAsset("head.glb", WriteAsset(Head(std::move(asset)), {}));
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().text.find("rig.steps[1]"), std::string::npos) << read.error().text;
}

TEST(CheckAssetTest, AChannelWhoseLimitsAreTheWrongWayRoundIsRefused) {
  HeadAsset asset = BallAsset();
  Channel& channel = asset.rig.channels.emplace_back();
  EXPECT_EQ(FlawOf(asset), "") << "without drivers it stays at rest";
  channel.min = 2;
  channel.max = 1;
  EXPECT_NE(FlawOf(asset), "");
  channel.min = std::nanf("");
  EXPECT_NE(FlawOf(asset), "");
}

TEST(CheckAssetTest, WhatIsDividedByIsMoreThanNothing) {
  const auto flaw = [](const auto& spoil) {
    HeadAsset asset = BallAsset();
    spoil(asset);
    return FlawOf(asset);
  };
  EXPECT_EQ(flaw([](HeadAsset& asset) { asset.rig.eyes.gaze_ranges.emplace().up.gaze_deg = 0; }),
            "rig.gaze_ranges.gaze_deg: 0 found where more than 0 was expected");
  EXPECT_EQ(flaw([](HeadAsset& asset) { asset.view.emplace().half_mm = 0; }),
            "view.half_mm: 0 found where more than 0 was expected");
  EXPECT_EQ(flaw([](HeadAsset& asset) {
              asset.rig.teeth.contacts.emplace_back();
              asset.rig.teeth.upper.half_width = std::nanf("");
            }),
            "rig.upper_teeth.half_width: nan found where more than 0 was expected");
  EXPECT_EQ(flaw([](HeadAsset& asset) {
              asset.rig.steps = {RigStep::kTongue};
              asset.rig.bone[0] = Bone::kTongue;
              asset.rig.mouth.seam = {{0, 1}};
              asset.rig.teeth.upper.half_width = 0;
            }),
            "rig.upper_teeth.half_width: 0 found where more than 0 was expected");
}

TEST(RigTest, AMouthIsMeasuredWhicheverStepsThereAre) {
  HeadAsset asset = BallAsset();
  asset.rig.mouth = {.seam = {{600, 800}}, .corners = {{620, 610}}, .incisors = {}};
  asset.rig.normals.soft_triangles = asset.surface.indices;
  const float width = glm::distance(asset.rig.rest[610], asset.rig.rest[620]);
  FaceState state;
  state.head_rotation = {10, 20, 5};
  for (int step = 0; step < static_cast<int>(kRigSteps); ++step) {
    asset.rig.steps = {static_cast<RigStep>(step)};
    const Rig rig(asset.rig);
    EXPECT_NEAR(rig.MeasureMouth(state).width_mm, width, 1e-3F)
        << DefinitionOf(static_cast<RigStep>(step)).name;
  }
}

TEST(RigTest, AChannelWithoutDriversIsKeptWhenUnitsChange) {
  RigData data = BallAsset().rig;
  data.has_unit_channels = true;
  data.channels.emplace_back().moves = {{0, {1, 2, 3}}};
  EXPECT_EQ(Rig(data).WithUnits({}).data().channels.size(), 1U);
}

TEST(DescribeTest, NamesWhatAHeadIsMadeOf) {
  const std::string text = Describe(*MakeHead("galatea"));
  for (const char* expected :
       {"mesh        ", "part        skin, ", "bone        jaw, ", "driven by   units 1 2 4 6 ",
        "driven by   mouth 1 ", "steps       ", "landmark    pronasale "})
    EXPECT_NE(text.find(expected), std::string::npos) << expected << "\n" << text;
}

}  // namespace
}  // namespace fsm
