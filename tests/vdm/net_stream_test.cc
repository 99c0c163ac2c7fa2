// Networks over streams say what they say over a whole sound.

#include "vdm/net/net_stream.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/vdm/made_net.h"
#include "vdm/mouth/mouth_tracker.h"

namespace vdm {
namespace {

TEST(TimeDelayNetTest, ALayerSeesWhatItsOffsetsSayAndZeroOutside) {
  TimeDelayNet net;
  net.layers.resize(1);
  TimeDelayLayer& layer = net.layers[0];
  layer.inputs = 1;
  layer.offsets = {-1, 2};
  layer.weights = Eigen::MatrixXf{{1, 10}};
  layer.biases = Eigen::VectorXf::Constant(1, 0.5F);
  const Eigen::MatrixXf out = net.Outputs(Eigen::MatrixXf{{1, 2, 3, 4}});
  EXPECT_EQ(out, (Eigen::MatrixXf{{30.5F, 41.5F, 2.5F, 3.5F}}));
}

TEST(TimeDelayNetTest, SoundsShorterThanItsReachAreFine) {
  const MouthNet net = MadeNet();
  for (const Eigen::Index columns : {0, 1, 2, 3}) {
    EXPECT_EQ(net.net.Outputs(Eigen::MatrixXf::Ones(26, columns)).cols(), columns);
  }
}

TEST(NetStreamTest, SaysWhatTheNetworkSaysAsSoonAsItCan) {
  const MouthNet net = MadeNet();
  const Eigen::MatrixXf input = Eigen::MatrixXf::Random(26, 40);
  const Eigen::MatrixXf whole = net.net.Outputs(input);
  NetStream stream(net.net);
  Eigen::Index said = 0;
  for (Eigen::Index t = 0; t < input.cols(); ++t) {
    const Eigen::VectorXf& out = stream.Add(input.col(t));
    ASSERT_EQ(out.size() == 0, t < 3);
    if (out.size() == 0) continue;
    // Towards the end the whole sees zeros where the stream has seen nothing yet.
    EXPECT_LT((out - whole.col(said++)).cwiseAbs().maxCoeff(), 1e-4F) << t;
  }
  EXPECT_EQ(said, 37);
}

TEST(MouthTrackerTest, MomentsComeInTimeAndDoNotDependOnThePieces) {
  const MouthNet net = MadeNet();
  std::vector<std::int16_t> sound(8000);
  for (std::size_t i = 0; i < sound.size(); ++i)
    sound[i] = static_cast<std::int16_t>((i * i) % 7001);
  MouthTracker whole(net), pieces(net);
  const auto expected = whole.Add(sound);
  std::size_t next = 0;
  for (std::size_t at = 0; at < sound.size(); at += 331) {
    const std::size_t heard = std::min(at + 331, sound.size());
    for (const auto& moment : pieces.Add(std::span(sound).subspan(at, heard - at))) {
      ASSERT_EQ(moment.sample, expected[next].sample);
      EXPECT_EQ(moment.frame.mouth, expected[next++].frame.mouth);
      EXPECT_LE(moment.sample + whole.ahead_samples(), heard);
      EXPECT_GT(moment.sample + whole.ahead_samples() + whole.hop_samples() + 331, heard);
    }
  }
  EXPECT_EQ(next, expected.size());
}

TEST(MouthTrackerTest, TwoNetworksAreMixedByWhatTheyMean) {
  const MouthNet net = MadeNet();
  MouthNet other = net;
  // The same shapes, told by other means and scales.
  TimeDelayLayer& last = other.net.layers.back();
  for (std::size_t i = 0; i < kShapeNumbers; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    other.means[i] = net.means[i] + 1;
    other.scales[i] = 2 * net.scales[i];
    last.weights.row(row) /= 2;
    last.biases[row] = (net.scales[i] * last.biases[row] - 1) / other.scales[i];
  }
  std::vector<std::int16_t> sound(4000);
  for (std::size_t i = 0; i < sound.size(); ++i)
    sound[i] = static_cast<std::int16_t>((i * i) % 7001);
  MouthTracker twice(net, 1, &net), both(net, 1, &other);
  const auto expected = twice.Add(sound), mixed = both.Add(sound);
  ASSERT_EQ(mixed.size(), expected.size());
  ASSERT_GT(mixed.size(), 10U);
  for (std::size_t k = 0; k < mixed.size(); ++k) {
    for (std::size_t i = 0; i < kMouthParameters; ++i) {
      EXPECT_NEAR(mixed[k].frame.mouth[i], expected[k].frame.mouth[i], 1e-3F);
    }
  }
}

TEST(MouthTrackerTest, TheSecondNetworkMovesTheMouth) {
  const MouthNet net = MadeNet();
  MouthNet open = net;
  open.means[11] += 5;  // degrees of the jaw
  const std::vector<std::int16_t> sound(4000);
  MouthTracker twice(net, 1, &net), both(net, 1, &open);
  const auto before = twice.Add(sound), mixed = both.Add(sound);
  ASSERT_EQ(mixed.size(), before.size());
  ASSERT_GT(mixed.size(), 10U);
  EXPECT_GT(mixed[9].frame.mouth[11], before[9].frame.mouth[11] + 1);
  EXPECT_LT(mixed[9].frame.mouth[11], before[9].frame.mouth[11] + 5);
}

TEST(MouthTrackerTest, TwoNetworksAreALittleSurerOfAClosureThanTheirMean) {
  MouthNet net = MadeNet();
  net.sounds = {"sil", "pbm"};
  const std::vector<std::int16_t> sound(4000);
  MouthTracker one(net), both(net, 1, &net);
  const auto alone = one.Add(sound), mixed = both.Add(sound);
  ASSERT_GT(mixed.size(), 10U);
  const auto odds = [](const MouthFrame& frame) { return frame.sounds[1] / frame.sounds[0]; };
  EXPECT_NEAR(odds(mixed[9].frame) / odds(alone[9].frame), std::exp(0.25F), 1e-3F);
}

TEST(MouthTrackerTest, TheSlowerOfTwoNetworksDecidesWhenAMomentIsSaid) {
  const MouthNet net = MadeNet();
  MouthNet slower = net;
  for (int& offset : slower.net.layers.front().offsets) offset += 3;
  MouthTracker one(net), both(net, 1, &slower);
  EXPECT_EQ(both.ahead_samples(), one.ahead_samples() + 3 * one.hop_samples());
  const std::vector<std::int16_t> sound(4000);
  EXPECT_EQ(both.Add(sound).size() + 3, one.Add(sound).size());
}

}  // namespace
}  // namespace vdm
