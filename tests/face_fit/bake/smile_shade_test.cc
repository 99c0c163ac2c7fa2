// A photo of a smile brought to rest: the light on its cheeks.

#include "face_fit/bake/smile_shade.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/bake/smile_folds.h"
#include "tests/face_fit/network_fixture.h"

namespace facefit {
namespace {

/// The built-in head as if a photo of 300 pixels showed it, and a map of one skin with grain, with
/// a band across the cheeks that shines, and the forehead as well. Where the map's skin lies is
/// worked out once; each test has a map of its own.
class SmileShadeTest : public NetworkTest {
 protected:
  static constexpr int kPhoto = 300;
  static void TearDownTestSuite() {
    texels_.reset();
    NetworkTest::TearDownTestSuite();
  }
  void SetUp() override {
    NetworkTest::SetUp();
    if (IsSkipped()) return;
    if (!texels_) {
      texels_ = FindSkinTexels(Galatea());
      const FittedHead fitted = Fitted();
      projections_ = ProjectTexels(fitted, *texels_, fitted.pose);
      HideSelfOccluded(fitted, fitted.pose, projections_);
    }
    map_ = {.width = kMapSize, .height = kMapSize, .rgba = {}};
    for (std::size_t i = 0; i < texels_->size(); ++i) {
      const float y = Height(i);
      const bool band =
          std::abs(y - middle()) < 5 || y > Galatea().head().Landmark("nasion").y + 37;
      const int grain = static_cast<int>(i * 7919 % 13) - 6;
      const auto c = static_cast<std::uint8_t>((band ? 190 : 150) + grain);
      map_.rgba.insert(map_.rgba.end(), {c, c, c, 255});
    }
  }
  static FittedHead Fitted() {
    FittedHead fitted;
    fitted.base = &Galatea();
    fitted.pose.focal_px = 1373;
    fitted.pose.centre_px = {kPhoto / 2, kPhoto / 2};
    fitted.vertices = Galatea().rest().position;
    return fitted;
  }
  glm::vec3 Place(std::size_t point) const {
    return Galatea().mesh_points()[point].On(Galatea().rest().position);
  }
  /// A texel's texel; far below the head if the map shows no skin there.
  static SkinTexel At(std::size_t i) { return (*texels_)[i].value_or(SkinTexel{.y_mm = -1e9F}); }
  static float Height(std::size_t i) { return At(i).y_mm; }
  /// Between nose and mouth, on the cheeks.
  float middle() const { return 0.5F * (Place(2).y + Place(61).y); }
  /// The mean over cheeks at one height.
  float Mean(float y) const {
    float sum = 0, count = 0;
    for (std::size_t i = 0; i < texels_->size(); ++i) {
      const float x = std::abs(At(i).x_mm);
      if (x < 30 || x > 42 || std::abs(Height(i) - y) > 1) continue;
      if (!projections_[i] || projections_[i]->facing < 0.2F) continue;
      sum += map_.rgba[4 * i];
      ++count;
    }
    return sum / count;
  }

  static inline std::optional<SkinTexels> texels_;
  static inline TexelProjections projections_;
  fsm::Image map_;
  FloatImage seen_{kMapSize, kMapSize, 1};
};

TEST_F(SmileShadeTest, SkinIsHiddenAsThePoseGivenSeesItNotAsThatOfTheFit) {
  FittedHead fitted = Fitted();
  CameraPose aside = fitted.pose;
  aside.rotation_rad.y = 0.9F;
  const TexelProjections all = ProjectTexels(fitted, *texels_, aside);
  TexelProjections seen = all, fitted_so = all;
  HideSelfOccluded(fitted, aside, seen);
  fitted.pose = aside;
  HideSelfOccluded(fitted, aside, fitted_so);
  EXPECT_TRUE(seen.values == fitted_so.values);
}

TEST_F(SmileShadeTest, ABandOfShineIsEvenedOutAndGrainStays) {
  const fsm::Image before = map_;
  EXPECT_GT(Mean(middle()) - Mean(middle() - 9), 35);
  RemoveSmileShading(Galatea(), *texels_, seen_, 1, map_);
  EXPECT_LT(std::abs(Mean(middle()) - Mean(middle() - 9)), 16);
  // Neighbours differ as before.
  float rough = 0, was = 0;
  for (std::size_t i = 1; i < texels_->size(); ++i) {
    if (std::abs(std::abs(At(i).x_mm) - 36) > 6 || std::abs(Height(i) - middle()) > 1) continue;
    rough += static_cast<float>(std::abs(map_.rgba[4 * i] - map_.rgba[4 * i - 4]));
    was += static_cast<float>(std::abs(before.rgba[4 * i] - before.rgba[4 * i - 4]));
  }
  EXPECT_GT(rough, 0.7F * was);
}

TEST_F(SmileShadeTest, ForeheadEyesNoseAndLipsStayAsTheyAre) {
  const fsm::Image before = map_;
  RemoveSmileShading(Galatea(), *texels_, seen_, 1, map_);
  for (std::size_t i = 0; i < texels_->size(); ++i) {
    const bool nose = std::abs(At(i).x_mm) < 10 && Height(i) > Place(2).y;
    const bool other = Height(i) > Place(145).y - 8 || nose || At(i).within_lips_mm > -1;
    if (other) {
      ASSERT_EQ(map_.rgba[4 * i], before.rgba[4 * i]) << i;
    }
  }
}

TEST_F(SmileShadeTest, WhatThePhotoDoesNotShowStays) {
  // The photo shows one cheek only; beyond is what was filled in.
  for (std::size_t i = 0; i < texels_->size(); ++i) seen_.values[i] = At(i).x_mm < 0 ? 1 : 0;
  const fsm::Image before = map_;
  RemoveSmileShading(Galatea(), *texels_, seen_, 1, map_);
  int changed = 0;
  for (std::size_t i = 0; i < texels_->size(); ++i) {
    if (At(i).x_mm > 6) {
      ASSERT_EQ(map_.rgba[4 * i], before.rgba[4 * i]) << i;
    }
    changed += map_.rgba[4 * i] != before.rgba[4 * i];
  }
  EXPECT_GT(changed, 1000) << "the other cheek is evened out";
}

TEST_F(SmileShadeTest, SmoothedSkinTakesTheGrainOfTheCheekAboveIt) {
  fsm::Image flat = map_;
  FloatImage smooth(kMapSize, kMapSize);
  const auto spot = [&](std::size_t i) {
    return std::abs(std::abs(At(i).x_mm) - 30) < 4 && std::abs(Height(i) - middle() + 12) < 3;
  };
  for (std::size_t i = 0; i < texels_->size(); ++i) {
    if (!spot(i)) continue;
    smooth.values[i] = 1;
    for (std::size_t c = 0; c < 3; ++c) flat.rgba[4 * i + c] = 150;
  }
  const fsm::Image before = flat;
  GrainFromCheeks(smooth, flat);
  float rough = 0, sum = 0, count = 0;
  for (std::size_t i = 1; i < texels_->size(); ++i) {
    if (!spot(i)) {
      ASSERT_EQ(flat.rgba[4 * i], before.rgba[4 * i]) << "nothing else changes";
      continue;
    }
    rough += std::abs(static_cast<float>(flat.rgba[4 * i]) - 150);
    sum += flat.rgba[4 * i];
    ++count;
  }
  EXPECT_GT(rough / count, 1.5F);
  EXPECT_NEAR(sum / count, 150, 2) << "no colour changes on the mean";
}

TEST_F(SmileShadeTest, WithoutASmileNothingChanges) {
  const fsm::Image before = map_;
  RemoveSmileShading(Galatea(), *texels_, seen_, 0, map_);
  EXPECT_EQ(map_.rgba, before.rgba);
}

}  // namespace
}  // namespace facefit
