#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "fsm/head/make_head.h"
#include "fsm/mesh/head_points.h"
#include "fsm/mesh/imported_head.h"
#include "fsm/mesh/rig_unrigged_head.h"
#include "fsm/mesh/rigging/transferred_rig.h"
#include "fsm/mesh/transfer/deformation_transfer.h"
#include "fsm/mesh/transfer/surface_index.h"
#include "fsm/rig/head.h"

namespace fsm {
namespace {

/// Two built-in faces: what the second does by itself is the truth for what is carried to it.
class DeformationTransferTest : public testing::Test {
 protected:
  void SetUp() override {
    from_ = MakeSymmetricHead("galatea");
    to_ = MakeSymmetricHead(Identities()[1]);
    from_->Evaluate({}, from_rest_);
    to_->Evaluate({}, to_rest_);
    flesh_ = SkinTriangles(from_->surface());
    ChoosePairs();
  }

  void MakeTransfer(const std::vector<std::uint32_t>& onto) {
    const auto from_eyes = EyeballTriangles(from_->surface()),
               to_eyes = EyeballTriangles(to_->surface());
    carry_ = std::make_unique<DeformationTransfer>(
        TransferSurface{from_rest_.position, flesh_, false, from_eyes},
        TransferSurface{to_rest_.position, onto, false, to_eyes}, pairs_);
  }

  /// The second face's flesh as a coarse mesh has it: of the vertices in each cube that face the
  /// same way one is left, lips and lids apart. Those keep what is true of them.
  std::vector<std::uint32_t> Coarse(float cube_mm) const {
    std::map<std::tuple<int, int, int, int>, std::uint32_t> left;
    const float mouth = to_->Landmark("stomion").y, eyes = to_->EyeCentre(Side::kRight).y;
    const auto one_of = [&](std::uint32_t v) {
      const glm::ivec3 cube(glm::floor(to_rest_.position[v] / cube_mm));
      const glm::vec3 n = to_rest_.normal[v];
      const float y = to_rest_.position[v].y;
      const int kind = (n.y > 0.3F ? 1 : 0) + (n.y < -0.3F ? 2 : 0) + (n.z > 0 ? 4 : 0) +
                       (y > mouth ? 8 : 0) + (y > eyes ? 16 : 0);
      return left.emplace(std::tuple(cube.x, cube.y, cube.z, kind), v).first->second;
    };
    const auto fine = SkinTriangles(to_->surface());
    std::vector<std::uint32_t> coarse;
    for (std::size_t i = 0; i + 2 < fine.size(); i += 3) {
      const std::array t{one_of(fine[i]), one_of(fine[i + 1]), one_of(fine[i + 2])};
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
        coarse.insert(coarse.end(), t.begin(), t.end());
    }
    return coarse;
  }

  /// A hundred and some places as a landmark detector would give them, lips and lids named.
  void ChoosePairs() {
    const glm::vec3 stomion = from_->Landmark("stomion");
    std::vector<bool> lip(from_rest_.position.size(), false);
    for (const auto& part : from_->surface().parts) {
      if (part.material != Material::kLip) continue;
      for (std::uint32_t k = 0; k < part.index_count; ++k) {
        lip[from_->surface().indices[part.first_index + k]] = true;
      }
    }
    for (const std::uint32_t v : flesh_) {
      const glm::vec3 p = from_rest_.position[v];
      if (from_rest_.normal[v].z < 0.3F || p.z < 40) continue;
      const float apart = lip[v] ? 6.0F : 11.0F;
      if (std::ranges::any_of(
              pairs_, [&](const auto& pair) { return glm::distance(pair.from, p) < apart; })) {
        continue;
      }
      PointPair pair{p, to_rest_.position[v], FaceFeature::kNone};
      if (lip[v] && std::abs(p.y - stomion.y) > 3 && std::abs(p.x) < 16) {
        pair.feature = p.y > stomion.y ? FaceFeature::kUpperLip : FaceFeature::kLowerLip;
      }
      for (const Side side : kSides) {
        const glm::vec3 d = p - from_->EyeCentre(side);
        if (glm::length(d) < 15 && std::abs(d.y) > 4) {
          pair.feature = d.y > 0 ? FaceFeature::kUpperLid : FaceFeature::kLowerLid;
        }
      }
      pairs_.push_back(pair);
    }
  }

  /// Mean error over those that really move of these vertices, as part of how far they move.
  float ErrorOf(const FaceState& state, const std::vector<std::uint32_t>& over) const {
    HeadVertices a, b;
    from_->Evaluate(state, a);
    to_->Evaluate(state, b);
    std::vector<glm::vec3> by(a.position.size()), carried(b.position.size(), glm::vec3(0));
    for (std::size_t i = 0; i < by.size(); ++i) by[i] = a.position[i] - from_rest_.position[i];
    carry_->Apply(by, carried);
    float most = 0, error = 0, motion = 0;
    const std::set<std::uint32_t> vertices(over.begin(), over.end());
    for (const std::uint32_t v : vertices) {
      most = std::max(most, glm::distance(b.position[v], to_rest_.position[v]));
    }
    for (const std::uint32_t v : vertices) {
      const glm::vec3 truth = b.position[v] - to_rest_.position[v];
      if (glm::length(truth) < 0.05F * most) continue;
      error += glm::distance(carried[v], truth);
      motion += glm::length(truth);
    }
    EXPECT_GT(motion, 10) << "nothing moves";
    return error / std::max(motion, 1e-6F);
  }

  /// The mean over these units.
  float MeanError(std::span<const int> units, float each, const std::vector<std::uint32_t>& over) {
    float sum = 0;
    for (const int unit : units) {
      FaceState state;
      const auto k = static_cast<std::size_t>(unit);
      state.au.left[k] = state.au.right[k] = 1;
      const float error = ErrorOf(state, over);
      std::printf("AU %2d  error %.1f %%\n", unit, static_cast<double>(100 * error));
      EXPECT_LT(error, each) << unit;
      sum += error;
    }
    return sum / static_cast<float>(units.size());
  }

  std::unique_ptr<Head> from_, to_;
  HeadVertices from_rest_, to_rest_;
  std::vector<std::uint32_t> flesh_;
  std::vector<PointPair> pairs_;
  std::unique_ptr<DeformationTransfer> carry_;
};

constexpr int kUnits[] = {1, 2, 4, 6, 9, 10, 12, 15, 16, 17, 18, 20, 22, 25, 26, 27};

TEST_F(DeformationTransferTest, UnitsCarriedToAnotherFaceAreNearlyItsOwn) {
  const auto onto = SkinTriangles(to_->surface());
  MakeTransfer(onto);
  EXPECT_LT(MeanError(kUnits, 0.08F, onto), 0.045F);
}

TEST_F(DeformationTransferTest, ACoarseMeshWhoseLandmarksAreMillimetresOffMovesNearlyAsItShould) {
  // As many vertices, and errors as large, as a network finds on a head of another maker.
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const auto k = static_cast<float>(i);
    pairs_[i].to += 2.0F * glm::vec3(std::sin(5 * k), std::sin(7 * k + 1), std::sin(11 * k + 2));
  }
  for (const float cube_mm : {6.0F, 7.0F, 7.5F, 8.0F}) {
    SCOPED_TRACE(cube_mm);
    std::printf("cubes of %.1f mm\n", static_cast<double>(cube_mm));
    const auto onto = Coarse(cube_mm);
    MakeTransfer(onto);
    EXPECT_LT(MeanError(kUnits, 0.15F, onto), 0.072F);
    FaceState shut;
    shut.blink.left = shut.blink.right = 1;
    EXPECT_LT(ErrorOf(shut, onto), 0.2F);
  }
}

TEST_F(DeformationTransferTest, LipsAndLidsAreNeverTakenForEachOther) {
  MakeTransfer(SkinTriangles(to_->surface()));
  // The lower lip falls with the jaw, the upper does not; the upper lid closes, the lower hardly.
  const auto upper_error = [&](const FaceState& state, auto chosen) {
    HeadVertices a, b;
    from_->Evaluate(state, a);
    to_->Evaluate(state, b);
    std::vector<glm::vec3> by(a.position.size()), carried(b.position.size(), glm::vec3(0));
    for (std::size_t i = 0; i < by.size(); ++i) by[i] = a.position[i] - from_rest_.position[i];
    carry_->Apply(by, carried);
    float worst = 0;
    for (const std::uint32_t v : SkinTriangles(to_->surface())) {
      if (!chosen(v)) continue;
      worst = std::max(worst, std::abs(carried[v].y - (b.position[v].y - to_rest_.position[v].y)));
    }
    return worst;
  };
  FaceState jaw;
  jaw.au.left[27] = jaw.au.right[27] = 1;
  HeadVertices open;
  to_->Evaluate(jaw, open);
  const glm::vec3 stomion = to_->Landmark("stomion");
  const float worst = upper_error(jaw, [&](std::uint32_t v) {
    const glm::vec3 p = to_rest_.position[v];
    return std::abs(p.x) < 14 && std::abs(p.y - stomion.y) < 9 && p.z > stomion.z - 1.5F;
  });
  // The lips part by some 30 mm: a vertex of the wrong lip would be wrong by most of that.
  EXPECT_LT(worst, 9);
  FaceState shut;
  shut.blink.left = 1;
  const glm::vec3 eye = to_->EyeCentre(Side::kLeft);
  const float lid = upper_error(shut, [&](std::uint32_t v) {
    const glm::vec3 d = to_rest_.position[v] - eye;
    return std::abs(d.x) < 8 && std::abs(d.y) < 9 && d.z > 8;
  });
  EXPECT_LT(lid, 3.5F);
}

/// The second face's skin as a mesh of another maker, moved by the rig of the first.
TEST_F(DeformationTransferTest, TheRigLaidOnAnotherFaceMovesItAsCarryingEveryStateWould) {
  const auto onto = SkinTriangles(to_->surface());
  UnriggedHead model;
  for (const glm::vec3& p : to_rest_.position) model.Add(p, Bone::kSkin, glm::vec3(1));
  model.mesh.BatchOf(Material::kSkin, -1, false).indices = onto;
  carry_ = std::make_unique<DeformationTransfer>(
      TransferSurface{from_rest_.position, flesh_, false, EyeballTriangles(from_->surface())},
      TransferSurface{to_rest_.position, onto, false, {}}, pairs_);
  RigData skin = TransferRig(model, *from_, pairs_);
  const auto head = RigUnriggedHead(std::move(model), std::move(skin));
  const auto expect_carried = [&](const char* what, const FaceState& state) {
    HeadVertices a, b;
    from_->Evaluate(state, a);
    head->Evaluate(state, b);
    std::vector<glm::vec3> by(a.position.size()), carried(to_rest_.position.size(), glm::vec3(0));
    for (std::size_t i = 0; i < by.size(); ++i) by[i] = a.position[i] - from_rest_.position[i];
    carry_->Apply(by, carried);
    std::vector<float> errors;
    for (const std::uint32_t v : std::set(onto.begin(), onto.end())) {
      errors.push_back(glm::distance(b.position[v] - to_rest_.position[v], carried[v]));
    }
    std::ranges::sort(errors);
    EXPECT_LT(errors[errors.size() * 95 / 100], 0.2F) << what;
    EXPECT_LT(errors[errors.size() * 99 / 100], 0.7F) << what;
  };
  expect_carried("rest", {});
  for (const std::size_t unit : {1U, 4U, 9U, 12U, 18U, 27U, 28U, 43U}) {
    FaceState state;
    state.au.left[unit] = state.au.right[unit] = 1;
    expect_carried(("unit " + std::to_string(unit)).c_str(), state);
  }
  FaceState state;
  state.blink.left = 0.5F;
  state.gaze.left[kDown] = state.gaze.right[kDown] = 15;
  state.mouth = {0.32F, 5, 0.4F, 4.5F, -0.6F, 4.5F, -0.48F, 5, -5, 0, 2.25F, 5};
  expect_carried("a half blink, eyes down and an o", state);
  state.seal = 1;
  expect_carried("sealed", state);
}

TEST_F(DeformationTransferTest, AHeadWithoutPicturesHasRedLipsAndSaysWhereTheyPart) {
  UnriggedHead model;
  for (const glm::vec3& p : to_rest_.position) model.Add(p, Bone::kSkin, glm::vec3(0.5F));
  model.mesh.BatchOf(Material::kSkin, -1, false).indices = SkinTriangles(to_->surface());
  const HeadSurface& known = to_->surface();
  for (const HeadSurface::Part& part : known.parts) {
    if (part.material != Material::kTeeth) continue;
    for (std::uint32_t k = 0; k < part.index_count; k += 3) {
      const std::uint32_t* t = &known.indices[part.first_index + k];
      model.mesh.Triangle(Material::kTeeth, t[0], t[1], t[2]);
      for (int c = 0; c < 3; ++c) model.mesh.bone[t[c]] = to_->rig().data().bone[t[c]];
    }
  }
  RigData skin = TransferRig(model, *from_, pairs_);
  const auto head = RigUnriggedHead(std::move(model), std::move(skin));
  const HeadSurface& topology = head->surface();
  const MouthVertices &mouth = head->mouth(), &known_mouth = to_->mouth();
  EXPECT_EQ(mouth.incisors->upper, known_mouth.incisors->upper);
  EXPECT_EQ(mouth.incisors->lower, known_mouth.incisors->lower);
  ASSERT_EQ(mouth.seam.size(), known_mouth.seam.size());
  HeadVertices rest;
  head->Evaluate({}, rest);
  float off = 0;
  for (std::size_t k = 0; k < mouth.seam.size(); ++k) {
    off += glm::distance(rest.position[mouth.seam[k].first],
                         to_rest_.position[known_mouth.seam[k].first]);
  }
  EXPECT_LT(off / static_cast<float>(mouth.seam.size()), 0.9F) << "on the head's own lips";
  const auto greenness = [&](std::uint32_t v) {
    return topology.albedo[v].g / topology.albedo[v].r;
  };
  EXPECT_LT(greenness(known_mouth.Middle().first), 0.7F) << "the lip";
  EXPECT_NEAR(greenness(to_->rig().data().normals.soft_triangles.front()), 1, 0.3F) << "elsewhere";
}

/// Two lips of flat skin that meet at a height, as a coarse head has them: nothing but the slit
/// tells them apart.
struct FlatLips {
  std::vector<glm::vec3> place;
  std::vector<std::uint32_t> triangles;
  std::vector<bool> is_upper;

  explicit FlatLips(float slit) {
    constexpr int kColumns = 21, kRows = 16;
    for (const bool upper : {true, false}) {
      const auto first = static_cast<std::uint32_t>(place.size());
      for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
          const float x = 2.0F * static_cast<float>(column) - 20;
          const float y = slit + (upper ? 2.0F : -2.0F) * static_cast<float>(row);
          place.emplace_back(x, y, At(x, y).z);
          is_upper.push_back(upper);
          if (row == 0 || column == 0) continue;
          const auto at = static_cast<std::uint32_t>(row * kColumns + column);
          const std::uint32_t a = first + at, b = a - 1, c = a - kColumns, d = c - 1;
          const std::array<std::uint32_t, 6> two =
              upper ? std::array{d, c, a, d, a, b} : std::array{d, a, c, d, b, a};
          triangles.insert(triangles.end(), two.begin(), two.end());
        }
      }
    }
  }
  static glm::vec3 At(float x, float y) { return {x, y, -0.01F * (x * x + y * y)}; }
};

/// The second has its slit 1.6 mm lower than landmarks say.
void ExpectEachFollowsItsOwn(FaceFeature upper_part, FaceFeature lower_part) {
  const FlatLips from(0), to(-1.6F);
  std::vector<PointPair> pairs;
  const auto add = [&](float x, float y, FaceFeature part) {
    pairs.push_back({FlatLips::At(x, y), FlatLips::At(x, y), part});
  };
  for (const float x : {-18.0F, 0.0F, 18.0F}) {
    for (const float y : {-26.0F, 26.0F}) add(x, y, FaceFeature::kNone);
  }
  for (const float x : {-12.0F, -4.0F, 4.0F, 12.0F}) {
    add(x, 6, upper_part);
    add(x, -6, lower_part);
  }
  const DeformationTransfer carry({from.place, from.triangles}, {to.place, to.triangles}, pairs);
  std::vector<glm::vec3> by, carried(to.place.size(), glm::vec3(0));
  for (const bool upper : from.is_upper) by.emplace_back(0, upper ? 0 : -30, 0);
  carry.Apply(by, carried);
  for (std::size_t i = 0; i < carried.size(); ++i) {
    EXPECT_NEAR(carried[i].y, to.is_upper[i] ? 0 : -30, 1) << to.place[i].x << ' ' << to.place[i].y;
  }
}

TEST(TransferOppositesTest, EachLipFollowsItsOwnWhereTheSlitIsNotQuiteWhereLandmarksSay) {
  ExpectEachFollowsItsOwn(FaceFeature::kUpperLip, FaceFeature::kLowerLip);
}

TEST(TransferOppositesTest, EachLidFollowsItsOwnWhereTheSlitIsNotQuiteWhereLandmarksSay) {
  ExpectEachFollowsItsOwn(FaceFeature::kUpperLid, FaceFeature::kLowerLid);
}

TEST(WeldedSurfaceTest, WhatAnEyeballHidesIsNotSeen) {
  // Two patches of skin side by side, before the right one an eyeball.
  std::vector<glm::vec3> place;
  std::vector<std::uint32_t> skin, eye;
  const auto patch = [&place](float x, float z, std::vector<std::uint32_t>& out) {
    const auto first = static_cast<std::uint32_t>(place.size());
    for (const auto& [dx, dy] : {std::pair(0, 0), {10, 0}, {10, 10}, {0, 10}}) {
      place.emplace_back(x + static_cast<float>(dx), dy, z);
    }
    for (const std::uint32_t k : {0U, 1U, 2U, 0U, 2U, 3U}) out.push_back(first + k);
  };
  patch(0, 0, skin);
  patch(22, 0, skin);
  for (const float x : {16.0F, 26.0F}) patch(x, 8, eye);
  WeldedSurface surface(place, skin, false);
  surface.ComputeVisibility(place, eye);
  EXPECT_EQ(surface.visibility[0], 1);
  EXPECT_EQ(surface.visibility[4], 0);
  surface.ComputeVisibility(place, {});
  EXPECT_EQ(surface.visibility[4], 1);
}

TEST(TransferRefusesTest, TooFewPlaces) {
  const std::vector<glm::vec3> place(3, glm::vec3(0));
  const std::vector<std::uint32_t> triangle{0, 1, 2};
  const std::vector<PointPair> pairs(7);
  EXPECT_THROW(DeformationTransfer({place, triangle}, {place, triangle}, pairs),
               std::runtime_error);
}

TEST(HeadPointsTest, WhatIsWrittenIsReadAgain) {
  HeadPoints points;
  for (int i = 0; i < 9; ++i) {
    points.pairs.push_back(
        {{i, 2, 3}, {4, 5, 0.25F * static_cast<float>(i)}, FaceFeature::kLowerLip});
  }
  const auto read = ParseHeadPoints("p", FormatHeadPoints(points));
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(read->face, "galatea");
  ASSERT_EQ(read->pairs.size(), 9U);
  EXPECT_EQ(read->pairs[8].to.z, 2.0F);
  EXPECT_EQ(read->pairs[8].feature, FaceFeature::kLowerLip);
}

TEST(HeadPointsTest, DamageIsToldWithItsLine) {
  const auto text = [](const char* bad) { return std::string("face galatea\n") + bad; };
  for (const auto& [bad, words] : {std::pair("point plain 1 2 3 4 5\n", "p:2: face NAME"),
                                   std::pair("point nose 1 2 3 4 5 6\n", "p:2: plain, upper_lip"),
                                   std::pair("point plain 1 2 3 4 5 nan\n", "p:2: 'nan' found"),
                                   std::pair("", "at least eight")}) {
    const auto read = ParseHeadPoints("p", text(bad));
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().text.find(words), std::string::npos) << read.error().text;
  }
}

TEST(SimilarityTest, TurnSizeAndPlaceAreFound) {
  const glm::mat3 turn = glm::mat3_cast(glm::normalize(glm::quat(0.3F, 0.5F, -0.6F, 0.2F)));
  std::vector<PointPair> pairs;
  for (const glm::vec3 p : {glm::vec3(1, 2, 3), glm::vec3(-4, 0, 2), glm::vec3(5, -1, 0),
                            glm::vec3(0, 7, -3), glm::vec3(2, 2, 9)}) {
    pairs.push_back({12.5F * (turn * p) + glm::vec3(10, -20, 30), p, FaceFeature::kNone});
  }
  const Similarity fit = FitSimilarity(pairs);
  EXPECT_NEAR(fit.scale, 12.5F, 0.01F);
  for (const auto& pair : pairs) EXPECT_LT(glm::distance(fit(pair.to), pair.from), 0.02F);
}

}  // namespace
}  // namespace fsm
