#include "face_fit/bake/side_photo_blend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/trigonometric.hpp>

#include "face_fit/bake/openings.h"
#include "face_fit/image/pixels.h"
#include "tests/face_fit/network_fixture.h"

namespace facefit {
namespace {

/// The built-in head in a photo from the front and in one from its left side, as large.
class SidePhotoBlendTest : public NetworkTest {
 protected:
  static constexpr int kSide = 700;
  static constexpr std::uint8_t kSkin = 120, kWhite = 250;

  void SetUp() override {
    NetworkTest::SetUp();
    if (IsSkipped()) return;
    fitted_.base = &Galatea();
    fitted_.pose = {.focal_px = 2000, .centre_px = {kSide / 2, kSide / 2}};
    fitted_.vertices = Galatea().rest().position;
    view_.pose = fitted_.pose;
    view_.pose.rotation_rad.y = glm::radians(-40.0F);
    view_.face = FaceIn(view_.pose);
    view_.figure.colours = fsm::FilledImage(kSide, kSide);
    Fill(view_.figure.colours, [](glm::vec2) { return kSkin; });
    texels_ = FindSkinTexels(Galatea());
    front_ = ProjectTexels(fitted_, texels_, fitted_.pose);
    HideSelfOccluded(fitted_, fitted_.pose, front_);
    Fill(map_.image, [](glm::vec2) { return kSkin; });
  }
  FoundFace FaceIn(const CameraPose& pose) const {
    FoundFace face;
    for (PointIndex i = 0; i < kNetworkPoints; ++i) {
      face.points[i] = glm::vec3(pose.PixelOf(fitted_.PositionOf(i)), 0);
    }
    return face;
  }
  template <typename Light>
  static void Fill(fsm::Image& image, Light light) {
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const std::uint8_t grey = light(glm::vec2(x, y) + 0.5F);
        SetRgb(image, image.Index(x, y), glm::vec3(grey));
      }
    }
  }
  std::uint8_t Brightest() const {
    std::uint8_t most = 0;
    for (std::size_t i = 0; i < map_.image.rgba.size(); i += 4) {
      most = std::max(most, map_.image.rgba[i]);
    }
    return most;
  }

  FittedHead fitted_;
  PosedSidePhoto view_;
  SkinTexels texels_;
  TexelProjections front_;
  SkinMap map_;
};

TEST_F(SidePhotoBlendTest, SkinThatOnlyTheSidePhotoShowsTakesItsColours) {
  Fill(view_.figure.colours, [](glm::vec2) -> std::uint8_t { return 180; });
  BlendSidePhoto(fitted_, view_, texels_, front_, map_);
  EXPECT_EQ(Brightest(), 180) << "no skin is seen in both, so the light is not changed";
  EXPECT_GT(std::ranges::max(map_.coverage.values), 0.9F);
}

TEST_F(SidePhotoBlendTest, WhatTheSidePhotoShowsBetweenLidsIsNotPaintedOnTheirRims) {
  const PhotoOpenings front_openings(FaceIn(fitted_.pose), fitted_.pose.PixelsPerMm());
  for (std::size_t i = 0; i < front_.values.size(); ++i) {
    if (!front_[i] || front_[i]->facing < 0.3F) continue;
    const float skin = front_openings.SkinShare(front_[i]->pixel);
    map_.outside_openings.values[i] = skin;
    map_.coverage.values[i] = skin;
  }
  const PhotoOpenings openings(view_.face, view_.pose.PixelsPerMm());
  Fill(view_.figure.colours,
       [&](glm::vec2 p) { return openings.SkinShare(p) < 1 ? kWhite : kSkin; });
  BlendSidePhoto(fitted_, view_, texels_, front_, map_);
  // Between a pixel of the eye and one of the skin colours are mixed.
  EXPECT_LT(Brightest(), (kSkin + kWhite) / 2);
}

}  // namespace
}  // namespace facefit
