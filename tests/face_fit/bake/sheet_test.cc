#include "face_fit/bake/sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "tests/face_fit/built_in_figure_test.h"

namespace facefit {
namespace {

class SheetTest : public BuiltInFigureTest {
 protected:
  Sheet Made() const { return MakeSheet(fitted_, fitted_.pose, figure_); }
  /// The pixel over which a vertex lies.
  glm::vec2 Over(const fsm::PhotoHead::SheetVertex& vertex) const {
    return fitted_.pose.PixelOf(vertex.position);
  }
};

TEST_F(SheetTest, IsWrittenFromBackToFront) {
  const Sheet set = Made();
  ASSERT_GT(set.triangles.size(), 600U);
  float last = -1e9F;
  for (std::size_t i = 0; i + 5 < set.triangles.size(); i += 6) {
    const float z =
        set.vertices[set.triangles[i]].position.z + set.vertices[set.triangles[i + 2]].position.z;
    EXPECT_GE(z, last - 1e-3F);
    last = z;
  }
}

TEST_F(SheetTest, GoesOnByACellBeyondTheFigureOnAllSides) {
  // A figure whose edges lie within the photo.
  constexpr int kFrom = 40, kTo = 260;
  for (int y = 0; y < kPhoto; ++y) {
    for (int x = 0; x < kPhoto; ++x) {
      figure_.opacity(x, y) = std::min(x, y) >= kFrom && std::max(x, y) < kTo ? 1.0F : 0.0F;
    }
  }
  const Sheet set = Made();
  glm::vec2 low(kPhoto), high(0);
  for (const std::uint32_t i : set.triangles) {
    // Where the photo shows it, by its place in the image's right half.
    const glm::vec2 texcoord = set.vertices[i].texcoord;
    const glm::vec2 pixel = glm::vec2(2 * texcoord.x - 1, texcoord.y) * float{kPhoto};
    low = glm::min(low, pixel);
    high = glm::max(high, pixel);
  }
  const float cell = 2 * (set.vertices[2].texcoord.x - set.vertices[1].texcoord.x) * kPhoto;
  EXPECT_GT(cell, 4);
  for (const float beyond : {kFrom - low.x, kFrom - low.y, high.x - kTo, high.y - kTo}) {
    EXPECT_GT(beyond, 0.9F * cell);
    EXPECT_LT(beyond, 2.1F * cell);
  }
}

TEST_F(SheetTest, GoesWithTheFaceFromItsExpressionToRest) {
  const Sheet still = Made();
  // In the photo the whole face is 6 mm higher than at rest.
  for (glm::vec3& p : fitted_.vertices) p.y += p.z > 0 ? 6.0F : 0.0F;
  const Sheet moved = Made();
  const glm::vec3 cheek = Galatea().mesh_points()[234].On(Galatea().rest().position);
  const auto motion = [&](glm::vec2 near) {
    float nearest = 1e9F, by = 0;
    for (const auto& vertex : moved.vertices) {
      const float far = glm::distance(glm::vec2(vertex.position), near);
      if (far >= nearest) continue;
      nearest = far;
      // Where the photo shows this, against where it is now.
      const glm::vec2 pixel =
          glm::vec2(2 * vertex.texcoord.x - 1, vertex.texcoord.y) * float{kPhoto};
      const glm::vec3 q = fitted_.pose.ToCamera(vertex.position);
      by = vertex.position.y - fitted_.pose.PositionOf(pixel, q.z).y;
    }
    return by;
  };
  EXPECT_NEAR(motion(glm::vec2(cheek)), -6, 2);
  EXPECT_NEAR(motion(glm::vec2(0, cheek.y + 140)), 0, 0.5F) << "far from the face";
  EXPECT_EQ(still.vertices.size(), moved.vertices.size());
}

TEST_F(SheetTest, NothingOfItLiesBehindEyesAndMouthOfATurnedHead) {
  fitted_.pose.rotation_rad.y = glm::radians(25.0F);
  const Sheet set = Made();
  const auto at = [&](std::size_t point) {
    return Galatea().mesh_points()[point].On(Galatea().rest().position);
  };
  // Within the corners of the mouth, below them, and within the corners of the eyes.
  const glm::vec3 in(5, 0, 0), down(0, 9, 0);
  for (const glm::vec3 opening : {at(78) + in, at(308) - in, at(78) + in - down,
                                  at(308) - in - down, at(33) + in, at(263) - in}) {
    for (std::size_t i = 0; i + 5 < set.triangles.size(); i += 6) {
      const glm::vec3 p = 0.5F * (set.vertices[set.triangles[i]].position +
                                  set.vertices[set.triangles[i + 2]].position);
      // What lies far behind is the hair at the nape.
      if (p.z < opening.z - 80) continue;
      EXPECT_GT(glm::distance(glm::vec2(p), glm::vec2(opening)), 3) << p.x << " " << p.y;
    }
  }
  EXPECT_GT(set.triangles.size(), 600U);
}

TEST_F(SheetTest, NothingOfItLiesBehindTheMouthWhereItsCellsAreWide) {
  // A head that is small in its photo: a cell is 9 mm wide.
  fitted_.pose.focal_px = 452;
  fitted_.pose.rotation_rad.y = glm::radians(15.0F);
  const Sheet set = Made();
  const glm::vec3 right = Galatea().mesh_points()[78].On(Galatea().rest().position),
                  left = Galatea().mesh_points()[308].On(Galatea().rest().position);
  for (std::size_t i = 0; i + 5 < set.triangles.size(); i += 6) {
    const glm::vec3 p = 0.5F * (set.vertices[set.triangles[i]].position +
                                set.vertices[set.triangles[i + 2]].position);
    if (p.z < right.z - 80) continue;
    const bool behind = p.x > right.x && p.x < left.x && p.y < right.y && p.y > right.y - 20;
    EXPECT_FALSE(behind) << p.x << " " << p.y;
  }
}

}  // namespace
}  // namespace facefit
