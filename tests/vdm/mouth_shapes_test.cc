// Numbers of the mouth of a voice that come from the table of mouth shapes, beside that table.

#include <gtest/gtest.h>

#include <algorithm>

#include "fsm/motion/inputs/motion_tables.h"
#include "vdm/net/mouth_frame.h"
#include "vdm/net/sound_classes.h"

namespace vdm {
namespace {

class MouthShapesTest : public testing::Test {
 protected:
  MouthShapesTest() {
    net.sounds = SoundClasses::Built().names();
    net.scales.fill(1);
    outputs =
        Eigen::VectorXf::Zero(static_cast<Eigen::Index>(net.first_sound_row() + net.sounds.size()));
  }
  const fsm::Visemes& shapes() const { return tables->set(fsm::VisemeSetId::k28).visemes; }

  const vm::Result<fsm::MotionTables> tables = fsm::MotionTables::Load();
  MouthNet net;
  Eigen::VectorXf outputs;
};

TEST_F(MouthShapesTest, PressedLipsAreThoseOfB) {
  ASSERT_TRUE(tables) << tables.error().text;
  const auto pbm = std::ranges::find(net.sounds, "pbm") - net.sounds.begin();
  outputs[static_cast<Eigen::Index>(net.closure_row())] = 20;
  outputs[static_cast<Eigen::Index>(net.first_sound_row()) + pbm] = 20;
  MouthMotion motion(net, 10);
  const MouthFrame frame = motion.Next(outputs);
  const fsm::Viseme* b = fsm::FindViseme(shapes(), "b");
  ASSERT_NE(b, nullptr);
  for (std::size_t i = 0; i < kMouthParameters; ++i) {
    EXPECT_NEAR(frame.mouth[i], 0.8F * b->pose.mouth[i], 0.005F) << "parameter " << i + 1;
  }
}

TEST_F(MouthShapesTest, LimitsAreWhatTheShapesReach) {
  ASSERT_TRUE(tables) << tables.error().text;
  outputs[static_cast<Eigen::Index>(net.closure_row())] = -20;
  for (const std::size_t i : {1U, 3U, 5U, 7U, 8U, 10U, 13U, 14U, 15U, 16U}) {
    float least = 0, most = 0;
    for (const fsm::Viseme& shape : shapes()) {
      least = std::min(least, shape.pose.mouth[i]);
      most = std::max(most, shape.pose.mouth[i]);
    }
    const auto at = [&](float value) {
      outputs[static_cast<Eigen::Index>(i)] = value;
      const float said = FrameOf(net, outputs).mouth[i];
      outputs[static_cast<Eigen::Index>(i)] = 0;
      return said;
    };
    EXPECT_NEAR(at(-1000), least, 0.051F) << "parameter " << i + 1;
    EXPECT_NEAR(at(1000), most, 0.051F) << "parameter " << i + 1;
  }
}

}  // namespace
}  // namespace vdm
