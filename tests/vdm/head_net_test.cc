// The network of heads: its text, its inputs, and a head that rests where there is no speech.

#include "vdm/prosody/head_net.h"

#include <gtest/gtest.h>

#include <cmath>

#include "vdm/prosody/head_mover.h"

namespace vdm {
namespace {

HeadNet MadeNet(std::size_t sounds) {
  HeadNet net{.sounds = sounds};
  net.means = {0.5F, 0, 0, 0.1F};
  net.scales = {1, 1, 1, 0.1F};
  net.pose = {0.5F, 1, 1};
  const auto layer = [](std::size_t inputs, std::size_t outputs, bool rectified) {
    TimeDelayLayer made{.offsets = {0}, .inputs = inputs, .rectified = rectified};
    made.weights.resize(static_cast<Eigen::Index>(outputs), static_cast<Eigen::Index>(inputs));
    for (Eigen::Index i = 0; i < made.weights.size(); ++i) {
      made.weights.data()[i] = 0.3F * std::sin(1.7F * static_cast<float>(i));
    }
    made.biases = Eigen::VectorXf::LinSpaced(static_cast<Eigen::Index>(outputs), -0.2F, 0.3F);
    return made;
  };
  net.net.layers = {layer(HeadNet::Inputs(sounds), 5, true), layer(5, 4, false)};
  return net;
}

TEST(HeadNetTest, ThePapersNetworkHas34Inputs) { EXPECT_EQ(HeadNet::Inputs(0), 34U); }

TEST(HeadNetTest, WhatIsWrittenIsReadAgain) {
  for (const std::size_t sounds : {std::size_t{0}, std::size_t{3}}) {
    const std::string text = FormatHeadNet(MadeNet(sounds));
    const auto read = ParseHeadNet("h", text);
    ASSERT_TRUE(read) << read.error().text;
    EXPECT_EQ(FormatHeadNet(*read), text);
    EXPECT_EQ(read->sounds, sounds);
  }
}

TEST(HeadNetTest, BadTextsAreRefusedWithTheirLine) {
  const auto error = [](std::string text, const std::string& from = "",
                        const std::string& to = "") {
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    const auto read = ParseHeadNet("h", text);
    return read ? std::string("none") : read.error().text;
  };
  const std::string good = FormatHeadNet(MadeNet(0));
  EXPECT_EQ(error(good), "none");
  EXPECT_EQ(error(""), "h:0: the end found, 'sounds' expected");
  EXPECT_EQ(error(good, "sounds 0", "sounds x"),
            "h:1: 'x' found, a number from -10000 to 10000 expected");
  EXPECT_EQ(error(good, "sounds 0", "sounds 2"),
            "h:10: a layer of 34 inputs ends here, 56 expected");
  EXPECT_EQ(error(good, "scales 1", "scales 0"), "h:3: a scale below 0.0001 found");
  EXPECT_EQ(error(good, "pose 0.5 ", "pose "), "h:4: 2 values after 'pose' found, 3 expected");
  EXPECT_EQ(error(good, "layer 34 5 relu", "layer 34 5 odd"),
            "h:5: layer INPUTS OUTPUTS relu|linear expected");
  EXPECT_EQ(error(good, "layer 34 5 relu", "layer 34 5.5 relu"),
            "h:5: '5.5' found, 1 to 1024 units expected");
  EXPECT_EQ(error(good.substr(0, good.size() / 2)).substr(0, 2), "h:");
  EXPECT_EQ(error(good.substr(0, good.find("layer 5"))),
            "h:10: the last layer has 5 outputs, 4 expected");
  EXPECT_EQ(error(good.substr(0, good.find("layer 34"))),
            "h:4: no layer found, at least one expected");
}

TEST(HeadNetTest, TheShippedNetworksAreWhole) {
  EXPECT_EQ(ShippedHeadNet(true).sounds, 0U);
  EXPECT_GT(ShippedHeadNet(false).sounds, 0U);
}

class HeadMoverTest : public testing::Test {
 protected:
  HeadPose Add(float speech, float hz, float emotion = 0, float size = 1) {
    const ProsodyFrame frame{.hz = hz, .power_db = speech > 0.5F ? 65.0F : 20.0F};
    phrases_.Add(speech, hz > 0);
    if (hz > 0 && speech > 0.5F) {
      usual_.log_hz.Add(std::log(static_cast<double>(hz)));
      usual_.power_db.Add(65);
    }
    return mover_.Add(frame, usual_, phrases_, {}, emotion, size);
  }
  const HeadNet net_ = MadeNet(0);
  HeadMover mover_{net_};
  SpeakerUsual usual_;
  PhraseTracker phrases_;
};

TEST_F(HeadMoverTest, WithoutSpeechTheHeadRests) {
  for (int k = 0; k < 300; ++k) EXPECT_EQ(Add(0.1F, k % 3 ? 120 : 0), HeadPose{}) << k;
}

TEST_F(HeadMoverTest, WithSpeechItMovesSoftlyAndGoesHomeAfterwards) {
  HeadPose before;
  float widest = 0;
  for (int k = 0; k < 600; ++k) {
    const bool speech = k > 50 && k < 300;
    const HeadPose now =
        Add(speech ? 0.9F : 0, speech ? 120 + 30 * std::sin(0.2F * static_cast<float>(k)) : 0);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LT(std::abs(now.angles[i] - before.angles[i]), 0.6F) << k;
      widest = std::max(widest, std::abs(now.angles[i]));
    }
    EXPECT_GE(now.brow, 0);
    EXPECT_LE(now.brow, 1);
    before = now;
    if (k == 300 + HeadMover::kRest + HeadMover::kReturns + 1) {
      EXPECT_EQ(now.angles[0], 0);
    }
  }
  EXPECT_GT(widest, 0.3F);
  EXPECT_EQ(before, HeadPose{});
}

TEST_F(HeadMoverTest, SizeIsAFactor) {
  HeadMover other(net_);
  SpeakerUsual usual;
  for (int k = 0; k < 200; ++k) {
    const HeadPose whole = Add(0.9F, 130);
    const ProsodyFrame frame{.hz = 130, .power_db = 65.0F};
    const HeadPose half = other.Add(frame, usual_, phrases_, {}, 0, 0.5F);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(half.angles[i], 0.5F * whole.angles[i], 1e-4);
  }
}

}  // namespace
}  // namespace vdm
