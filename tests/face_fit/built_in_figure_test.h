#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "face_fit/find/figure/matte.h"
#include "face_fit/fit/fitted_head.h"
#include "tests/face_fit/network_fixture.h"

namespace facefit {

/// The built-in head as if a photo showed it, with shoulders that the photo's sides cut off.
class BuiltInFigureTest : public NetworkTest {
 protected:
  static constexpr int kPhoto = 300;
  void SetUp() override {
    NetworkTest::SetUp();
    if (IsSkipped()) return;
    fitted_.base = &Galatea();
    fitted_.pose.focal_px = 1373;
    fitted_.pose.centre_px = {kPhoto / 2, kPhoto / 2};
    fitted_.vertices = Galatea().rest().position;
    for (const glm::vec3 at : {glm::vec3(0), {50, 0, 0}, {0, 50, 0}, {0, 0, 50}, {50, 50, 20}}) {
      fitted_.warp_points.push_back({at, glm::vec3(0)});
    }
    for (int y = 0; y < kPhoto; ++y) {
      for (int x = 0; x < kPhoto; ++x) {
        const float off = std::abs(static_cast<float>(x - kPhoto / 2));
        const bool head = glm::length(glm::vec2(off, y - kPhoto / 2 + 10)) < 100;
        const bool body = static_cast<float>(y) > Shoulder(off);
        figure_.opacity(x, y) = head || body ? 1.0F : 0.0F;
      }
    }
    figure_.colours.rgba.assign(static_cast<std::size_t>(4 * kPhoto * kPhoto), 200);
  }
  static float Shoulder(float off) { return 240 + 0.3F * std::max(off - 40, 0.0F); }

  FittedHead fitted_;
  FigureCutout figure_{{.width = kPhoto, .height = kPhoto, .rgba = {}}, FloatImage(kPhoto, kPhoto)};
};

}  // namespace facefit
