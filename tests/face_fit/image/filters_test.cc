#include "face_fit/image/filters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

namespace facefit {
namespace {

FloatImage Of(int width, int height, std::initializer_list<float> values) {
  FloatImage image(width, height);
  image.values = values;
  return image;
}

TEST(FiltersTest, AtTheEdgesTheMeanIsOfWhatLiesInTheImage) {
  const FloatImage out = Blurred(Of(3, 2, {1, 2, 3, 4, 5, 6}), 1);
  EXPECT_FLOAT_EQ(out.values[0], 3);
  EXPECT_FLOAT_EQ(out.values[1], 3.5F);
  EXPECT_FLOAT_EQ(out.values[5], 4);
  for (const float v : Blurred(Of(3, 2, {1, 2, 3, 4, 5, 6}), 9).values) EXPECT_FLOAT_EQ(v, 3.5F);
}

TEST(FiltersTest, AClosingFillsWhatIsNarrowAndDarkAndKeepsWhatIsBright) {
  const auto closed = [](const FloatImage& row) {
    const auto out = Closed(
        VectorImage::From(row.width, 1, [&](int x, int) { return glm::vec3(row(x, 0), 0, 7); }), 1);
    return FloatImage::From(row.width, 1, [&](int x, int) { return out(x, 0).r; });
  };
  EXPECT_EQ(closed(Of(7, 1, {5, 5, 1, 5, 9, 5, 5})).values,
            (std::vector<float>{5, 5, 5, 5, 9, 5, 5}));
  EXPECT_EQ(closed(Of(7, 1, {5, 1, 1, 1, 1, 1, 5})).values[3], 1) << "wider than the square";
}

TEST(FiltersTest, AWholeImageThatIsKnownIsNearestToItself) {
  const auto nearest = NearestAbove(FloatImage(5, 4, 1), 0.5F);
  for (std::size_t i = 0; i < nearest.size(); ++i) EXPECT_EQ(nearest[i], i);
}

TEST(FiltersTest, ScalingDownTakesTheMeanByArea) {
  // Three pixels become two: each is one and a half wide.
  const FloatImage out = ScaledDown(Of(3, 1, {0, 6, 12}), 2, 1);
  EXPECT_NEAR(out.values[0], 2, 1e-4F);
  EXPECT_NEAR(out.values[1], 10, 1e-4F);
  const FloatImage same = ScaledDown(Of(2, 2, {1, 2, 3, 4}), 2, 2);
  EXPECT_EQ(same.values, (std::vector<float>{1, 2, 3, 4}));
}

TEST(FiltersTest, OrientationsOfExifAreSetUpright) {
  // 1 2 3
  // 4 5 6   as stored; EXIF 2.32, tag 0x0112, says at which side row and column 0 are to be seen.
  fsm::Image image{.width = 3, .height = 2, .rgba = {}};
  for (std::uint8_t v = 1; v <= 6; ++v) image.rgba.insert(image.rgba.end(), {v, v, v, 255});
  const auto reds = [&](int orientation) {
    std::vector<int> out;
    const fsm::Image turned = OrientedByExif(image, orientation);
    EXPECT_EQ(turned.width, orientation < 5 ? 3 : 2);
    for (std::size_t i = 0; i < turned.rgba.size(); i += 4) out.push_back(turned.rgba[i]);
    return out;
  };
  EXPECT_EQ(reds(1), (std::vector<int>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(reds(2), (std::vector<int>{3, 2, 1, 6, 5, 4}));
  EXPECT_EQ(reds(3), (std::vector<int>{6, 5, 4, 3, 2, 1}));
  EXPECT_EQ(reds(4), (std::vector<int>{4, 5, 6, 1, 2, 3}));
  EXPECT_EQ(reds(5), (std::vector<int>{1, 4, 2, 5, 3, 6}));
  EXPECT_EQ(reds(6), (std::vector<int>{4, 1, 5, 2, 6, 3}));
  EXPECT_EQ(reds(7), (std::vector<int>{6, 3, 5, 2, 4, 1}));
  EXPECT_EQ(reds(8), (std::vector<int>{3, 6, 2, 5, 1, 4}));
}

TEST(KeepConnectedTest, OnlyWhatHangsTogetherWithThePlaceStays) {
  FloatImage image(9, 7);
  const auto at = [&image](int x, int y) -> float& { return image(x, y); };
  for (int x = 0; x < 4; ++x) at(x, 3) = 0.6F;
  at(4, 4) = 0.3F;  // joined by a corner
  at(7, 1) = 1;
  at(2, 6) = 0.05F;  // as good as nothing
  KeepConnected({1, 3}, image);
  EXPECT_EQ(at(3, 3), 0.6F);
  EXPECT_EQ(at(4, 4), 0.3F);
  EXPECT_EQ(at(7, 1), 0);
  EXPECT_EQ(at(2, 6), 0);
  FloatImage same = image;
  KeepConnected({8, 0}, same);
  EXPECT_EQ(same.values, image.values) << "nothing is there to be connected to";
  KeepConnected({-5, 3}, image);
  EXPECT_EQ(at(3, 3), 0.6F) << "the nearest pixel counts";
}

TEST(FiltersTest, TheNearestKnownPointIsFound) {
  FloatImage weight(40, 30);
  weight(3, 4) = weight(30, 20) = 1;
  const auto nearest = NearestAbove(weight, 0.95F);
  EXPECT_EQ(nearest[weight.Index(0, 0)], weight.Index(3, 4));
  EXPECT_EQ(nearest[weight.Index(39, 0)], weight.Index(30, 20));
  EXPECT_EQ(nearest[weight.Index(10, 29)], weight.Index(30, 20));
  EXPECT_EQ(nearest[weight.Index(3, 4)], weight.Index(3, 4));
}

TEST(FiltersTest, TheNearestOfManyKnownPointsIsTheNearest) {
  FloatImage weight(60, 50);
  for (std::uint32_t k = 1, at = 7; k < 40; ++k) {
    at = (at * 1103515245U + 12345U) % 3000U;
    weight.values[at] = 1;
  }
  const auto nearest = NearestAbove(weight, 0.95F);
  const auto far = [](std::size_t a, std::size_t b) {
    return glm::distance(glm::vec2(a % 60, a / 60), glm::vec2(b % 60, b / 60));
  };
  int farther = 0;
  for (std::size_t i = 0; i < weight.values.size(); ++i) {
    float least = 1e9F;
    for (std::size_t k = 0; k < weight.values.size(); ++k) {
      if (weight.values[k] > 0) least = std::min(least, far(i, k));
    }
    EXPECT_LT(far(i, nearest[i]), least + 0.5F) << i;
    farther += far(i, nearest[i]) > least + 1e-3F ? 1 : 0;
  }
  EXPECT_LT(farther, 10) << "of 3000";
}

}  // namespace
}  // namespace facefit
