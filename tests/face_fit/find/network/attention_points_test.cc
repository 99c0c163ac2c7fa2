#include "face_fit/find/network/attention_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string_view>

#include "face_fit/find/head/portrait_view.h"
#include "face_fit/find/network/face_finder.h"
#include "face_fit/image/photo.h"
#include "face_fit/image/resample.h"
#include "tests/face_fit/network_fixture.h"
#include "tests/support/test_data.h"

namespace facefit {
namespace {

class AttentionTest : public AttentionNetworkTest {
 protected:
  AttentiveFace See(const fsm::Image& image) {
    const auto faces = FindFaces(*networks_, image);
    if (faces.empty()) throw std::runtime_error("no face is seen");
    return attention_->Find(image, faces.front().crop);
  }
};

TEST_F(AttentionTest, IrisesOfPhotosLieOnTheIrises) {
  const auto photos = support::Photos();
  for (const char* name : {"lincoln_1863_gardner.jpg", "collins_nasa.png", "hopper_usnavy.jpg"}) {
    if (!photos.Has(name)) GTEST_SKIP() << photos.Missing();
    const auto photo = ReadPhoto(photos / name);
    ASSERT_TRUE(photo) << photo.error().text;
    const AttentiveFace seen = See(*photo);
    for (const fsm::Side side : fsm::kSides) {
      const auto& iris = seen.iris[side];
      float radius = 0;
      for (std::size_t k = 1; k < 5; ++k) radius += 0.25F * glm::distance(iris[0], iris[k]);
      // An iris is 11.5 to 12 mm wide where outer corners of eyes are 88 to 91 mm apart.
      const float eyes = glm::distance(seen.face.PixelOf(33), seen.face.PixelOf(263));
      EXPECT_NEAR(2 * radius / eyes, 11.7F / 90, 0.03F) << name << " " << fsm::SignOf(side);
      // The disc is darker than what lies beside it on either side, within the eye; but for
      // Lincoln, whose left eye is pale in the shade.
      if (std::string_view(name).starts_with("lincoln")) continue;
      const auto bright = [&](glm::vec2 p) {
        const glm::vec3 c = ColourAt(*photo, p);
        return c.x + c.y + c.z;
      };
      const glm::vec2 across = glm::normalize(seen.face.PixelOf(263) - seen.face.PixelOf(33));
      float within = 0, beside = 0;
      for (const float at : {-0.6F, -0.3F, 0.0F, 0.3F, 0.6F})
        within += bright(iris[0] + at * radius * across) / 5;
      for (const float at : {-1.35F, 1.35F}) beside += bright(iris[0] + at * radius * across) / 2;
      EXPECT_LT(within, 0.9F * beside) << name << " " << fsm::SignOf(side);
    }
  }
}

TEST_F(AttentionTest, PointsOfTheLipsLieOnTheSeamOfAHead) {
  const ObservedHead& base = Galatea();
  const AttentiveFace seen = See(base.portrait().image);
  EXPECT_GT(seen.face.certainty, 0.95F);
  const PortraitView portrait(base.portrait().image.width);
  // Along the seam both may differ; across it, from the line between the two neighbours there.
  const auto off_mm = [&](std::span<const PointIndex> line) {
    float most = 0;
    for (const PointIndex i : line) {
      const glm::vec2 at = seen.face.PixelOf(i);
      float nearest = 1e9F;
      for (std::size_t k = 0; k + 1 < line.size(); ++k) {
        const glm::vec2 a = portrait.PixelOf(base.AtRest(line[k]));
        const glm::vec2 way = portrait.PixelOf(base.AtRest(line[k + 1])) - a;
        const float part = glm::clamp(glm::dot(at - a, way) / glm::dot(way, way), 0.0F, 1.0F);
        nearest = std::min(nearest, glm::distance(at, a + part * way));
      }
      most = std::max(most, nearest);
    }
    return most * portrait.mm_per_pixel();
  };
  // The places on the mesh are where lips touch, a little behind what is seen from the front.
  EXPECT_LT(off_mm(WithCorners(point::kUpperInnerLip, point::kInnerMouthCorners)), 3);
  EXPECT_LT(off_mm(point::kLowerInnerLip), 3.5F);
}

}  // namespace
}  // namespace facefit
