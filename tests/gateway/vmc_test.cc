// The face told to programs that draw avatars: frames, weights, rotations, bundles, the module.

#include <gtest/gtest.h>

#include <cmath>

#include "gateway/vmc/vmc_bundle.h"
#include "gateway/vmc/vmc_module.h"

namespace gateway {
namespace {

using Lines = std::vector<std::string>;

const std::string kRest = " 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 1 0 0 0 0 0 0 0 0 0 0";

FaceFrame Frame(const std::string& text) {
  auto frame = ParseFaceFrame(text);
  if (!frame) throw std::runtime_error(frame.error().text);
  return *frame;
}

float WeightOf(const FaceFrame& frame, VmcNames names, const std::string& name) {
  const auto& known = FaceWeights::Built().Names(names);
  const auto at = std::ranges::find(known, name);
  EXPECT_NE(at, known.end()) << name;
  return FaceWeights::Built().Of(frame, names)[static_cast<std::size_t>(at - known.begin())];
}

TEST(FaceFrameTest, NumbersAndUnitsAreRead) {
  const FaceFrame frame = Frame(
      "1234.5 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 0.5 0.25 10 -20 5 1 2 3 4 0.1 0.9 12L:0.7 "
      "43R:1 901L:1");
  EXPECT_EQ(frame.at, vm::Time(1'234'500));
  EXPECT_EQ(frame.mouth[11], 12);
  EXPECT_EQ(frame.head[1], -20);
  EXPECT_EQ(frame.right_eye[1], 4);
  EXPECT_EQ(frame.right_lid, 0.9F);
  EXPECT_EQ(frame.units[24], 0.7F);
  EXPECT_EQ(frame.units[87], 1);
}

TEST(FaceFrameTest, AnythingElseIsNamed) {
  const auto error = [](const std::string& text) {
    auto frame = ParseFaceFrame(text);
    return frame ? "" : frame.error().text;
  };
  EXPECT_EQ(error(""), "0 numbers found, 29 expected");
  EXPECT_EQ(error("x"), "'x' found, a time in ms expected");
  EXPECT_EQ(error("1 2 nan"), "'nan' found, a number expected");
  EXPECT_EQ(error("0" + kRest + " 12:1"), "'12:1' found, UNIT:STRENGTH as 12L:0.7 expected");
  EXPECT_EQ(error("0" + kRest + " 12L:"), "'12L:' found, UNIT:STRENGTH as 12L:0.7 expected");
}

TEST(LiveLinkTest, APacketHasThePublishedForm) {
  const FaceFrame frame = Frame("1025 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 1 0 9 -18 36 0 0 0 0 1 0");
  const std::string packet = LiveLinkPacket(
      frame, FaceWeights::Built(), {.id = "01234567-89ab-cdef-0123-456789abcdef", .subject = "Me"});
  const std::string head(
      "\x06\0\0\0\x24"
      "01234567-89ab-cdef-0123-456789abcdef\0\0\0\x02Me"
      "\0\0\0\x3d\x3f\0\0\0\0\0\0\x3c\0\0\0\x01\x3d",
      64);
  ASSERT_EQ(packet.size(), 64U + 61 * 4);
  EXPECT_EQ(packet.substr(0, 64), head) << "frame 61 and a half, of 60 a second";
  const auto value = [&packet](std::size_t i) { return packet.substr(64 + 4 * i, 4); };
  EXPECT_EQ(value(0), std::string("\x3f\x80\0\0", 4)) << "eyeBlinkLeft 1";
  EXPECT_EQ(value(7), std::string(4, '\0')) << "eyeBlinkRight 0";
  EXPECT_EQ(value(52), std::string("\xbd\xcc\xcc\xcd", 4)) << "yaw -0.1: to the agent's right";
  EXPECT_EQ(value(53), std::string("\xbd\x4c\xcc\xcd", 4)) << "pitch -0.05: down";
  EXPECT_EQ(value(54), std::string("\x3e\x4c\xcc\xcd", 4)) << "roll 0.2";
  EXPECT_EQ(LiveLinkPacket(frame, FaceWeights::Built(), {.id = "", .subject = "", .angles = false})
                .substr(26 + 52 * 4),
            std::string(36, '\0'));
}

TEST(FaceWeightsTest, ARestingFaceMovesNothing) {
  for (const VmcNames names : {VmcNames::kVrm0, VmcNames::kVrm1, VmcNames::kPerfectSync}) {
    for (const float weight : FaceWeights::Built().Of(Frame("0" + kRest), names)) {
      EXPECT_EQ(weight, 0);
    }
  }
  EXPECT_EQ(FaceWeights::Built().Names(VmcNames::kPerfectSync).size(), 52u);
}

TEST(FaceWeightsTest, UnitsAndLidsAreWhatReceiversCallThem) {
  const FaceFrame smile = Frame("0" + kRest + " 12L:0.8 12R:0.4 43L:1");
  EXPECT_NEAR(WeightOf(smile, VmcNames::kVrm0, "Joy"), 0.6, 1e-5);
  EXPECT_NEAR(WeightOf(smile, VmcNames::kVrm1, "happy"), 0.6, 1e-5);
  EXPECT_NEAR(WeightOf(smile, VmcNames::kPerfectSync, "MouthSmileLeft"), 0.8, 1e-5);
  EXPECT_EQ(WeightOf(smile, VmcNames::kVrm0, "Blink_L"), 1);
  EXPECT_EQ(WeightOf(smile, VmcNames::kVrm0, "Blink_R"), 0);
}

/// A mouth by jaw, corners and protrusion.
FaceFrame Mouth(float jaw, float corner, float forward, float seal = 0) {
  FaceFrame frame;
  frame.mouth[11] = jaw;
  frame.mouth[8] = corner;
  frame.mouth[1] = forward;
  frame.seal = seal;
  return frame;
}

TEST(FaceWeightsTest, MouthsAreTheVowelsTheyLookLike) {
  const auto shares = [](const FaceFrame& frame) { return FaceWeights::Built().Vowels(frame); };
  EXPECT_NEAR(shares(Mouth(9, 0, 0))[0], 1, 0.05) << "a";
  EXPECT_NEAR(shares(Mouth(1.5, -8, 6))[2], 1, 0.05) << "u";
  EXPECT_NEAR(shares(Mouth(6, -6.5, 5))[4], 1, 0.1) << "o";
  const auto half = shares(Mouth(4.5, 0, 0));
  EXPECT_NEAR(half[0], 0.5, 0.1) << "half as open is half an a";
  for (const float share : shares(Mouth(9, 0, 0, 1))) EXPECT_EQ(share, 0) << "sealed";
}

TEST(VmcBundleTest, HeadsTurnAsUnityTurnsThem) {
  const auto down = UnityRotation(90, 0, 0);
  EXPECT_NEAR(down[0], std::sqrt(0.5), 1e-5) << "forward goes down: positive about x";
  const auto right = UnityRotation(0, 90, 0);
  EXPECT_NEAR(right[1], -std::sqrt(0.5), 1e-5) << "to the viewer's right is the avatar's left";
  const auto tilt = UnityRotation(0, 0, 90);
  EXPECT_NEAR(tilt[2], std::sqrt(0.5), 1e-5);
  const auto all = UnityRotation(20, -30, 10);
  float length = 0;
  for (const float part : all) length += part * part;
  EXPECT_NEAR(length, 1, 1e-5);
}

class VmcModuleTest : public testing::Test {
 protected:
  VmcModuleTest() {
    module_.slots().set_output([this](vm::PeerId, const vm::Message& message) {
      said_.push_back(vm::FormatMessage(message));
    });
    module_.slots().set_on_error([this](vm::PeerId, const std::string&, const vm::Error& error) {
      errors_.push_back(vm::FormatError(error));
    });
    clock_.RunReady();
  }
  void Tell(const std::string& line) { module_.slots().HandleLine(line, 1); }

  vm::VirtualScheduler clock_;
  bool real_ = false, takes_ = true;
  Lines said_, errors_, sent_;
  VmcModule module_{clock_,
                    {.module_version = "test",
                     .real = [this] { return real_; },
                     .aim = [](const std::string& to) -> vm::Result<void> {
                       if (to == "here:1") return {};
                       return vm::Fail(vm::Errc::kBadValue, "not there");
                     },
                     .send =
                         [this](const std::string& bundle) {
                           sent_.push_back(bundle);
                           return takes_;
                         }}};
};

TEST_F(VmcModuleTest, TheFaceIsAskedForItsFramesAndEachIsABundle) {
  EXPECT_EQ(said_, (Lines{"to @AM set Subscribe = FSM", "to @FSM set Frame.to = VMC"}));
  Tell("set FaceFrame = 0" + kRest);
  Tell("set FaceFrame = 33" + kRest);
  ASSERT_EQ(sent_.size(), 2u);
  EXPECT_TRUE(sent_[0].starts_with(std::string("#bundle\0", 8)));
  EXPECT_TRUE(sent_[0].contains("/VMC/Ext/Blend/Apply"));
  EXPECT_EQ(module_.slots().Value("Sent"), "2");
  takes_ = false;
  Tell("set FaceFrame = 66" + kRest);
  EXPECT_EQ(module_.slots().Value("Sent"), "2") << "the system did not take it";
  sent_.pop_back();
  Tell("set FaceFrame = nonsense");
  EXPECT_EQ(sent_.size(), 2u);
  EXPECT_EQ(errors_.size(), 1u);
}

TEST_F(VmcModuleTest, AFaceThatBeginsAnewIsAskedAgain) {
  said_.clear();
  Tell("from @FSM rep Run = LIVE");
  EXPECT_EQ(said_, (Lines{"to @FSM set Frame.to = VMC"}));
  Tell("set Send = OFF");
  EXPECT_EQ(said_.back(), "to @FSM set Frame.to = NONE");
}

TEST_F(VmcModuleTest, TheLastBundleIsSentAgainEachSecondWhileTimeIsReal) {
  Tell("set FaceFrame = 0" + kRest);
  clock_.RunUntil(vm::Time(5'000'000));
  EXPECT_EQ(sent_.size(), 1u) << "a virtual clock would never come to rest";
  real_ = true;
  Tell("set FaceFrame = 0" + kRest);
  clock_.RunUntil(vm::Time(8'500'000));
  EXPECT_EQ(sent_.size(), 5u);
}

TEST_F(VmcModuleTest, NamesBonesAndPlacesAreChosenByLines) {
  Tell("set FaceFrame = 0" + kRest);
  EXPECT_TRUE(sent_.back().contains("Blink_L"));
  EXPECT_TRUE(sent_.back().contains("/VMC/Ext/Bone/Pos"));
  Tell("set Names = PERFECTSYNC");
  EXPECT_TRUE(sent_.back().contains("JawOpen"));
  Tell("set Bones = OFF");
  EXPECT_FALSE(sent_.back().contains("/VMC/Ext/Bone/Pos"));
  Tell("set To = nowhere");
  EXPECT_EQ(errors_, (Lines{"BAD_VALUE not there"}));
  Tell("set Subject = " + std::string(65, 'x'));
  EXPECT_EQ(errors_.back(), "TOO_LONG found 65 bytes, expected at most 64");
}

}  // namespace
}  // namespace gateway
