// Units, blend shapes, expressions and life, said on the wire.

#include <gtest/gtest.h>

#include "fsm/app/contact_sheet.h"
#include "tests/fsm/app_support.h"

namespace fsm {
namespace {

struct ActionsTest : testing::Test {
  FsmStage fsm;
  ActionsTest() { fsm.Say("set Autonomous = ASYMMETRY 0"); }
  /// Says a line with a tag, which must be refused, and gives why.
  std::string Refusal(const std::string& line) {
    const std::string answer = fsm.Say(line);
    EXPECT_NE(answer.find(".error = "), std::string::npos) << line << " -> " << answer;
    return answer;
  }
};

TEST_F(ActionsTest, UnitsAndBlendShapesComeInLists) {
  EXPECT_EQ(fsm.Say("set#1 AU = 12L 0.7 6 C 1B"), "rep#1 AU = 12L 0.7 6 C 1B");
  EXPECT_EQ(fsm.Say("set#1 ARKit = jawOpen 0.3 mouthSmileLeft 0.6 300"),
            "rep#1 ARKit = jawOpen 0.3 mouthSmileLeft 0.6 300");
  fsm.Until(1000);
  EXPECT_FLOAT_EQ(fsm.Now().au.left[6], 0.5f);
  EXPECT_FLOAT_EQ(fsm.Now().au.left[1], 0.3f);
  EXPECT_FLOAT_EQ(fsm.Now().au.left[27], 0.3f);
  EXPECT_FLOAT_EQ(fsm.Now().au.left[12], 1.3f);
  Refusal("set#1 ARKit = jawOpen 0.9 mouthGrin 0.6");
  fsm.Until(2000);
  EXPECT_FLOAT_EQ(fsm.Now().au.left[27], 0.3f) << "a refused line moves nothing";
  for (const auto& [name, units] : fsm.module.motion().tables().blend_shapes) {
    EXPECT_TRUE(fsm.Say("set#2 ARKit = " + name + " 0.1").starts_with("rep#2 ARKit = ")) << name;
  }
}

TEST_F(ActionsTest, ExpressionsAreDefinedShownAskedAndDeleted) {
  EXPECT_EQ(fsm.Say("def#1 FaceExp.SMIRK = 12L 0.7 14R 0.2"),
            "rep#1 FaceExp.SMIRK = 12L:0.7 14R:0.2");
  EXPECT_EQ(fsm.Say("def#1 FaceExp.SMIRK.2 = 12L 1"), "rep#1 FaceExp.SMIRK.2 = 12L:1");
  EXPECT_EQ(fsm.Say("inq FaceExp.SMIRK.1"), "rep FaceExp.SMIRK.1 = 12L:0.7 14R:0.2");
  EXPECT_EQ(fsm.Say("set#1 FaceExp = SMIRK 1 100 0"), "rep#1 FaceExp = SMIRK 1 100 0");
  fsm.Until(1000);
  EXPECT_FLOAT_EQ(fsm.Now().au.left[12], 0.7f);
  EXPECT_EQ(fsm.Say("del#1 FaceExp.SMIRK"), "rep#1 FaceExp.SMIRK = deleted");
  EXPECT_NE(Refusal("set#1 FaceExp = SMIRK 1 100 0").find("'SMIRK' is no expression"),
            std::string::npos);
  EXPECT_NE(Refusal("del#1 FaceExp.SMIRK").find("there is no expression 'SMIRK'"),
            std::string::npos);
  Refusal("inq#1 FaceExp.SMIRK.1");
  Refusal("inq#1 FaceExp.SMIRK.2");
  EXPECT_EQ(fsm.Say("def#1 FaceExp.SMIRK = 12R 0.5"), "rep#1 FaceExp.SMIRK = 12R:0.5");
}

TEST_F(ActionsTest, PrototypesAreSlotsWhichCanBeEditedSavedAndBroughtBack) {
  EXPECT_EQ(fsm.Say("inq FaceExp.HAPPY.1"),
            "rep FaceExp.HAPPY.1 = 6:1.1 7:0.1 10:0.4 12:1 25:1.2 26:0.2");
  fsm.Say("save mine = FaceExp.HAPPY.1");
  EXPECT_EQ(fsm.Say("set#1 FaceExp.HAPPY.1 = 12 1 6 D"), "rep#1 FaceExp.HAPPY.1 = 12 1 6 D");
  fsm.Say("set FaceExp = HAPPY 1 100 0");
  fsm.Until(1000);
  EXPECT_FLOAT_EQ(fsm.Now().au.left[6], 0.75f);
  fsm.Say("rest mine");
  fsm.Say("set FaceExp = HAPPY 1 200 0");
  fsm.Until(2000);
  EXPECT_FLOAT_EQ(fsm.Now().au.left[12], 2.0f);
  fsm.Say("set FaceExp.HAPPY.1 = 12 0.1");
  fsm.Say("set Run = INIT");
  EXPECT_EQ(fsm.Say("inq FaceExp.HAPPY.1"),
            "rep FaceExp.HAPPY.1 = 6:1.1 7:0.1 10:0.4 12:1 25:1.2 26:0.2");
}

TEST_F(ActionsTest, BadInputIsRefusedWithOneClearErrorAndTheFaceGoesOn) {
  const auto refused = [this](const std::string& line, const std::string& why) {
    EXPECT_NE(Refusal(line).find(why), std::string::npos) << line << " -> " << fsm.Say(line);
  };
  refused("set#1 AU = 99 1", "'99' at column 1 is not an action unit");
  refused("set#1 AU = 12 NaN", "'NaN' at column 4 is no strength");
  refused("set#1 AU = 12 1e9", "'1e9' at column 4 is no strength");
  refused("set#1 Face.12 = nan", "BAD_VALUE");
  refused("set#1 Face.12 = 1e13", "BAD_VALUE");
  refused("set#1 FaceExp = HAPPY 1 1e9 0", "BAD_VALUE");
  refused("set#1 FaceExp = HAPPY 1 NaN 0", "BAD_VALUE");
  refused("set#1 ARKit = jawOpen inf", "BAD_VALUE");
  refused("set#1 FaceMot = NOD 1 1e9", "BAD_VALUE");
  refused("set#1 Life = PARTY", "'PARTY' is no way to live; CALM LISTENING LIVELY STILL or OFF");
  refused("set#1 Autonomous = DREAM 1", "BAD_VALUE");
  refused("set#1 Gaze = 1e9 0", "BAD_VALUE");
  refused("def#1 FaceExp.NEUTRAL = 12 1", "cannot be the name of an expression");
  refused("def#1 FaceExp.S = 12 1 x", "'x' at column 6");
  fsm.Say("set FaceExp = SAD 1 100 0");
  fsm.Until(2000);
  EXPECT_FLOAT_EQ(fsm.Now().au.left[15], 0.7f);
}

TEST_F(ActionsTest, LifeAndGazeAreSetByName) {
  fsm.Say("set Life = CALM");
  EXPECT_EQ(fsm.Say("inq Life"), "rep Life = CALM");
  EXPECT_EQ(fsm.Say("set#1 Autonomous = BREATH 0"), "rep#1 Autonomous = BREATH 0");
  EXPECT_EQ(fsm.Say("set#1 Gaze = USER"), "rep#1 Gaze = USER");
  EXPECT_EQ(fsm.Say("set#1 Gaze.distance = 400"), "rep#1 Gaze.distance = 400");
  EXPECT_EQ(fsm.Say("set#1 Gaze = THINK"), "rep#1 Gaze = THINK");
  EXPECT_EQ(fsm.Say("set#1 FaceMot = SHAKE 4 80 2"), "rep#1 FaceMot = SHAKE 4 80 2");
  fsm.Until(200);
  EXPECT_GT(fsm.Now().head_rotation[1], 4);
  EXPECT_EQ(fsm.Say("set#1 FaceExp.onset = ELICITED"), "rep#1 FaceExp.onset = ELICITED");
  EXPECT_TRUE(fsm.errors.empty());
}

TEST_F(ActionsTest, MasksAreWornAndTakenOffByInit) {
  EXPECT_EQ(fsm.world.face, "galatea");
  fsm.Say("prop NowMask = AutoOutput");
  EXPECT_EQ(fsm.Say("set Mask = pygmalion"), "rep NowMask = \"pygmalion\"");
  EXPECT_EQ(fsm.world.face, "pygmalion");
  EXPECT_NE(Refusal("set#1 Mask = man01").find("there is no face 'man01'"), std::string::npos);
  EXPECT_EQ(fsm.Say("inq NowMask"), "rep NowMask = \"pygmalion\"");
  fsm.Say("set Run = INIT");
  EXPECT_EQ(fsm.world.face, "galatea");
  EXPECT_EQ(fsm.Say("inq NowMask"), "rep NowMask = \"galatea\"");
}

TEST(StartTest, AMaskAndALifeCanBeGivenAtTheStart) {
  FsmOptions options;
  options.initial_face = "pygmalion";
  options.life = "CALM";
  FsmStage fsm(options);
  EXPECT_EQ(fsm.Say("inq NowMask"), "rep NowMask = \"pygmalion\"");
  EXPECT_EQ(fsm.Say("inq Life"), "rep Life = CALM");
  EXPECT_TRUE(fsm.module.motion().NextMotion(FromMs(5000)).has_value());
  options.initial_face = "nobody";
  EXPECT_THROW(FsmStage{options}, std::runtime_error);
}

TEST(SheetTest, EverySheetHasItsCells) {
  const MotionTables tables = MotionTables::Load().value();
  const auto count = [&](const char* kind) {
    return MakeSheet(kind, tables, {"galatea", "pygmalion"}, "").value().cells.size();
  };
  EXPECT_EQ(count("aus"), 1u + 44 + 14);
  EXPECT_EQ(count("emotions"), 7u);
  EXPECT_EQ(count("visemes"), 42u);
  EXPECT_EQ(count("identities"), 8u);
  EXPECT_FALSE(MakeSheet("hats", tables, {"galatea"}, ""));
  FakeWorld world;
  const auto picture =
      DrawSheet(world, world, MakeSheet("emotions", tables, {"galatea"}, "").value(), true);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->rgba.size(), 4u * static_cast<std::size_t>(picture->width) *
                                      static_cast<std::size_t>(picture->height));
  EXPECT_EQ(world.draws, 7);
}

}  // namespace
}  // namespace fsm
