// The emotion space: how it learns, what it gives back, and what fsm makes of a point.

#include "fsm/motion/inputs/emotion_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "face_space/emotion/identity_net.h"
#include "face_space/emotion/space_training.h"
#include "face_space/emotion/whereabouts.h"
#include "fsm/motion/face_motion.h"
#include "vdm/train/dice.h"

namespace facespace {
namespace {

using namespace std::chrono_literals;

const fsm::MotionTables& Tables() {
  static const fsm::MotionTables tables = fsm::MotionTables::Load().value();
  return tables;
}

std::string ShippedText() {
  std::ifstream in(GALATEA_SOURCE_DIR "/fsm/motion/tables/emotion_space.txt");
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(IdentityNetTest, EveryWeightsSlopeIsThatOfTheLoss) {
  constexpr Eigen::Index kUnits = 7, kColumns = 12;
  IdentityNet net(kUnits, 9, 3);
  vdm::Dice dice(8);
  Lesson lesson{Eigen::MatrixXf(kUnits, kColumns), Eigen::MatrixXf(kUnits, kColumns),
                Eigen::MatrixXf(3, kColumns), Eigen::VectorXf(kColumns)};
  for (Eigen::MatrixXf* matrix : {&lesson.inputs, &lesson.targets, &lesson.points}) {
    for (float& number : matrix->reshaped()) number = static_cast<float>(dice.Between(-1, 1));
  }
  for (float& led : lesson.led) led = static_cast<float>(dice.Between(0, 2));
  IdentityLoss loss(net);
  IdentityGradient gradient(net), unused(net);
  loss.Of(lesson, gradient);
  constexpr float kStep = 1e-3F;
  int checked = 0, near = 0;
  const auto check = [&](vdm::TimeDelayNet& half, const vdm::NetGradient& slopes) {
    for (std::size_t l = 0; l < half.layers.size(); ++l) {
      for (Eigen::Index i = 0; i < half.layers[l].weights.size(); ++i) {
        float& weight = half.layers[l].weights.data()[i];
        const float kept = weight;
        weight = kept + kStep;
        const double above = loss.Of(lesson, unused);
        weight = kept - kStep;
        const double below = loss.Of(lesson, unused);
        weight = kept;
        const double measured = (above - below) / (2 * static_cast<double>(kStep));
        const auto told = static_cast<double>(slopes.layers[l].weights.data()[i]);
        // A step across the corner of a rectifier measures something between both sides' slopes.
        near += std::abs(measured - told) < 0.01 * std::abs(measured) + 0.004;
        ++checked;
      }
      EXPECT_EQ(slopes.layers[l].biases.norm(), 0) << "biases stay at zero";
    }
  };
  check(net.encoder, gradient.encoder);
  check(net.decoder, gradient.decoder);
  EXPECT_EQ(checked, 2 * (7 * 9 + 9 * 3));
  EXPECT_GE(near, checked * 97 / 100);
}

TEST(EmotionSpaceTest, TheShippedTableIsMadeAgainByteForByte) {
  const auto space = LearnSpace({}, Tables().expressions, BuiltAxes(), {});
  ASSERT_TRUE(space) << space.error().text;
  EXPECT_TRUE(FormatSpace(*space) == ShippedText())
      << "make it anew: face_space emotions --out fsm/motion/tables/emotion_space.txt";
}

TEST(EmotionSpaceTest, ATableIsReadAsItWasWritten) {
  const auto space = fsm::ReadEmotionSpace("t", ShippedText(), fsm::UnitNames::BuiltIn());
  ASSERT_TRUE(space) << space.error().text;
  EXPECT_TRUE(FormatSpace(*space) == ShippedText());
}

TEST(EmotionSpaceTest, EmotionsComeBackAsTheirOwnRatios) {
  const auto judged = JudgeSpace(Tables().emotion_space, Tables().expressions, BuiltAxes());
  ASSERT_EQ(judged.size(), 30U);
  for (const GivenBack& back : judged) {
    EXPECT_LT(back.rms, back.pattern == 1 ? 0.05 : 0.25) << back.emotion << " " << back.pattern;
    EXPECT_LT(back.worst, back.pattern == 1 ? 0.15 : 0.8) << back.emotion << " " << back.pattern;
  }
}

TEST(EmotionSpaceTest, EmotionsLieWhereTheAxesSay) {
  for (const Axis& axis : BuiltAxes()) {
    const auto& at = Tables().emotion_space.emotions.find(axis.emotion)->second;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(at[k], axis.at[k], 0.1) << axis.emotion;
  }
}

TEST(EmotionSpaceTest, TheMiddleIsRestAndTwiceAsFarIsTwiceAsStrong) {
  const fsm::EmotionSpace& space = Tables().emotion_space;
  for (const float ratio : space.RatiosAt({0, 0, 0})) EXPECT_EQ(ratio, 0);
  const auto whole = space.RatiosAt({0.4F, 0.3F, -0.2F}),
             half = space.RatiosAt({0.2F, 0.15F, -0.1F});
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_NEAR(half[i], whole[i] / 2, 1e-5);
}

TEST(EmotionSpaceTest, NeighboursBlendSmoothly) {
  const fsm::EmotionSpace& space = Tables().emotion_space;
  for (const auto& [name, from] : space.emotions) {
    for (const auto& [other, to] : space.emotions) {
      std::vector<float> before;
      for (int step = 0; step <= 40; ++step) {
        const float share = static_cast<float>(step) / 40;
        fsm::EmotionSpace::Point at{};
        for (std::size_t k = 0; k < 3; ++k) at[k] = (1 - share) * from[k] + share * to[k];
        const auto now = space.RatiosAt(at);
        for (std::size_t i = 0; i < before.size(); ++i) {
          EXPECT_LT(std::abs(now[i] - before[i]), 0.15F)
              << name << " to " << other << " at " << share;
        }
        before = now;
      }
    }
  }
}

TEST(EmotionSpaceTest, RecognisedExpressionsLandAtTheirEmotion) {
  for (const Axis& axis : BuiltAxes()) {
    fsm::FaceLook look = Tables().expressions.find(axis.emotion)->second.patterns[0];
    // As a tracker sees it: everything weaker, and something that is not there.
    for (fsm::UnitValues* side : {&look.au.right, &look.au.left}) {
      for (std::size_t unit = 1; unit < 47; ++unit) (*side)[unit] *= unit % 2 == 0 ? 0.6F : 0.8F;
      (*side)[2] += 0.1F;
      (*side)[14] += 0.1F;
    }
    const Whereabouts where = WhereIs(Tables().emotion_space, look);
    EXPECT_EQ(where.emotion, axis.emotion);
    EXPECT_NEAR(where.strength, 0.7, 0.2) << axis.emotion;
    EXPECT_GT(where.held, 0.8) << axis.emotion;
  }
  EXPECT_EQ(WhereIs(Tables().emotion_space, {}).emotion, "NEUTRAL");
}

TEST(EmotionSpaceTest, TheFaceGoesToAPointOfTheSpace) {
  fsm::FaceMotion motion(Tables(), 1);
  motion.expression.ShowSpacePoint(0s, {1, 0, 0}, 400ms);
  const auto smile = [&motion](vm::Time t) {
    const fsm::FaceState state = motion.StateAt(t);
    return std::as_const(state.au.left)[12];
  };
  EXPECT_EQ(smile(0s), 0);
  EXPECT_GT(smile(220ms), 0.2F);
  EXPECT_NEAR(smile(500ms), 1.0F, 0.12F) << "as HAPPY has it";
  motion.expression.ShowSpacePoint(1s, {0.5F, 0, 0}, std::nullopt);
  EXPECT_NEAR(smile(3s), 0.5F, 0.07F);
  motion.expression.ShowSpacePoint(3s, {0, 0, 0}, 100ms);
  EXPECT_EQ(smile(4s), 0);
}

TEST(EmotionSpaceTest, DamagedTablesAreRefusedWithTheirPlace) {
  const auto error = [](const std::string& text) {
    const auto space = fsm::ReadEmotionSpace("e.txt", text, fsm::UnitNames::BuiltIn());
    return space ? "" : space.error().text;
  };
  const std::string good =
      "units 6 12\nencode linear\nrow 1 0\nrow 0 1\nrow 0 0\ndecode relu\nrow 1 0 0\nrow 0 1 0\n";
  EXPECT_EQ(error(good), "");
  EXPECT_EQ(error("units 6 700\n"), "e.txt:1: '700' is no action unit");
  EXPECT_EQ(error("units 6 6\n"), "e.txt:1: unit 6 is here twice");
  EXPECT_EQ(error("row 1\n"), "e.txt:1: a row before any layer");
  EXPECT_EQ(error("units 6\nencode sigmoid\n"), "e.txt:2: encode relu|linear expected");
  EXPECT_EQ(error("units 6\nencode linear\nrow 1 2\nrow 1\nrow 1\ndecode linear\nrow 1 1 1\n"),
            "e.txt: a row of 2 weights found in 'encode', 1 expected");
  EXPECT_EQ(error("units 6\nencode linear\nrow 1\nrow 1\ndecode linear\nrow 1 1 1\n"),
            "e.txt: the layers of 'encode' end with 2 outputs, 3 expected");
  EXPECT_NE(error("units 6\nencode linear\nrow nan\n"), "");
  EXPECT_NE(error(good + "emotion HAPPY 1 0\n"), "");
  EXPECT_NE(error(good + "emotion HAPPY 1 0 9\n"), "");
  EXPECT_NE(error(""), "");
  EXPECT_FALSE(ReadAxes("a.txt", "axis HAPPY 2 0 0\naxis SAD -1 0 0\n"));
  EXPECT_FALSE(ReadAxes("a.txt", "axis HAPPY 1 0 0\naxis HAPPY -1 0 0\n"));
  const auto stranger = ReadAxes("a.txt", "axis BORED 1 0 0\naxis SAD -1 0 0\n");
  ASSERT_TRUE(stranger);
  EXPECT_FALSE(LearnSpace({.steps = 1}, Tables().expressions, *stranger, {}));
}

}  // namespace
}  // namespace facespace
