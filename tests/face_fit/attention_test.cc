// MediaPipe's landmark network with attention: its operators one by one, and what it sees of photos
// and of heads whose form is known.

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/find/head/portrait_view.h"
#include "face_fit/find/network/attention_points.h"
#include "face_fit/picture/photo.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/tflite/flex_buffer.h"
#include "face_fit/watch/face_watch.h"
#include "tests/face_fit/network_fixture.h"
#include "tests/support/test_data.h"

namespace facefit {
namespace {

Tensor Variable(Shape shape) {
  return {.shape = shape, .constant = false, .values = {}, .counts = {}};
}
Tensor Numbers(std::vector<float> values, Shape shape) {
  return {.shape = shape, .constant = true, .values = std::move(values), .counts = {}};
}
Tensor Counts(std::vector<std::int32_t> counts) {
  const int n = static_cast<int>(counts.size());
  return {.shape = {{1, 1, 1, n}}, .constant = true, .values = {}, .counts = std::move(counts)};
}

/// One step whose first input is the network's.
Model OneStep(Step step, std::vector<Tensor> tensors) {
  Model model;
  model.tensors = std::move(tensors);
  step.output = static_cast<int>(model.tensors.size()) - 1;
  model.steps = {std::move(step)};
  model.inputs = {0};
  model.outputs = {static_cast<int>(model.tensors.size()) - 1};
  return model;
}

std::vector<float> OutputOf(Model model, const std::vector<float>& input) {
  Network network(std::move(model));
  network.Run(input);
  const auto output = network.output(0);
  return {output.begin(), output.end()};
}

Model Slice(Shape in, std::vector<std::int32_t> begin, std::vector<std::int32_t> end,
            std::vector<std::int32_t> by, Shape out, int end_mask = 0) {
  return OneStep(
      {.op = op::StridedSlice{.end_mask = end_mask}, .inputs = {0, 1, 2, 3}, .output = 0},
      {Variable(in), Counts(std::move(begin)), Counts(std::move(end)), Counts(std::move(by)),
       Variable(out)});
}

TEST(StridedSliceTest, TakesEveryPlaceOfEveryAxisBetweenBeginAndEnd) {
  std::vector<float> numbers(3 * 4 * 2);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i);
  // Rows 1 and 2, columns 0 and 2, the second channel: (row * 4 + column) * 2 + 1.
  const Shape in{{1, 3, 4, 2}}, out{{1, 2, 2, 1}};
  const std::vector<float> expected = {9, 13, 17, 21};
  EXPECT_EQ(OutputOf(Slice(in, {0, 1, 0, 1}, {1, 3, 4, 2}, {1, 1, 2, 1}, out), numbers), expected);
  EXPECT_EQ(OutputOf(Slice(in, {0, 1, 0, 1}, {1, 0, 4, 2}, {1, 1, 2, 1}, out, 2), numbers),
            expected)
      << "an end that is left open is that of the input";
}

TEST(StridedSliceTest, WhatLiesBeyondTheInputIsRefused) {
  const Shape in{{1, 3, 4, 2}}, out{{1, 2, 2, 1}};
  EXPECT_THROW(Network(Slice(in, {0, 1, 0, 1}, {1, 4, 4, 2}, {1, 1, 2, 1}, out)), BadModel);
  EXPECT_THROW(Network(Slice(in, {0, -1, 0, 1}, {1, 3, 4, 2}, {1, 1, 2, 1}, out)), BadModel);
  EXPECT_THROW(Network(Slice(in, {0, 1, 0, 1}, {1, 3, 4, 2}, {1, 0, 2, 1}, out)), BadModel);
  EXPECT_THROW(Network(Slice(in, {0, 1, 0, 1}, {1, 3, 4, 2}, {1, 1, 1, 1}, out)), BadModel);
}

constexpr Shape kMatrix{{1, 1, 4, 4}};

TEST(LandmarksToMatrixTest, LaysAPictureOverThePointsAlongTheLineOfTwo) {
  // Points of a box 8 wide and 4 high about (20, 10), turned by 90 degrees: its x axis runs down.
  op::LandmarksToMatrix crop{.points = {0, 1, 2, 3},
                             .left = 0,
                             .right = 1,
                             .scale_x = 1.5F,
                             .scale_y = 1.5F,
                             .rows = 16,
                             .columns = 16};
  const std::vector<float> points = {22, 6, 0, 22, 14, 0, 18, 6, 0, 18, 14, 0};
  const auto m = OutputOf(OneStep({.op = crop, .inputs = {0}, .output = 0},
                                  {Variable({{1, 1, 4, 3}}), Variable(kMatrix)}),
                          points);
  const auto at = [&m](float x, float y) {
    return glm::vec2(m[0] * x + m[1] * y + m[3], m[4] * x + m[5] * y + m[7]);
  };
  EXPECT_LT(glm::distance(at(8, 8), {20, 10}), 1e-4F) << "the middle";
  EXPECT_LT(glm::distance(at(0, 0), {23, 4}), 1e-4F) << "the upper left corner";
  EXPECT_LT(glm::distance(at(16, 0), {23, 16}), 1e-4F) << "the upper right corner";
  EXPECT_LT(glm::distance(at(0, 16), {17, 4}), 1e-4F) << "the lower left corner";
}

TEST(LandmarksToMatrixTest, PointsThatAreNotThereAreRefused) {
  const op::LandmarksToMatrix crop{
      .points = {0, 4}, .left = 0, .right = 1, .rows = 16, .columns = 16};
  EXPECT_THROW(Network(OneStep({.op = crop, .inputs = {0}, .output = 0},
                               {Variable({{1, 1, 4, 3}}), Variable(kMatrix)})),
               BadModel);
}

TEST(TransformTensorTest, SamplesBetweenTheMiddlesOfPixels) {
  // Two pixels a pixel, moved half a pixel to the right: of columns 0 1 2 are seen 0.25,
  // 0.75, 1.25, 1.75.
  const std::vector<float> matrix = {0.5F, 0, 0, 0.5F, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const auto model = [&](Shape out) {
    return OneStep({.op = op::TransformTensor{}, .inputs = {0, 1}, .output = 0},
                   {Variable({{1, 1, 3, 1}}), Numbers(matrix, kMatrix), Variable(out)});
  };
  const std::vector<float> expected = {2.5F, 7.5F, 12.5F, 17.5F, 0};
  EXPECT_EQ(OutputOf(model({{1, 1, 5, 1}}), {0, 10, 20}), expected)
      << "beyond the last middle is nothing";
  EXPECT_THROW(Network(model({{1, 1, 4, 2}})), BadModel);
}

TEST(TransformLandmarksTest, MovesXAndYAndLeavesZ) {
  const std::vector<float> matrix = {0, -2, 9, 5, 2, 0, 9, 7, 0, 0, 1, 0, 0, 0, 0, 1};
  const auto model = [&](int each, Shape of) {
    return OneStep({.op = op::TransformLandmarks{}, .inputs = {0, 1}, .output = 0},
                   {Variable({{1, 1, 2, each}}), Numbers(matrix, of), Variable({{1, 1, 2, each}})});
  };
  EXPECT_EQ(OutputOf(model(2, kMatrix), {1, 2, 3, 4}), (std::vector<float>{1, 9, -3, 13}));
  EXPECT_EQ(OutputOf(model(3, kMatrix), {1, 2, 8, 3, 4, 8}),
            (std::vector<float>{1, 9, 8, -3, 13, 8}));
  EXPECT_THROW(Network(model(2, {{1, 1, 2, 8}})), BadModel);
  EXPECT_THROW(Network(model(4, kMatrix)), BadModel);
}

/// {"a": 0.5, "b": [300, 7], "c": -2} as FlexBuffers lays it out. Offsets count backwards.
std::vector<std::uint8_t> SmallMap() {
  return {// clang-format off
          'a', 0, 'b', 0, 'c', 0,               // 0: the keys
          2, 0, 0x2c, 1, 7, 0,                  // 6: the list of two bytes each, its count before it
          3, 13, 12, 11,                        // 12: count of the keys, and offsets to them
          3, 0, 0, 0, 1, 0, 0, 0, 3, 0, 0, 0,   // 16: offset to the keys at 13, their width, the count
          0, 0, 0, 0x3f,                        // 28: 0.5
          24, 0, 0, 0,                          // 32: offset to the list at 8
          0xfe, 0xff, 0xff, 0xff,               // 36: -2
          3 << 2 | 2, 11 << 2 | 1, 1 << 2 | 2,  // 40: types of the three values
          15, 9 << 2 | 2, 1};                   // 43: offset to the map at 28, its type; a byte wide
  // clang-format on
}

TEST(FlexMapTest, ReadsNumbersAndLists) {
  const auto bytes = SmallMap();
  const FlexMap map = FlexMap::Root(bytes);
  EXPECT_EQ(map.Number("a"), 0.5);
  EXPECT_EQ(map.Wholes("b"), (std::vector<std::int64_t>{300, 7}));
  EXPECT_EQ(map.Whole("c"), -2);
  EXPECT_EQ(map.Number("c"), -2);
  EXPECT_THROW(map.Whole("d"), BadModel);
  EXPECT_THROW(map.Whole("a"), BadModel);
  EXPECT_THROW(map.Wholes("a"), BadModel);
}

TEST(FlexMapTest, DamagedBytesAreRefusedOrReadAsSomethingElse) {
  const auto bytes = SmallMap();
  const auto read = [](const std::vector<std::uint8_t>& from) {
    try {
      const FlexMap map = FlexMap::Root(from);
      map.Number("a");
      map.Wholes("b");
      map.Whole("c");
    } catch (const BadModel&) {
    }
  };
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    read({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n)});
    for (const int other : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
      auto changed = bytes;
      changed[n] = static_cast<std::uint8_t>(other);
      read(changed);
    }
  }
  EXPECT_THROW(FlexMap::Root({}), BadModel);
}

class AttentionTest : public AttentionNetworkTest {
 protected:
  AttentiveFace See(const fsm::Image& picture) {
    const auto faces = FindFaces(*networks_, picture);
    if (faces.empty()) throw std::runtime_error("no face is seen");
    return FindAttentivePoints(*attention_, picture, faces.front().crop);
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
      const float eyes = glm::distance(seen.face.At(33), seen.face.At(263));
      EXPECT_NEAR(2 * radius / eyes, 11.7F / 90, 0.03F) << name << " " << fsm::SignOf(side);
      // The disc is darker than what lies beside it on either side, within the eye; but for
      // Lincoln, whose left eye is pale in the shade.
      if (std::string_view(name).starts_with("lincoln")) continue;
      const auto bright = [&](glm::vec2 p) {
        const glm::vec3 c = ColourAt(*photo, p);
        return c.x + c.y + c.z;
      };
      const glm::vec2 across = glm::normalize(seen.face.At(263) - seen.face.At(33));
      float within = 0, beside = 0;
      for (const float at : {-0.6F, -0.3F, 0.0F, 0.3F, 0.6F})
        within += bright(iris[0] + at * radius * across) / 5;
      for (const float at : {-1.35F, 1.35F}) beside += bright(iris[0] + at * radius * across) / 2;
      EXPECT_LT(within, 0.9F * beside) << name << " " << fsm::SignOf(side);
    }
  }
}

TEST_F(AttentionTest, PointsOfTheLipsLieOnTheSeamOfAHead) {
  const BaseHead& base = Galatea();
  const AttentiveFace seen = See(base.picture);
  EXPECT_GT(seen.face.certainty, 0.95F);
  const PortraitView portrait(base.picture.width);
  // Along the seam both may differ; across it, from the line between the two neighbours there.
  const auto off_mm = [&](std::span<const PointIndex> line) {
    float most = 0;
    for (const PointIndex i : line) {
      const glm::vec2 at = seen.face.At(i);
      float nearest = 1e9F;
      for (std::size_t k = 0; k + 1 < line.size(); ++k) {
        const glm::vec2 a = portrait.Pixel(base.AtRest(line[k]));
        const glm::vec2 way = portrait.Pixel(base.AtRest(line[k + 1])) - a;
        const float part = glm::clamp(glm::dot(at - a, way) / glm::dot(way, way), 0.0F, 1.0F);
        nearest = std::min(nearest, glm::distance(at, a + part * way));
      }
      most = std::max(most, nearest);
    }
    return most * portrait.mm_per_pixel();
  };
  // The places on the mesh are where lips touch, a little behind what is seen from the front.
  EXPECT_LT(off_mm(point::kUpperInnerLip), 3);
  EXPECT_LT(off_mm(point::kLowerInnerLip), 3.5F);
}

}  // namespace
}  // namespace facefit
