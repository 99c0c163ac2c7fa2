#include "face_fit/tflite/kernels.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <utility>
#include <vector>

#include "tests/face_fit/tflite/one_node.h"

namespace facefit::tflite {
namespace {

const op::Convolution kSameConvolution{{.same_padding = true}};

using Values = std::vector<float>;

/// What one node makes of `input`.
Values Made(Operator op, Shape in, const Values& input, Shape out, std::vector<Tensor> more = {}) {
  return OutputOf(OneNode(std::move(op), in, std::move(more), out), input);
}

/// 3 x 3 pixels of one channel.
constexpr Shape kNine{{1, 3, 3, 1}};
const Values kOneToNine = {1, 2, 3, 4, 5, 6, 7, 8, 9};

TEST(KernelsTest, ConvolutionPadsWithZerosAndSumsItsTaps) {
  // A 3 x 3 filter of ones over a 2 x 2 image of ones sees all four pixels everywhere.
  EXPECT_EQ(Made(kSameConvolution, {{1, 2, 2, 1}}, {1, 2, 3, 4}, {{1, 2, 2, 1}},
                 {Constant({{1, 3, 3, 1}}, Values(9, 1))}),
            Values(4, 10));
}

TEST(KernelsTest, ConvolutionMakesEveryChannelOfAllAndAddsItsBias) {
  // Two filters over pixels of two channels: their sum, and the first less twice the second.
  const std::vector<Tensor> filters = {Constant({{2, 1, 1, 2}}, {1, 1, 1, -2}),
                                       Constant({{1, 1, 1, 2}}, {10, 20})};
  EXPECT_EQ(Made(op::Convolution{}, {{1, 1, 2, 2}}, {1, 2, 3, 4}, {{1, 1, 2, 2}}, filters),
            (Values{13, 17, 17, 15}));
}

TEST(KernelsTest, ConvolutionWithAStrideSkipsPixels) {
  const op::Convolution convolution{{.stride_rows = 2, .stride_columns = 2}};
  EXPECT_EQ(Made(convolution, kNine, kOneToNine, {{1, 2, 2, 1}}, {Constant({{1, 1, 1, 1}}, {10})}),
            (Values{10, 30, 70, 90}));
}

TEST(KernelsTest, PoolingTakesTheGreatestOrTheMeanOfAWindow) {
  op::Pooling pooling{.max = true, .window = {}, .rows = 2, .columns = 2};
  EXPECT_EQ(Made(pooling, kNine, kOneToNine, {{1, 2, 2, 1}}), (Values{5, 6, 8, 9}));
  pooling.max = false;
  EXPECT_EQ(Made(pooling, kNine, kOneToNine, {{1, 2, 2, 1}}), (Values{3, 4, 6, 7}));
}

TEST(KernelsTest, PoolingBeyondTheEdgeCountsOnlyWhatIsThere) {
  // With a stride of 2, the windows at the right and below see one column or row.
  op::Pooling pooling{.max = false,
                      .window = {.same_padding = true, .stride_rows = 2, .stride_columns = 2},
                      .rows = 2,
                      .columns = 2};
  EXPECT_EQ(Made(pooling, kNine, kOneToNine, {{1, 2, 2, 1}}), (Values{3, 4.5F, 7.5F, 9}));
  pooling.max = true;
  EXPECT_EQ(Made(pooling, kNine, {-1, -2, -3, -4, -5, -6, -7, -8, -9}, {{1, 2, 2, 1}}),
            (Values{-1, -3, -7, -9}))
      << "zeros of a padding would be greater";
}

TEST(KernelsTest, DepthwiseConvolutionFiltersEachChannelByItself) {
  // A row of three pixels; the first channel is summed, of the second the left neighbour is taken.
  EXPECT_EQ(
      Made(op::DepthwiseConvolution{{.same_padding = true}}, {{1, 1, 3, 2}}, {1, 10, 2, 20, 3, 30},
           {{1, 1, 3, 2}}, {Constant({{1, 1, 3, 2}}, {1, 1, 1, 0, 1, 0})}),
      (Values{3, 0, 6, 10, 5, 20}));
}

TEST(KernelsTest, TransposeConvolutionPaintsABlockForEachPixel) {
  EXPECT_EQ(Made(op::TransposeConvolution{}, {{1, 1, 2, 1}}, {1, 10}, {{1, 2, 4, 1}},
                 {Constant({{1, 2, 2, 1}}, {1, 2, 3, 4})}),
            (Values{1, 2, 10, 20, 3, 4, 30, 40}));
}

TEST(KernelsTest, ResizingIsBilinearByEitherConvention) {
  const Shape two{{1, 1, 2, 1}}, four{{1, 1, 4, 1}};
  EXPECT_EQ(Made(op::ResizeBilinear{}, two, {0, 8}, four), (Values{0, 4, 8, 8}));
  EXPECT_EQ(Made(op::ResizeBilinear{.half_pixel_centres = true}, two, {0, 8}, four),
            (Values{0, 2, 6, 8}));
  EXPECT_EQ(Made(op::ResizeBilinear{.align_corners = true}, two, {0, 9}, four),
            (Values{0, 3, 6, 9}));
}

Tensor PaddingBy(std::vector<std::int32_t> integers) {
  return {.shape = {{1, 1, 4, 2}}, .constant = true, .values = {}, .integers = std::move(integers)};
}

TEST(KernelsTest, PaddingPutsZerosBeforeAndAfterEachAxis) {
  EXPECT_EQ(Made(op::Pad{}, {{1, 1, 2, 1}}, {1, 2}, {{1, 2, 4, 1}},
                 {PaddingBy({0, 0, 1, 0, 1, 1, 0, 0})}),
            (Values{0, 0, 0, 0, 0, 1, 2, 0}));
  EXPECT_EQ(Made(op::Pad{}, {{1, 1, 2, 1}}, {1, 2}, {{1, 1, 2, 3}},
                 {PaddingBy({0, 0, 0, 0, 0, 0, 1, 1})}),
            (Values{0, 1, 0, 0, 2, 0}));
  EXPECT_THROW(Network(OneNode(op::Pad{}, {{1, 1, 2, 1}}, {PaddingBy({1, 0, 0, 0, 0, 0, 0, 0})},
                               {{2, 1, 2, 1}})),
               BadModel)
      << "a second image";
}

TEST(KernelsTest, ConcatenationPutsBlocksAfterEachOther) {
  EXPECT_EQ(Made(op::Concatenation{.axis = 1}, {{1, 1, 2, 2}}, {1, 2, 3, 4}, {{1, 1, 3, 2}},
                 {Constant({{1, 1, 1, 2}}, {5, 6})}),
            (Values{1, 2, 3, 4, 5, 6}));
  EXPECT_THROW(Network(OneNode(op::Concatenation{.axis = 0}, {{1, 1, 2, 2}},
                               {Constant({{1, 1, 1, 2}}, {5, 6})}, {{1, 1, 3, 2}})),
               BadModel);
}

TEST(KernelsTest, HardSwishIsNothingBelowMinusThreeAndTheNumberAboveThree) {
  EXPECT_EQ(Made(op::HardSwish{}, {{1, 1, 5, 1}}, {-4, -1.5F, 0, 1.5F, 6}, {{1, 1, 5, 1}}),
            (Values{0, -0.375F, 0, 1.125F, 6}));
}

TEST(KernelsTest, PreluScalesNegativesByChannel) {
  EXPECT_EQ(Made(op::Prelu{}, {{1, 1, 2, 2}}, {-4, -4, 3, 2}, {{1, 1, 2, 2}},
                 {Constant({{1, 1, 1, 2}}, {0.5F, 0.25F})}),
            (Values{-2, -1, 3, 2}));
}

TEST(KernelsTest, AddAndMultiplyTakeAsManyNumbersOneForEachChannelOrOne) {
  const Shape two{{1, 1, 2, 2}};
  const Tensor all = Constant(two, {1, 2, 3, 4}), channels = Constant({{1, 1, 1, 2}}, {10, 100}),
               one = Constant({{1, 1, 1, 1}}, {5});
  EXPECT_EQ(Made(op::Add{}, two, {1, 2, 3, 4}, two, {all}), (Values{2, 4, 6, 8}));
  EXPECT_EQ(Made(op::Add{}, two, {1, 2, 3, 4}, two, {channels}), (Values{11, 102, 13, 104}));
  EXPECT_EQ(Made(op::Add{}, two, {1, 2, 3, 4}, two, {one}), (Values{6, 7, 8, 9}));
  EXPECT_EQ(Made(op::Multiply{}, two, {1, 2, 3, 4}, two, {all}), (Values{1, 4, 9, 16}));
  EXPECT_EQ(Made(op::Multiply{}, two, {1, 2, 3, 4}, two, {channels}), (Values{10, 200, 30, 400}));
}

TEST(KernelsTest, LogisticIsAHalfAtNothing) {
  const Values made = Made(op::Logistic{}, {{1, 1, 3, 1}}, {0, 1, -1}, {{1, 1, 3, 1}});
  EXPECT_EQ(made[0], 0.5F);
  EXPECT_FLOAT_EQ(made[1], 0.73105858F);  // e / (1 + e)
  EXPECT_FLOAT_EQ(made[1] + made[2], 1);
}

TEST(KernelsTest, ReluLeavesOutNegatives) {
  EXPECT_EQ(Made(op::Relu{}, {{1, 1, 3, 1}}, {-2, 0, 7}, {{1, 1, 3, 1}}), (Values{0, 0, 7}));
}

TEST(KernelsTest, ReshapeAndDequantizeKeepTheNumbers) {
  EXPECT_EQ(Made(op::Reshape{}, {{1, 1, 2, 2}}, {1, 2, 3, 4}, {{1, 4, 1, 1}}),
            (Values{1, 2, 3, 4}));
  EXPECT_EQ(Made(op::Dequantize{}, {{1, 1, 2, 1}}, {1, 2}, {{1, 1, 2, 1}}), (Values{1, 2}));
}

TEST(KernelsTest, ActivationsCutOffWhatIsBelowNothingAndAboveSix) {
  for (const auto& [activation, expected] : {std::pair(Activation::kNone, Values{-1, 3, 9}),
                                             {Activation::kRelu, {0, 3, 9}},
                                             {Activation::kRelu6, {0, 3, 6}}}) {
    Values values = {-1, 3, 9};
    Activate(activation, values);
    EXPECT_EQ(values, expected);
  }
}

Model Slice(Shape in, std::vector<std::int32_t> begin, std::vector<std::int32_t> end,
            std::vector<std::int32_t> step, Shape out, int end_mask = 0) {
  return OneNode(op::StridedSlice{.end_mask = end_mask}, in,
                 {Integers(std::move(begin)), Integers(std::move(end)), Integers(std::move(step))},
                 out);
}

TEST(KernelsTest, StridedSliceTakesEveryPlaceOfEveryAxisBetweenBeginAndEnd) {
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

TEST(KernelsTest, StridedSliceWhatLiesBeyondTheInputIsRefused) {
  const Shape in{{1, 3, 4, 2}}, out{{1, 2, 2, 1}};
  EXPECT_THROW(Network(Slice(in, {0, 1, 0, 1}, {1, 4, 4, 2}, {1, 1, 2, 1}, out)), BadModel);
  EXPECT_THROW(Network(Slice(in, {0, -1, 0, 1}, {1, 3, 4, 2}, {1, 1, 2, 1}, out)), BadModel);
  EXPECT_THROW(Network(Slice(in, {0, 1, 0, 1}, {1, 3, 4, 2}, {1, 0, 2, 1}, out)), BadModel);
  EXPECT_THROW(Network(Slice(in, {0, 1, 0, 1}, {1, 3, 4, 2}, {1, 1, 1, 1}, out)), BadModel);
}

constexpr Shape kMatrix{{1, 1, 4, 4}};

TEST(KernelsTest, LandmarksToMatrixLaysAnImageOverThePointsAlongTheLineOfTwo) {
  // Points of a box 8 wide and 4 high about (20, 10), turned by 90 degrees: its x axis runs down.
  op::LandmarksToMatrix options{.points = {0, 1, 2, 3},
                                .left = 0,
                                .right = 1,
                                .scale_x = 1.5F,
                                .scale_y = 1.5F,
                                .rows = 16,
                                .columns = 16};
  const std::vector<float> points = {22, 6, 0, 22, 14, 0, 18, 6, 0, 18, 14, 0};
  const auto m = OutputOf(OneNode(options, {{1, 1, 4, 3}}, {}, kMatrix), points);
  const auto at = [&m](float x, float y) {
    return glm::vec2(m[0] * x + m[1] * y + m[3], m[4] * x + m[5] * y + m[7]);
  };
  EXPECT_LT(glm::distance(at(8, 8), {20, 10}), 1e-4F) << "the middle";
  EXPECT_LT(glm::distance(at(0, 0), {23, 4}), 1e-4F) << "the upper left corner";
  EXPECT_LT(glm::distance(at(16, 0), {23, 16}), 1e-4F) << "the upper right corner";
  EXPECT_LT(glm::distance(at(0, 16), {17, 4}), 1e-4F) << "the lower left corner";
}

TEST(KernelsTest, LandmarksToMatrixPointsThatAreNotThereAreRefused) {
  const op::LandmarksToMatrix options{
      .points = {0, 4}, .left = 0, .right = 1, .rows = 16, .columns = 16};
  EXPECT_THROW(Network(OneNode(options, {{1, 1, 4, 3}}, {}, kMatrix)), BadModel);
}

TEST(KernelsTest, TransformTensorSamplesBetweenTheMiddlesOfPixels) {
  // Two pixels a pixel, moved half a pixel to the right: of columns 0 1 2 are seen 0.25,
  // 0.75, 1.25, 1.75.
  const std::vector<float> matrix = {0.5F, 0, 0, 0.5F, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const auto model = [&](Shape out) {
    return OneNode(op::TransformTensor{}, {{1, 1, 3, 1}}, {Constant(kMatrix, matrix)}, out);
  };
  const std::vector<float> expected = {2.5F, 7.5F, 12.5F, 17.5F, 0};
  EXPECT_EQ(OutputOf(model({{1, 1, 5, 1}}), {0, 10, 20}), expected)
      << "beyond the last middle is nothing";
  EXPECT_THROW(Network(model({{1, 1, 4, 2}})), BadModel);
}

TEST(KernelsTest, TransformLandmarksMovesXAndYAndLeavesZ) {
  const std::vector<float> matrix = {0, -2, 9, 5, 2, 0, 9, 7, 0, 0, 1, 0, 0, 0, 0, 1};
  const auto model = [&](int each, Shape of) {
    return OneNode(op::TransformLandmarks{}, {{1, 1, 2, each}}, {Constant(of, matrix)},
                   {{1, 1, 2, each}});
  };
  EXPECT_EQ(OutputOf(model(2, kMatrix), {1, 2, 3, 4}), (std::vector<float>{1, 9, -3, 13}));
  EXPECT_EQ(OutputOf(model(3, kMatrix), {1, 2, 8, 3, 4, 8}),
            (std::vector<float>{1, 9, 8, -3, 13, 8}));
  EXPECT_THROW(Network(model(2, {{1, 1, 2, 8}})), BadModel);
  EXPECT_THROW(Network(model(4, kMatrix)), BadModel);
}

}  // namespace
}  // namespace facefit::tflite
