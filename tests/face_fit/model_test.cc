#include "face_fit/tflite/model.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "face_fit/tflite/network.h"

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
