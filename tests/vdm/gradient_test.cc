// Back-propagation against differences of the loss.

#include "vdm/train/gradient.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/vdm/made_net.h"
#include "vdm/train/adam.h"
#include "vdm/train/dice.h"
#include "vdm/train/mouth_loss.h"

namespace vdm {
namespace {

MouthTruth SomeTruth(std::size_t count) {
  MouthTruth truth{Eigen::MatrixXf(kShapeNumbers, static_cast<Eigen::Index>(count)),
                   Eigen::VectorXf(static_cast<Eigen::Index>(count)),
                   std::vector<std::size_t>(count)};
  for (Eigen::Index i = 0; i < truth.shape.size(); ++i) {
    truth.shape.data()[i] = std::cos(static_cast<float>(i));
  }
  for (std::size_t t = 0; t < count; ++t) {
    truth.closed[static_cast<Eigen::Index>(t)] = t % 3 == 0 ? 1 : t % 3 == 1 ? 0 : 0.4F;
    truth.sound[t] = t % 2;
  }
  return truth;
}

Eigen::MatrixXf SomeInput(Eigen::Index count) {
  Eigen::MatrixXf input(26, count);
  for (Eigen::Index i = 0; i < input.size(); ++i)
    input.data()[i] = std::sin(0.7F * static_cast<float>(i));
  return input;
}

double Loss(const MouthNet& net, BackPropagation& propagation, const Eigen::MatrixXf& input,
            const MouthTruth& truth) {
  Eigen::MatrixXf slope;
  return LossOf(net, propagation.Forward(input), WantedOf(net, truth), slope).total();
}

/// Compares each slope that `propagation` tells with the difference that a small step makes.
void ExpectSlopesOfTheLoss(MouthNet& net, BackPropagation& propagation) {
  const Eigen::MatrixXf input = SomeInput(9);
  const MouthTruth truth = SomeTruth(9);
  NetGradient gradient(net.net);
  Eigen::MatrixXf slope;
  LossOf(net, propagation.Forward(input), WantedOf(net, truth), slope);
  propagation.Backward(slope, gradient);
  constexpr float kStep = 2e-3F;
  std::size_t checked = 0, near = 0;
  for (std::size_t l = 0; l < net.net.layers.size(); ++l) {
    const auto check = [&](float& value, float told) {
      const float kept = value;
      value = kept + kStep;
      const double above = Loss(net, propagation, input, truth);
      value = kept - kStep;
      const double below = Loss(net, propagation, input, truth);
      value = kept;
      const double measured = (above - below) / (2 * static_cast<double>(kStep));
      // A step across the corner of a rectifier measures something between both sides' slopes.
      near += std::abs(measured - static_cast<double>(told)) < 0.02 * std::abs(measured) + 0.02;
      ++checked;
    };
    auto& layer = net.net.layers[l];
    for (Eigen::Index i = 0; i < layer.weights.size(); i += 3) {
      check(layer.weights.data()[i], gradient.layers[l].weights.data()[i]);
    }
    for (Eigen::Index i = 0; i < layer.biases.size(); ++i) {
      check(layer.biases[i], gradient.layers[l].biases[i]);
    }
  }
  EXPECT_GT(checked, 250U);
  EXPECT_GE(near, checked * 98 / 100);
}

TEST(GradientTest, EveryWeightsSlopeIsThatOfTheLoss) {
  MouthNet net = MadeNet();
  BackPropagation propagation(net.net);
  ExpectSlopesOfTheLoss(net, propagation);
}

TEST(GradientTest, SlopesAreRightWithDisturbedUnits) {
  MouthNet net = MadeNet();
  BackPropagation propagation(net.net);
  Dice dice(5);
  propagation.Disturb(0.4, dice);
  const Eigen::MatrixXf input = SomeInput(9);
  EXPECT_GT((propagation.Forward(input) - net.net.Outputs(input)).cwiseAbs().maxCoeff(), 0.01F);
  ExpectSlopesOfTheLoss(net, propagation);
}

TEST(GradientTest, ADisturbanceOfNothingChangesNothing) {
  const MouthNet net = MadeNet();
  BackPropagation propagation(net.net);
  Dice dice(5);
  propagation.Disturb(0, dice);
  EXPECT_EQ(propagation.Forward(SomeInput(9)), net.net.Outputs(SomeInput(9)));
}

TEST(GradientTest, ForwardIsWhatTheNetworkSays) {
  const MouthNet net = MadeNet();
  BackPropagation propagation(net.net);
  const Eigen::MatrixXf input = SomeInput(12);
  EXPECT_EQ(propagation.Forward(input), net.net.Outputs(input));
}

TEST(AdamTest, StepsGoDownTheLoss) {
  MouthNet net = MadeNet();
  const Eigen::MatrixXf input = SomeInput(30);
  const MouthTruth truth = SomeTruth(30);
  Adam adam(net.net);
  BackPropagation plain(net.net);
  const double before = Loss(net, plain, input, truth);
  Eigen::MatrixXf slope;
  for (int i = 0; i < 200; ++i) {
    NetGradient gradient(net.net);
    BackPropagation propagation(net.net);
    LossOf(net, propagation.Forward(input), WantedOf(net, truth), slope);
    propagation.Backward(slope, gradient);
    adam.Step(net.net, gradient, 0.01);
  }
  EXPECT_LT(Loss(net, plain, input, truth), 0.3 * before);
}

}  // namespace
}  // namespace vdm
