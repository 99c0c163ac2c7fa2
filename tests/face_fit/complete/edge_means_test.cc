#include "face_fit/complete/edge_means.h"

#include <gtest/gtest.h>

namespace facefit {
namespace {

TEST(EdgeMeansTest, NearPixelsCountMoreAndUnknownOnesNothing) {
  EdgeMeans edge;
  for (int i = 0; i < 20; ++i) edge.Add(glm::vec3(i < 10 ? 100 : 200), i == 5 ? 0 : 1);
  EXPECT_FLOAT_EQ(edge.MeanAround(2, 1).x, 100);
  EXPECT_FLOAT_EQ(edge.MeanAround(17, 2).x, 200);
  EXPECT_NEAR(edge.MeanAround(10, 6).x, 150, 6);
  EXPECT_FLOAT_EQ(edge.MeanAround(5.5F, 0.2F).w, 0);
  EXPECT_FLOAT_EQ(edge.MeanAround(-30, 3).x, 100) << "beyond its end the last one goes on";
  EXPECT_NEAR(edge.All().x, (9 * 100 + 10 * 200) / 19.0F, 0.01F);
  EXPECT_EQ(EdgeMeans().MeanAround(3, 2), glm::vec4(0));
}

}  // namespace
}  // namespace facefit
