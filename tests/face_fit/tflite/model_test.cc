#include "face_fit/tflite/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "face_fit/tflite/network.h"
#include "tests/face_fit/tflite/tflite_maker.h"

namespace facefit::tflite {
namespace {

TEST(ModelTest, AFileWithEveryOperatorIsReadAndRuns) {
  const std::string file = maker::EveryOperator();
  Model model = Model::Read(std::vector<std::uint8_t>(file.begin(), file.end()));
  EXPECT_EQ(model.nodes.size(), 20U);
  ASSERT_EQ(model.nodes[1].op.index(), Operator(op::Convolution{}).index());
  EXPECT_EQ(model.nodes[1].activation, Activation::kRelu);
  ASSERT_EQ(model.nodes[2].op.index(), Operator(op::DepthwiseConvolution{}).index());
  EXPECT_EQ(model.nodes[2].activation, Activation::kRelu6);
  Network network(std::move(model));
  network.Run(std::vector<float>(network.input_shape().count(), 1));
  EXPECT_EQ(network.output(0).size(), 64U);
  for (const float v : network.output(0)) EXPECT_TRUE(std::isfinite(v));
}

TEST(ModelTest, AFileThatEndsEarlyIsRefused) {
  const std::string file = maker::EveryOperator();
  for (std::size_t n = 0; n < file.size(); n += 7) {
    const std::vector<std::uint8_t> bytes(file.begin(),
                                          file.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_THROW(Model::Read(bytes), BadModel) << n;
  }
}

TEST(ModelTest, AWeightThatIsNoNumberIsRefused) {
  const std::string file = maker::EveryOperator();
  const std::string weight = maker::BytesOf(std::vector{0.25F});
  const std::size_t at = file.find(weight);
  ASSERT_NE(at, std::string::npos);
  for (const float bad : {NAN, INFINITY}) {
    std::string damaged = file;
    damaged.replace(at, weight.size(), maker::BytesOf(std::vector{bad}));
    const std::vector<std::uint8_t> bytes(damaged.begin(), damaged.end());
    EXPECT_THROW(Model::Read(bytes), BadModel) << bad;
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
}  // namespace facefit::tflite
