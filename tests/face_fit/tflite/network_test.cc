#include "face_fit/tflite/network.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/face_fit/tflite/one_node.h"

namespace facefit::tflite {
namespace {

const op::Convolution kPadded{{.same_padding = true}};

TEST(NetworkTest, MoreWorkThanIsAllowedIsRefused) {
  const Model model = OneNode(kPadded, {{1, 2, 2, 1}},
                              {Constant({{1, 3, 3, 1}}, std::vector<float>(9, 1))}, {{1, 2, 2, 1}});
  EXPECT_NO_THROW(Network(model, 37));
  EXPECT_THROW(Network(model, 36), BadModel);
}

TEST(NetworkTest, ABlockTooLargeToCountIsRefused) {
  // 2^16 rows times 2^16 + 1 are 2^16 again in an int.
  constexpr int kRows = 1 << 16;
  Tensor filter = Constant({{1, kRows + 1, 1, 1}}, std::vector<float>(kRows + 1, 1));
  EXPECT_THROW(Network(OneNode(op::TransposeConvolution{}, {{1, kRows, 1, 1}}, {std::move(filter)},
                               {{1, kRows, 1, 1}})),
               BadModel);
}

TEST(NetworkTest, SizesThatDoNotMatchAreRefused) {
  const Tensor ones = Constant({{1, 3, 3, 1}}, std::vector<float>(9, 1));
  EXPECT_THROW(Network(OneNode(kPadded, {{1, 2, 2, 1}}, {ones}, {{1, 5, 2, 1}})), BadModel);
  EXPECT_THROW(Network(OneNode(kPadded, {{1, 2, 2, 2}}, {ones}, {{1, 2, 2, 1}})), BadModel);
  EXPECT_THROW(Network(OneNode(op::Add{}, {{1, 2, 2, 1}}, {ones}, {{1, 2, 2, 1}})), BadModel);
  const Tensor point = Constant({{1, 1, 1, 1}}, {1});
  EXPECT_THROW(Network(OneNode(kPadded, {{1, 2, 2, 1}}, {point}, {{2, 2, 2, 1}})), BadModel)
      << "two images of one";
  Model unwritten = OneNode(kPadded, {{1, 2, 2, 1}}, {ones}, {{1, 2, 2, 1}});
  Model two = unwritten;
  two.inputs = {0, 1};
  EXPECT_THROW(Network(std::move(two)), BadModel);
  unwritten.nodes.clear();
  EXPECT_THROW(Network(std::move(unwritten)), BadModel);
}

}  // namespace
}  // namespace facefit::tflite
