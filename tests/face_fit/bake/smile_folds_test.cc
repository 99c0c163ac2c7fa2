#include "face_fit/bake/smile_folds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "tests/face_fit/grey_image.h"

namespace facefit {
namespace {

TEST(SmileFoldsTest, ADarkFoldIsFilledAndABeardIsNot) {
  FoundFace face;
  float y = 60;
  for (const auto& [right, left] :
       {std::pair(129, 358), {203, 423}, {206, 426}, {216, 436}, {212, 432}}) {
    face.points[static_cast<std::size_t>(right)] = glm::vec3(60, y, 0);
    face.points[static_cast<std::size_t>(left)] = glm::vec3(140, y, 0);
    y += 20;
  }
  const fsm::Image before = GreyImage(200, [](glm::vec2 p) {
    if (p.x > 120) return p.y > 100 ? 60 : 160;  // a beard over half of the left fold
    return p.y > 50 && std::abs(p.x - 60) < 3 ? 80 : 160;
  });
  const auto lit = [&face, &before](float smile, int x, int row) {
    fsm::Image photo = before;
    FillSmileFolds(face, smile, 2, photo);
    return static_cast<int>(photo.rgba[static_cast<std::size_t>(4 * (200 * row + x))]);
  };
  EXPECT_EQ(lit(0, 60, 100), 80) << "of a face at rest they are its own";
  EXPECT_NEAR(lit(1, 60, 100), 160, 8);
  EXPECT_NEAR(lit(0.5F, 60, 100), 120, 6);
  EXPECT_EQ(lit(1, 140, 125), 60);
  EXPECT_EQ(lit(1, 20, 100), 160);
}

}  // namespace
}  // namespace facefit
