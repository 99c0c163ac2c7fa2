#include "face_fit/tflite/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "face_fit/tflite/network.h"
#include "tests/face_fit/tflite_maker.h"

namespace facefit {
namespace {

Tensor Constant(Shape shape, std::vector<float> values) {
  return {.shape = shape, .constant = true, .values = std::move(values), .counts = {}};
}

const op::Convolution kSameConvolution{{.same_padding = true}};

/// One step over two tensors, the second a constant.
Model OneStep(Operator op, Shape in, Tensor argument, Shape out) {
  Model model;
  model.tensors = {Tensor{.shape = in, .constant = false, .values = {}, .counts = {}},
                   std::move(argument),
                   Tensor{.shape = out, .constant = false, .values = {}, .counts = {}}};
  model.steps = {Step{.op = std::move(op), .inputs = {0, 1}, .output = 2}};
  model.inputs = {0};
  model.outputs = {2};
  return model;
}

TEST(NetworkTest, ConvolutionPadsWithZerosAndSumsItsTaps) {
  // A 3 x 3 filter of ones over a 2 x 2 picture of ones sees all four pixels everywhere.
  Network network(OneStep(kSameConvolution, {{1, 2, 2, 1}},
                          Constant({{1, 3, 3, 1}}, std::vector<float>(9, 1)), {{1, 2, 2, 1}}));
  network.Run(std::vector<float>{1, 2, 3, 4});
  for (const float v : network.output(0)) EXPECT_EQ(v, 10);
}

/// What one step makes of `input`. `argument`: its second input, for those that have one.
std::vector<float> Made(Operator op, Shape in, const std::vector<float>& input, Shape out,
                        Tensor argument = Constant({}, {0})) {
  Network network(OneStep(std::move(op), in, std::move(argument), out));
  network.Run(input);
  const auto output = network.output(0);
  return {output.begin(), output.end()};
}
using Values = std::vector<float>;

/// 3 x 3 pixels of one channel.
constexpr Shape kNine{{1, 3, 3, 1}};
const Values kOneToNine = {1, 2, 3, 4, 5, 6, 7, 8, 9};

TEST(NetworkTest, PoolingTakesTheGreatestOrTheMeanOfAWindow) {
  op::Pooling pooling{.greatest = true, .window = {}, .rows = 2, .columns = 2};
  EXPECT_EQ(Made(pooling, kNine, kOneToNine, {{1, 2, 2, 1}}), (Values{5, 6, 8, 9}));
  pooling.greatest = false;
  EXPECT_EQ(Made(pooling, kNine, kOneToNine, {{1, 2, 2, 1}}), (Values{3, 4, 6, 7}));
}

TEST(NetworkTest, PoolingBeyondTheEdgeCountsOnlyWhatIsThere) {
  // With a stride of 2, the windows at the right and below see one column or row.
  op::Pooling pooling{.greatest = false,
                      .window = {.same_padding = true, .stride_rows = 2, .stride_columns = 2},
                      .rows = 2,
                      .columns = 2};
  EXPECT_EQ(Made(pooling, kNine, kOneToNine, {{1, 2, 2, 1}}), (Values{3, 4.5F, 7.5F, 9}));
  pooling.greatest = true;
  EXPECT_EQ(Made(pooling, kNine, {-1, -2, -3, -4, -5, -6, -7, -8, -9}, {{1, 2, 2, 1}}),
            (Values{-1, -3, -7, -9}))
      << "zeros of a padding would be greater";
}

TEST(NetworkTest, DepthwiseConvolutionFiltersEachChannelByItself) {
  // A row of three pixels; the first channel is summed, of the second the left neighbour is taken.
  EXPECT_EQ(
      Made(op::DepthwiseConvolution{{.same_padding = true}}, {{1, 1, 3, 2}}, {1, 10, 2, 20, 3, 30},
           {{1, 1, 3, 2}}, Constant({{1, 1, 3, 2}}, {1, 1, 1, 0, 1, 0})),
      (Values{3, 0, 6, 10, 5, 20}));
}

TEST(NetworkTest, TransposeConvolutionPaintsABlockForEachPixel) {
  EXPECT_EQ(Made(op::TransposeConvolution{}, {{1, 1, 2, 1}}, {1, 10}, {{1, 2, 4, 1}},
                 Constant({{1, 2, 2, 1}}, {1, 2, 3, 4})),
            (Values{1, 2, 10, 20, 3, 4, 30, 40}));
}

TEST(NetworkTest, ResizingIsBilinearByEitherConvention) {
  const Shape two{{1, 1, 2, 1}}, four{{1, 1, 4, 1}};
  EXPECT_EQ(Made(op::ResizeBilinear{}, two, {0, 8}, four), (Values{0, 4, 8, 8}));
  EXPECT_EQ(Made(op::ResizeBilinear{.half_pixel_centres = true}, two, {0, 8}, four),
            (Values{0, 2, 6, 8}));
  EXPECT_EQ(Made(op::ResizeBilinear{.align_corners = true}, two, {0, 9}, four),
            (Values{0, 3, 6, 9}));
}

Tensor PaddingBy(std::vector<std::int32_t> counts) {
  return {.shape = {{1, 1, 4, 2}}, .constant = true, .values = {}, .counts = std::move(counts)};
}

TEST(NetworkTest, PaddingPutsZerosBeforeAndAfterEachAxis) {
  EXPECT_EQ(
      Made(op::Pad{}, {{1, 1, 2, 1}}, {1, 2}, {{1, 2, 4, 1}}, PaddingBy({0, 0, 1, 0, 1, 1, 0, 0})),
      (Values{0, 0, 0, 0, 0, 1, 2, 0}));
  EXPECT_EQ(
      Made(op::Pad{}, {{1, 1, 2, 1}}, {1, 2}, {{1, 1, 2, 3}}, PaddingBy({0, 0, 0, 0, 0, 0, 1, 1})),
      (Values{0, 1, 0, 0, 2, 0}));
  EXPECT_THROW(Network(OneStep(op::Pad{}, {{1, 1, 2, 1}}, PaddingBy({1, 0, 0, 0, 0, 0, 0, 0}),
                               {{2, 1, 2, 1}})),
               BadModel)
      << "a second picture";
}

TEST(NetworkTest, ConcatenationPutsBlocksAfterEachOther) {
  EXPECT_EQ(Made(op::Concatenation{.axis = 1}, {{1, 1, 2, 2}}, {1, 2, 3, 4}, {{1, 1, 3, 2}},
                 Constant({{1, 1, 1, 2}}, {5, 6})),
            (Values{1, 2, 3, 4, 5, 6}));
  EXPECT_THROW(Network(OneStep(op::Concatenation{.axis = 0}, {{1, 1, 2, 2}},
                               Constant({{1, 1, 1, 2}}, {5, 6}), {{1, 1, 3, 2}})),
               BadModel);
}

TEST(NetworkTest, HardSwishIsNothingBelowMinusThreeAndTheNumberAboveThree) {
  EXPECT_EQ(Made(op::HardSwish{}, {{1, 1, 5, 1}}, {-4, -1.5F, 0, 1.5F, 6}, {{1, 1, 5, 1}}),
            (Values{0, -0.375F, 0, 1.125F, 6}));
}

TEST(NetworkTest, MoreWorkThanIsAllowedIsRefused) {
  const Model model = OneStep(kSameConvolution, {{1, 2, 2, 1}},
                              Constant({{1, 3, 3, 1}}, Values(9, 1)), {{1, 2, 2, 1}});
  EXPECT_NO_THROW(Network(model, 37));
  EXPECT_THROW(Network(model, 36), BadModel);
}

TEST(NetworkTest, ABlockTooLargeToCountIsRefused) {
  // 2^16 rows times 2^16 + 1 are 2^16 again in an int.
  constexpr int kRows = 1 << 16;
  Tensor filter = Constant({{1, kRows + 1, 1, 1}}, Values(kRows + 1, 1));
  EXPECT_THROW(Network(OneStep(op::TransposeConvolution{}, {{1, kRows, 1, 1}}, std::move(filter),
                               {{1, kRows, 1, 1}})),
               BadModel);
}

TEST(NetworkTest, PreluScalesNegativesByChannel) {
  Network network(OneStep(op::Prelu{}, {{1, 1, 2, 2}}, Constant({{1, 1, 1, 2}}, {0.5F, 0.25F}),
                          {{1, 1, 2, 2}}));
  network.Run(std::vector<float>{-4, -4, 3, 2});
  const std::vector<float> expected = {-2, -1, 3, 2};
  EXPECT_TRUE(std::ranges::equal(network.output(0), expected));
}

TEST(NetworkTest, SizesThatDoNotMatchAreRefused) {
  const Tensor ones = Constant({{1, 3, 3, 1}}, std::vector<float>(9, 1));
  EXPECT_THROW(Network(OneStep(kSameConvolution, {{1, 2, 2, 1}}, ones, {{1, 5, 2, 1}})), BadModel);
  EXPECT_THROW(Network(OneStep(kSameConvolution, {{1, 2, 2, 2}}, ones, {{1, 2, 2, 1}})), BadModel);
  EXPECT_THROW(Network(OneStep(op::Add{}, {{1, 2, 2, 1}}, ones, {{1, 2, 2, 1}})), BadModel);
  const Tensor point = Constant({{1, 1, 1, 1}}, {1});
  EXPECT_THROW(Network(OneStep(kSameConvolution, {{1, 2, 2, 1}}, point, {{2, 2, 2, 1}})), BadModel)
      << "two pictures of one";
  Model unwritten = OneStep(kSameConvolution, {{1, 2, 2, 1}}, ones, {{1, 2, 2, 1}});
  Model two = unwritten;
  two.inputs = {0, 1};
  EXPECT_THROW(Network(std::move(two)), BadModel);
  unwritten.steps.clear();
  EXPECT_THROW(Network(std::move(unwritten)), BadModel);
}

TEST(ModelTest, AFileWithEveryOperatorIsReadAndRuns) {
  const std::string file = tflite_maker::EveryOperator();
  Model model = Model::Read(std::vector<std::uint8_t>(file.begin(), file.end()));
  EXPECT_EQ(model.steps.size(), 20U);
  ASSERT_EQ(model.steps[1].op.index(), Operator(op::Convolution{}).index());
  EXPECT_EQ(model.steps[1].activation, Activation::kRelu);
  ASSERT_EQ(model.steps[2].op.index(), Operator(op::DepthwiseConvolution{}).index());
  EXPECT_EQ(model.steps[2].activation, Activation::kRelu6);
  Network network(std::move(model));
  network.Run(std::vector<float>(network.input_shape().count(), 1));
  EXPECT_EQ(network.output(0).size(), 64U);
  for (const float v : network.output(0)) EXPECT_TRUE(std::isfinite(v));
}

TEST(ModelTest, AFileThatEndsEarlyIsRefused) {
  const std::string file = tflite_maker::EveryOperator();
  for (std::size_t n = 0; n < file.size(); n += 7) {
    const std::vector<std::uint8_t> bytes(file.begin(),
                                          file.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_THROW(Model::Read(bytes), BadModel) << n;
  }
}

TEST(ModelTest, BytesThatAreNoModelAreRefused) {
  EXPECT_THROW(Model::Read({}), BadModel);
  std::vector<std::uint8_t> bytes(64, 0xff);
  EXPECT_THROW(Model::Read(bytes), BadModel);
  const char magic[] = "TFL3";
  std::copy_n(magic, 4, bytes.begin() + 4);
  EXPECT_THROW(Model::Read(bytes), BadModel);
  std::fill(bytes.begin(), bytes.begin() + 4, std::uint8_t{0});
  EXPECT_THROW(Model::Read(bytes), BadModel);
}

}  // namespace
}  // namespace facefit
