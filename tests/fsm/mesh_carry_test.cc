#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <vector>

#include "fsm/head/head.h"
#include "fsm/mesh/carry.h"
#include "fsm/mesh/head_file.h"
#include "fsm/mesh/head_points.h"
#include "fsm/mesh/surface_index.h"

namespace fsm {
namespace {

/// Two built-in faces: what the second does by itself is the truth for what is carried to it.
class CarryTest : public testing::Test {
 protected:
  void SetUp() override {
    from_ = Head::Make("galatea", false);
    to_ = Head::Make(Head::Identities()[1].name, false);
    from_->Evaluate({}, from_rest_);
    to_->Evaluate({}, to_rest_);
    flesh_ = FleshOf(from_->topology());
    ChoosePairs();
    carry_ =
        std::make_unique<Carry>(CarrySurface{from_rest_.position, flesh_},
                                CarrySurface{to_rest_.position, FleshOf(to_->topology())}, pairs_);
  }

  /// A hundred and some places as a landmark detector would give them, lips and lids named.
  void ChoosePairs() {
    const glm::vec3 stomion = from_->Landmark("stomion");
    std::vector<bool> lip(from_rest_.position.size(), false);
    for (const auto& part : from_->topology().parts) {
      if (part.material != Material::kLip) continue;
      for (std::uint32_t k = 0; k < part.index_count; ++k) {
        lip[from_->topology().indices[part.first_index + k]] = true;
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
      PlacePair pair{p, to_rest_.position[v], FacePart::kPlain};
      if (lip[v] && std::abs(p.y - stomion.y) > 3 && std::abs(p.x) < 16) {
        pair.part = p.y > stomion.y ? FacePart::kUpperLip : FacePart::kLowerLip;
      }
      for (const auto& eye : from_->topology().eyes) {
        const glm::vec3 d = p - eye.centre;
        if (glm::length(d) < 15 && std::abs(d.y) > 4) {
          pair.part = d.y > 0 ? FacePart::kUpperLid : FacePart::kLowerLid;
        }
      }
      pairs_.push_back(pair);
    }
  }

  /// Mean error over what really moves, as part of how far it moves.
  float ErrorOf(const FaceState& state) const {
    HeadVertices a, b;
    from_->Evaluate(state, a);
    to_->Evaluate(state, b);
    std::vector<glm::vec3> by(a.position.size()), carried(b.position.size(), glm::vec3(0));
    for (std::size_t i = 0; i < by.size(); ++i) by[i] = a.position[i] - from_rest_.position[i];
    carry_->Apply(by, carried);
    std::vector<bool> skin(b.position.size(), false);
    for (const auto& part : to_->topology().parts) {
      if (part.material != Material::kSkin && part.material != Material::kLip) continue;
      for (std::uint32_t k = 0; k < part.index_count; ++k) {
        skin[to_->topology().indices[part.first_index + k]] = true;
      }
    }
    float most = 0, error = 0, motion = 0;
    for (std::size_t i = 0; i < b.position.size(); ++i) {
      most = std::max(most, glm::distance(b.position[i], to_rest_.position[i]));
    }
    for (std::size_t i = 0; i < carried.size(); ++i) {
      const glm::vec3 truth = b.position[i] - to_rest_.position[i];
      if (!skin[i] || glm::length(truth) < 0.05F * most) continue;
      error += glm::distance(carried[i], truth);
      motion += glm::length(truth);
    }
    EXPECT_GT(motion, 10) << "nothing moves";
    return error / std::max(motion, 1e-6F);
  }

  std::unique_ptr<Head> from_, to_;
  HeadVertices from_rest_, to_rest_;
  std::vector<std::uint32_t> flesh_;
  std::vector<PlacePair> pairs_;
  std::unique_ptr<Carry> carry_;
};

TEST_F(CarryTest, UnitsCarriedToAnotherFaceAreNearlyItsOwn) {
  float sum = 0;
  constexpr int kUnits[] = {1, 2, 4, 6, 9, 10, 12, 15, 16, 17, 18, 20, 22, 25, 26, 27};
  for (const int unit : kUnits) {
    FaceState state;
    state.au_left[static_cast<std::size_t>(unit)] = state.au_right[static_cast<std::size_t>(unit)] =
        1;
    const float error = ErrorOf(state);
    RecordProperty("AU" + std::to_string(unit), std::to_string(error));
    std::printf("AU %2d  error %.1f %%\n", unit, static_cast<double>(100 * error));
    EXPECT_LT(error, 0.25F) << unit;
    sum += error;
  }
  EXPECT_LT(sum / std::size(kUnits), 0.15F);
}

TEST_F(CarryTest, LipsAndLidsAreNeverTakenForEachOther) {
  // The lower lip falls with the jaw, the upper does not; the upper lid closes, the lower hardly.
  const auto upper_error = [&](const FaceState& state, auto chosen) {
    HeadVertices a, b;
    from_->Evaluate(state, a);
    to_->Evaluate(state, b);
    std::vector<glm::vec3> by(a.position.size()), carried(b.position.size(), glm::vec3(0));
    for (std::size_t i = 0; i < by.size(); ++i) by[i] = a.position[i] - from_rest_.position[i];
    carry_->Apply(by, carried);
    float worst = 0;
    for (const std::uint32_t v : FleshOf(to_->topology())) {
      if (!chosen(v)) continue;
      worst = std::max(worst, std::abs(carried[v].y - (b.position[v].y - to_rest_.position[v].y)));
    }
    return worst;
  };
  FaceState jaw;
  jaw.au_left[27] = jaw.au_right[27] = 1;
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
  shut.blink_left = 1;
  const glm::vec3 eye = to_->topology().eyes[1].centre;
  const float lid = upper_error(shut, [&](std::uint32_t v) {
    const glm::vec3 d = to_rest_.position[v] - eye;
    return std::abs(d.x) < 8 && std::abs(d.y) < 9 && d.z > 8;
  });
  EXPECT_LT(lid, 3.5F);
}

TEST(CarryRefusesTest, TooFewPlaces) {
  const std::vector<glm::vec3> place(3, glm::vec3(0));
  const std::vector<std::uint32_t> triangle{0, 1, 2};
  const std::vector<PlacePair> pairs(7);
  EXPECT_THROW(Carry({place, triangle}, {place, triangle}, pairs), std::runtime_error);
}

TEST(HeadPointsTest, WhatIsWrittenIsReadAgain) {
  HeadPoints points;
  for (int i = 0; i < 9; ++i) {
    points.pairs.push_back({{i, 2, 3}, {4, 5, 0.25F * static_cast<float>(i)}, FacePart::kLowerLip});
  }
  const auto read = ParseHeadPoints("p", FormatHeadPoints(points));
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(read->face, "galatea");
  ASSERT_EQ(read->pairs.size(), 9U);
  EXPECT_EQ(read->pairs[8].to.z, 2.0F);
  EXPECT_EQ(read->pairs[8].part, FacePart::kLowerLip);
}

TEST(HeadPointsTest, DamageIsToldWithItsLine) {
  const auto text = [](const char* bad) { return std::string("face galatea\n") + bad; };
  for (const auto& [bad, words] : {std::pair("point plain 1 2 3 4 5\n", "p:2: face NAME"),
                                   std::pair("point nose 1 2 3 4 5 6\n", "p:2: plain, upper_lip"),
                                   std::pair("point plain 1 2 3 4 5 nan\n", "p:2: six numbers"),
                                   std::pair("", "at least eight")}) {
    const auto read = ParseHeadPoints("p", text(bad));
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().text.find(words), std::string::npos) << read.error().text;
  }
}

TEST(SimilarityTest, TurnSizeAndPlaceAreFound) {
  const glm::mat3 turn = glm::mat3_cast(glm::normalize(glm::quat(0.3F, 0.5F, -0.6F, 0.2F)));
  std::vector<PlacePair> pairs;
  for (const glm::vec3 p : {glm::vec3(1, 2, 3), glm::vec3(-4, 0, 2), glm::vec3(5, -1, 0),
                            glm::vec3(0, 7, -3), glm::vec3(2, 2, 9)}) {
    pairs.push_back({12.5F * (turn * p) + glm::vec3(10, -20, 30), p, FacePart::kPlain});
  }
  const Similarity fit = FitSimilarity(pairs);
  EXPECT_NEAR(fit.scale, 12.5F, 0.01F);
  for (const auto& pair : pairs) EXPECT_LT(glm::distance(fit(pair.to), pair.from), 0.02F);
}

}  // namespace
}  // namespace fsm
