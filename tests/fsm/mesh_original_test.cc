#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <string>

#include "fsm/head/make_head.h"
#include "fsm/image/image_file.h"
#include "fsm/mesh/original/convert_original_face.h"
#include "fsm/mesh/original/original_expressions.h"
#include "fsm/mesh/original/original_face.h"
#include "fsm/mesh/original/original_motion.h"
#include "fsm/mesh/original/original_points.h"
#include "fsm/mesh/rig_unrigged_head.h"
#include "fsm/mesh/transfer/nnls_solver.h"
#include "tests/support/test_data.h"

namespace fsm {
namespace {

/// The original's own data are not part of the repository (docs/heads.md).
std::string Data() { return support::Original() / "data"; }

Image Grey() { return {.width = 8, .height = 8, .rgba = std::vector<std::uint8_t>(256, 128)}; }

/// A wireframe that has just the points the reader knows, on a rough face, and a few triangles.
OriginalFace SmallFace() {
  OriginalFace face;
  face.name = "small";
  PntFile& file = face.wireframe;
  const auto add = [&file](PointName name, glm::vec3 at) {
    if (!file.index.emplace(name, file.positions.size()).second) return;
    file.names.push_back(name);
    file.positions.push_back(at);
  };
  for (std::size_t i = 0; i < kLipRim.size(); ++i) {
    const float x = 0.02F * (i <= 10 ? static_cast<float>(i) - 5 : 15 - static_cast<float>(i));
    add(kLipRim[i], {x, i % 10 == 0 ? -0.2F : (i < 10 ? -0.199F : -0.201F), 0.8F});
  }
  for (const Side side : kSides) {
    const auto rim = LidRim(side);
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const float along = static_cast<float>(i <= 6 ? i : 12 - i) / 6;
      const float high = i > 0 && i < 6 ? 0.05F : (i > 6 ? -0.05F : 0);
      add(rim[i], {SignOf(side) * (0.15F + 0.2F * along), 0.35F + high, 0.65F});
    }
  }
  for (const auto& [name, point] : kNamedPoints) add(point, {0, 0, 0.9F});
  file.positions[file.index.at(kChin)] = {0, -0.6F, 0.7F};
  face.standard = face.wireframe;
  face.link.triangles.push_back({1, {PointName{1, 36}, {1, 11}, {3, 25}}});
  face.link.triangles.push_back({1, {PointName{1, 37}, kChin, {1, 15}}});
  face.link.triangles.push_back({25, {PointName{1, 37}, kChin, {1, 15}}});  // not drawn
  face.picture = Grey();
  face.units.assign(kOriginalUnits, std::vector<glm::vec3>(file.positions.size(), glm::vec3(0)));
  face.mouth_units.assign(kMouthParameters, face.units[0]);
  face.visemes.assign(kOriginalVisemes, face.units[0]);
  return face;
}

std::unique_ptr<Head> HeadOf(const OriginalFace& face, const VisemeMouths& mouths = {}) {
  UnriggedHead model = ConvertOriginalFace(face);
  RigData skin = RigOfOriginal(face, model, mouths);
  return RigUnriggedHead(std::move(model), std::move(skin));
}

TEST(SmallOriginalFaceTest, EyesComeToWhereOursAre) {
  const OriginalFace face = SmallFace();
  const OriginalSpace frame(face.wireframe);
  EXPECT_LT(glm::distance(frame.EyeOpening(face.wireframe, Side::kLeft), {29.9F, 21.5F, 74}), 0.1F);
}

TEST(SmallOriginalFaceTest, TheWindowShowsOneUnitOfTheWireframeToEitherSide) {
  const OriginalFace face = SmallFace();
  const OriginalSpace frame(face.wireframe);
  const auto window = HeadOf(face)->view();
  ASSERT_TRUE(window);
  EXPECT_LT(glm::distance(window->centre, frame.ToMm(glm::vec3(0))), 1e-3F);
  EXPECT_NEAR(window->half_mm, frame.mm(), 1e-3F);
  EXPECT_FALSE(MakeHead("galatea")->view());
}

TEST(SmallOriginalFaceTest, OnlyTheGroupsTheOriginalDrawsAreShown) {
  const auto head = HeadOf(SmallFace());
  std::size_t skin = 0;
  for (const auto& part : head->surface().parts) {
    if (part.material == Material::kSkin) skin += part.index_count / 3;
  }
  EXPECT_EQ(skin, 2U);
}

TEST(SmallOriginalFaceTest, AUnitOfOneSideMovesThatSide) {
  OriginalFace face = SmallFace();
  constexpr std::size_t kCornerPuller = 9;  // AU 12 is the tenth of the list
  const auto right = face.wireframe.index.at(kLipCorners.right);
  const auto left = face.wireframe.index.at(kLipCorners.left);
  face.units[kCornerPuller][right] = face.units[kCornerPuller][left] = {0, 0.05F, 0};
  const auto head = HeadOf(face);
  HeadVertices rest, moved;
  head->Evaluate({}, rest);
  FaceState state;
  state.au.left[12] = 1;
  head->Evaluate(state, moved);
  EXPECT_NEAR(moved.position[left].y - rest.position[left].y,
              0.05F * OriginalSpace(face.wireframe).mm(), 0.05F);
  EXPECT_NEAR(moved.position[right].y, rest.position[right].y, 0.05F);
}

TEST(SmallOriginalFaceTest, AKeyMouthIsShownByItsViseme) {
  OriginalFace face = SmallFace();
  const auto lower = face.wireframe.index.at({1, 37});
  face.visemes[2][lower] = {0, -0.1F, 0};
  VisemeMouths mouths(kOriginalVisemes);
  mouths[2] = {0.4F, 0, 0.5F, 0, -0.9F, 0, -0.8F, 0, 0, 0, 0, 9};
  mouths[5][9] = 3.5F;  // corners
  const auto head = HeadOf(face, mouths);
  HeadVertices rest, moved;
  head->Evaluate({}, rest);
  FaceState state;
  state.mouth = mouths[2];
  head->Evaluate(state, moved);
  const float fall = rest.position[lower].y - moved.position[lower].y;
  EXPECT_NEAR(fall, 0.4F * 0.1F * OriginalSpace(face.wireframe).mm(), 0.1F);
}

TEST(SmallOriginalFaceTest, AllOfAVisemeIsShownAtAMouthScaleOf100) {
  OriginalFace face = SmallFace();
  const auto lower = face.wireframe.index.at({1, 37});
  face.visemes[2][lower] = {0, -0.1F, 0};
  VisemeMouths mouths(kOriginalVisemes);
  mouths[2] = {0.4F, 0, 0.5F, 0, -0.9F, 0, -0.8F, 0, 0, 0, 0, 9};
  const auto head = HeadOf(face, mouths);
  HeadVertices rest, moved;
  head->Evaluate({}, rest);
  FaceState state;
  for (std::size_t i = 0; i < kMouthParameters; ++i) state.mouth[i] = mouths[2][i] * 100 / 40;
  head->Evaluate(state, moved);
  EXPECT_NEAR(rest.position[lower].y - moved.position[lower].y,
              0.1F * OriginalSpace(face.wireframe).mm(), 0.1F);
}

TEST(SmallOriginalFaceTest, AMouthSetByHandShowsTheMouthUnitOfThatNumber) {
  OriginalFace face = SmallFace();
  const auto lower = face.wireframe.index.at({1, 37});
  face.mouth_units[11][lower] = {0, -0.06F, 0};
  face.visemes[2][lower] = {0, -0.1F, 0};
  VisemeMouths mouths(kOriginalVisemes);
  mouths[2] = {0.4F, 0, 0.5F, 0, -0.9F, 0, -0.8F, 0, 0, 0, 0, 9};
  MouthUnitSizes sizes{};
  sizes[11] = 15;
  UnriggedHead model = ConvertOriginalFace(face);
  RigData skin = RigOfOriginal(face, model, mouths, sizes);
  const auto head = RigUnriggedHead(std::move(model), std::move(skin));
  HeadVertices rest, moved;
  head->Evaluate({}, rest);
  FaceState state;
  state.mouth[kJawY] = state.mouth_by_hand[kJawY] = 15;  // Mouth.12 = 100
  head->Evaluate(state, moved);
  EXPECT_NEAR(rest.position[lower].y - moved.position[lower].y,
              0.06F * OriginalSpace(face.wireframe).mm(), 0.05F);
}

TEST(SmallOriginalFaceTest, WhatUnitsLeaveOfAnExpressionComesByItsChannel) {
  OriginalFace face = SmallFace();
  const auto nose = face.wireframe.index.at({3, 15});
  face.expression_residuals.assign(
      4, std::vector<glm::vec3>(face.wireframe.positions.size(), glm::vec3(0)));
  face.expression_residuals[3][nose] = {0, 0.02F, 0};
  const auto head = HeadOf(face);
  HeadVertices rest, moved;
  head->Evaluate({}, rest);
  FaceState state;
  state.residuals[3] = 2;
  head->Evaluate(state, moved);
  EXPECT_NEAR(moved.position[nose].y - rest.position[nose].y,
              0.04F * OriginalSpace(face.wireframe).mm(), 0.05F);
}

TEST(NnlsSolverTest, MixturesComeApartAgain) {
  std::vector<NnlsSolver::Row> keys;
  keys.push_back({0.5F, 0, 0.5F, 0, -0.9F, 0, -0.7F, 0, 0, 0, 0, 9});
  keys.push_back({0.6F, -1, 0.8F, -0.9F, -1.4F, -0.9F, -1.1F, -1, 3.5F, 0.5F, -1.2F, 2});
  keys.push_back({0.3F, 5, 0.4F, 4.5F, -0.6F, 4.5F, -0.5F, 5, -5, 0, 2.2F, 5});
  NnlsSolver::Row mixed(12);
  for (std::size_t i = 0; i < mixed.size(); ++i) mixed[i] = 0.6F * keys[0][i] + 0.4F * keys[2][i];
  const auto parts = NnlsSolver(keys).Solve(mixed);
  EXPECT_NEAR(parts.weights[0], 0.6F, 0.03F);
  EXPECT_NEAR(parts.weights[1], 0.0F, 0.03F);
  EXPECT_NEAR(parts.weights[2], 0.4F, 0.03F);
  EXPECT_NEAR(parts.residual[11], 0, 0.2F);
}

TEST(NnlsSolverTest, WhatNoKeyExplainsIsGivenBack) {
  std::vector<NnlsSolver::Row> keys(1, NnlsSolver::Row(12));
  keys[0][11] = 9;
  NnlsSolver::Row mouth(12);
  mouth[kCornerY] = 2;
  const auto parts = NnlsSolver(keys).Solve(mouth);
  EXPECT_EQ(parts.weights[0], 0);
  EXPECT_EQ(parts.residual[9], 2);
}

class StandardFaceTest : public testing::Test {
 protected:
  void SetUp() override {
    if (const auto data = support::Original(); !data.Has()) GTEST_SKIP() << data.Missing();
    const std::string picture = testing::TempDir() + "/mesh_original_test.png";
    ASSERT_TRUE(WriteImage(Grey(), picture));
    auto face = ReadOriginalFace(
        {"standard", picture, Data() + "/fheadv2.pnt", "", "", ""},
        {Data() + "/fheadv2.pnt", Data() + "/fheadv2.lnk", Data() + "/teethUpper.obj",
         Data() + "/teethLower.obj", Data() + "/eye.obj", Data() + "/mouthwall.bmp", Data()});
    ASSERT_TRUE(face) << face.error().text;
    face_ = std::move(*face);
    head_ = HeadOf(face_);
    head_->Evaluate({}, rest_);
  }
  glm::vec3 By(const FaceState& state, PointName name) {
    HeadVertices moved;
    head_->Evaluate(state, moved);
    const auto i = face_.wireframe.index.at(name);
    return moved.position[i] - rest_.position[i];
  }
  OriginalFace face_;
  std::unique_ptr<Head> head_;
  HeadVertices rest_;
};

TEST_F(StandardFaceTest, ItsOwnUnitsMoveWhatTheyShould) {
  FaceState state;
  state.au.left[12] = state.au.right[12] = 1;
  EXPECT_GT(By(state, kLipCorners.left).y, 2);
  EXPECT_NEAR(By(state, {6, 22}).y, 0, 0.5F);
  state = {};
  state.au.left[1] = state.au.right[1] = 1;
  EXPECT_GT(By(state, {6, 1}).y, 1.5F);
  state = {};
  state.au.left[27] = state.au.right[27] = 1;
  EXPECT_LT(By(state, kChin).y, -4);
  EXPECT_GT(head_->MeasureMouth(state).gap_mm, 8);
  EXPECT_GT(head_->MeasureMouth(state).jaw_degrees, 1.5F);
}

TEST_F(StandardFaceTest, ABlinkBringsTheUpperLidToTheLower) {
  FaceState state;
  state.blink.left = 1;
  EXPECT_LT(By(state, {5, 20}).y, -4);
  EXPECT_NEAR(By(state, {4, 20}).y, 0, 0.2F);
}

TEST_F(StandardFaceTest, ASealClosesAnOpenMouth) {
  FaceState state;
  state.au.left[26] = state.au.right[26] = 1;
  ASSERT_GT(head_->MeasureMouth(state).gap_mm, 4);
  state.seal = 1;
  EXPECT_LT(head_->MeasureMouth(state).gap_mm, 1.2F);
}

TEST_F(StandardFaceTest, TeethFillTheMouthAsInTheOriginalAndStayWithinNarrowJaws) {
  const OriginalSpace frame(face_.wireframe);
  const auto at = [&](PointName name) { return frame.PositionMm(face_.wireframe, name); };
  std::vector<glm::vec3> teeth;
  for (const auto& part : head_->surface().parts) {
    if (part.material != Material::kTeeth) continue;
    for (std::uint32_t i = 0; i < part.index_count; ++i) {
      teeth.push_back(rest_.position[head_->surface().indices[part.first_index + i]]);
    }
  }
  ASSERT_GT(teeth.size(), 1000U);
  glm::vec3 low(1e9F), high(-1e9F);
  for (const glm::vec3& p : teeth) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  EXPECT_NEAR(high.x - low.x, at({13, 15}).x - at({12, 15}).x, 0.1F);
  EXPECT_NEAR(high.y - low.y, at({12, 17}).y - at({1, 36}).y + at({1, 37}).y - at({1, 40}).y, 0.1F);
  EXPECT_NEAR(high.z, std::max(at({1, 10}).z, at({1, 22}).z), 0.1F);
}

TEST_F(StandardFaceTest, NoToothComesThroughASmallerChin) {
  // As woman01: her chin is nearer to her mouth, and her face is flatter.
  OriginalFace face = face_;
  const float mouth = face.wireframe.positions[face.wireframe.index.at(kLipMiddle)].y;
  for (glm::vec3& p : face.wireframe.positions) {
    if (p.y < mouth) p.y = mouth + 0.72F * (p.y - mouth);
    p.z = 0.66F + 0.75F * (p.z - 0.66F);
  }
  const auto head = HeadOf(face);
  HeadVertices rest;
  head->Evaluate({}, rest);
  const HeadSurface& topology = head->surface();
  const auto part = [&topology](Material material) {
    std::vector<std::uint32_t> corners;
    for (const auto& one : topology.parts) {
      if (one.material != material) continue;
      const auto first = topology.indices.begin() + one.first_index;
      corners.insert(corners.end(), first, first + one.index_count);
    }
    return corners;
  };
  const auto skin = part(Material::kSkin);
  int seen = 0;
  for (const std::uint32_t corner : part(Material::kTeeth)) {
    const glm::vec3 tooth = rest.position[corner];
    float front = -1e9F;  // of the skin before the tooth
    for (std::size_t i = 0; i + 2 < skin.size(); i += 3) {
      const glm::vec3 a = rest.position[skin[i]], b = rest.position[skin[i + 1]],
                      c = rest.position[skin[i + 2]];
      const glm::mat3 corners({a.x, a.y, 1}, {b.x, b.y, 1}, {c.x, c.y, 1});
      if (std::abs(glm::determinant(corners)) < 1e-6F) continue;
      const glm::vec3 parts = glm::inverse(corners) * glm::vec3(tooth.x, tooth.y, 1);
      if (std::min({parts.x, parts.y, parts.z}) < 0) continue;
      front = std::max(front, parts.x * a.z + parts.y * b.z + parts.z * c.z);
    }
    // The lips are open by a hair at rest: nothing is before a tooth there.
    if (front > -1e8F && tooth.z > front) ++seen;
  }
  EXPECT_EQ(seen, 0);
}

TEST_F(StandardFaceTest, ExpressionsAreThoseOfTheFiles) {
  const auto read = ReadOriginalExpressions(Data(), Data() + "/fheadv2.pnt");
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(read->expressions.size(), 6U + 6 * 4 + 5);
  EXPECT_EQ(read->residuals.size(), 3U)
      << "DISGUSTED, SURPRISED and FEARED are no mixture of units";
  EXPECT_TRUE(read->without_residual.empty());
  const OriginalSpace frame(face_.standard);
  for (std::size_t k = 0; k < 6; ++k) {
    const OriginalExpression& one = read->expressions[k];
    FaceState state;
    for (std::size_t i = 0; i < kOriginalUnits; ++i) {
      state.au.right[static_cast<std::size_t>(kUnitNumbers[i])] = one.strengths.right[i];
      state.au.left[static_cast<std::size_t>(kUnitNumbers[i])] = one.strengths.left[i];
    }
    if (one.residual) state.residuals[*one.residual] = 1;
    const auto file = ReadPnt(Data() + "/_AU_Datas/AU" + std::to_string(31 + k) + ".pnt");
    ASSERT_TRUE(file);
    HeadVertices moved;
    head_->Evaluate(state, moved);
    float most = 0, worst = 0;
    for (std::size_t i = 0; i < face_.wireframe.names.size(); ++i) {
      const int group = face_.wireframe.names[i].first;
      // Lips are kept from crossing, and lids out of the eyes: there ours differs on purpose.
      if (group < 6 || group > 15) continue;
      const glm::vec3 by = frame.mm() * file->positions[file->index.at(face_.wireframe.names[i])];
      most = std::max(most, glm::length(by));
      worst = std::max(worst, glm::distance(by, moved.position[i] - rest_.position[i]));
    }
    EXPECT_GT(most, 2) << one.name;
    EXPECT_LT(worst, 0.5F) << one.name;
  }
}

TEST_F(StandardFaceTest, LipsAreShutAtRest) {
  for (const auto& [upper, lower] : kLipPairs) {
    const auto at = [&](PointName name) { return rest_.position[face_.wireframe.index.at(name)]; };
    EXPECT_NEAR(at(upper).y, at(lower).y, 1e-3F) << upper.second;
  }
}

TEST_F(StandardFaceTest, MissingPointsAreNamed) {
  const std::string path = testing::TempDir() + "/short.pnt";
  FILE* file = std::fopen(path.c_str(), "w");
  std::fputs("#2\n1 1 33 0 0 0\n", file);
  std::fclose(file);
  const auto face = ReadOriginalFace(
      {"standard", testing::TempDir() + "/mesh_original_test.png", path, "", "", ""},
      {Data() + "/fheadv2.pnt", Data() + "/fheadv2.lnk", "", "", "", "", Data()});
  ASSERT_FALSE(face);
  EXPECT_NE(face.error().text.find("short.pnt: point 14 of group 1"), std::string::npos)
      << face.error().text;
}

}  // namespace
}  // namespace fsm
