#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/fsm/app_support.h"

namespace fsm {
namespace {

TEST(FsmModuleTest, AnswersAsTheOriginal) {
  FsmStage fsm;
  EXPECT_EQ(vm::FormatMessage(fsm.module.Greeting().at(0)), "rep Run = LIVE");
  EXPECT_EQ(fsm.Say("inq Run"), "rep Run = LIVE");
  EXPECT_EQ(fsm.Say("inq ProtocolVersion"), "rep ProtocolVersion = Protocol Ver. 2.06");
  EXPECT_EQ(fsm.Say("inq ModuleVersion"),
            "rep ModuleVersion = Module Ver. Galatea FSM " GALATEA_VERSION);
  EXPECT_EQ(fsm.Say("inq MaskSet"), "rep MaskSet = \"galatea,pygmalion\"");
  EXPECT_EQ(fsm.Say("inq NowMask"), "rep NowMask = \"galatea\"");
  EXPECT_EQ(fsm.Say("inq BackgroundSet"), "rep BackgroundSet = \"plain,studio\"");
  EXPECT_EQ(fsm.Say("inq NowBackground"), "rep NowBackground = \"plain\"");
  EXPECT_EQ(fsm.Say("inq MouthScale"), "rep MouthScale = 30");
  EXPECT_EQ(fsm.Say("inq Offset"), "rep Offset = 0.000000");
  EXPECT_EQ(fsm.Say("inq ViewMode"), "rep ViewMode = TEXTURE");
  EXPECT_EQ(fsm.Say("inq ViewBackground"), "rep ViewBackground = ENABLE");
  EXPECT_EQ(fsm.Say("inq Capture"), "rep Capture = DISABLE");
}

TEST(FsmModuleTest, CameraLampsAndBackgroundAreChecked) {
  FsmStage fsm;
  for (const char* line : {"set Camera = 0.5", "set Camera = 0.5 20 40 -30", "set Light.key = 2",
                           "set Light.fill = 0 90 -10", "set Light.rim = 1 -150 30 #ff8000",
                           "set Light.key = 1 #ffffff", "set Background = transparent",
                           "set Background = #102030", "set Window = 320 240"}) {
    EXPECT_EQ(fsm.Say(line).find("Error"), std::string::npos) << line;
  }
  for (const char* line :
       {"set Camera = nan", "set Camera = 0", "set Camera = 1 1e9", "set Light.key = -1",
        "set Light.key = 1 90", "set Light.key = 1 #12345", "set Light.rim = 1 0 0 red",
        "set Window = FULLSCREEN", "set Background = #12345g"}) {
    const std::string slot = std::string(line).substr(4, std::string(line).find(' ', 4) - 4);
    const std::string before = fsm.Say("inq " + slot);
    fsm.Say(line);
    EXPECT_EQ(fsm.Say("inq " + slot), before) << line;
  }
}

TEST(FsmModuleTest, NoSlotReportsByItselfAtFirst) {
  FsmStage fsm;
  for (const char* line : {"set Face.1 = 100",
                           "set Mouth.17 = 200",
                           "set HeadRotAbs.1 = 1 2 3",
                           "set HeadRotRel.1 = 1 2 3",
                           "set FaceMot = NOD 1",
                           "set FaceMot = NOMOVE",
                           "set FaceExp = HAPPY 1 100 500",
                           "set FaceExp = NEUTRAL",
                           "set EyeRot = 1 2 100",
                           "set EyeRotLeft = 1 2 0",
                           "set EyeRotRight = 1 2 0",
                           "set Autonomous = BLINK 1",
                           "set Autonomous = MOVE 1",
                           "set Autonomous = USERDEF 0",
                           "set Offset = 10.5",
                           "set Speak.syncoffset = 5",
                           "set MouthScale = 50",
                           "set Mask = galatea",
                           "set Background = #102030",
                           "set ViewMode = WIREFRAME",
                           "set ViewBackground = DISABLE",
                           "set AgentEnable = DISABLE",
                           "set AgentRot = 1 2 3",
                           "set AgentTrans = 1 2",
                           "set AgentScale = 1.5",
                           "set AgentAlpha = 0.5",
                           "set SaveImage = a.bmp"}) {
    EXPECT_EQ(fsm.Say(line), "") << line;
  }
  EXPECT_TRUE(fsm.errors.empty()) << fsm.errors.at(0);
  EXPECT_EQ(fsm.Say("inq NowBackground"), "rep NowBackground = \"#102030\"");
  EXPECT_EQ(fsm.Say("inq Offset"), "rep Offset = 10.500000");
}

TEST(FsmModuleTest, WhatIsBeyondIsTakenForTheNearestAsInTheOriginal) {
  FsmStage fsm;
  EXPECT_EQ(fsm.Say("set#1 Face.1 = 201.5"), "rep#1 Face.1 = 200");
  EXPECT_EQ(fsm.Say("set#1 Mouth.3 = -1"), "rep#1 Mouth.3 = 0");
  EXPECT_EQ(fsm.Say("set#1 HeadRotAbs.1 = 12.5 -120 91"), "rep#1 HeadRotAbs.1 = 12.5 -90 90");
  EXPECT_EQ(fsm.Say("inq HeadRotAbs.1"), "rep HeadRotAbs.1 = 12.5 -90 90");
  EXPECT_EQ(fsm.Say("set#1 FaceExp = NEUTRAL 1 100 0"), "rep#1 FaceExp = NEUTRAL 1 100 0");
  EXPECT_EQ(fsm.Say("set#1 FaceExp = HAPPY"), "rep#1 FaceExp = HAPPY");
  EXPECT_EQ(fsm.Say("set#1 FaceMot = NOMOVE 0"), "rep#1 FaceMot = NOMOVE 0");
  EXPECT_EQ(fsm.Say("set#1 Mask = galatea "), "rep#1 Mask = galatea ");
  EXPECT_EQ(fsm.Say("inq NowMask"), "rep NowMask = \"galatea\"");
}

TEST(FsmModuleTest, RefusalsSayWhatIsExpected) {
  FsmStage fsm;
  const auto refused = [&fsm](const std::string& line, const std::string& text) {
    const std::string answer = fsm.Say("set#1 " + line);
    EXPECT_NE(answer.find(".error = "), std::string::npos) << answer;
    EXPECT_NE(answer.find(text), std::string::npos) << answer;
  };
  refused("Face.1 = nan", "BAD_VALUE");
  refused("Face.37 = 1", "UNKNOWN_SLOT");
  refused("HeadRotAbs.2 = 1 2 3", "UNKNOWN_SLOT");
  refused("HeadRotAbs.1 = 1 2", "BAD_VALUE");
  refused("FaceExp = HAPPY 1 300 0", "BAD_VALUE");
  refused("FaceExp = MERRY", "'MERRY' is no expression; ANGRY DISGUSTED FEARED HAPPY");
  refused("FaceExp = BORED 1 100 0", "'BORED' is no expression");
  refused("FaceExp = HAPPY 6 100 0", "HAPPY has no pattern 6; 1 to 5 expected");
  refused("FaceMot = NOD 9", "NOD has no pattern 9; 1 to 5 expected");
  refused("FaceMot = JUMP 1", "BAD_VALUE");
  refused("Autonomous = MOVE 7", "MOVE has no pattern 7");
  refused("Mask = man01", "there is no face 'man01'; galatea pygmalion expected");
  refused("Background = bg9", "there is no background 'bg9'");
  refused("Background = missing.png", "UNAVAILABLE cannot read missing.png");
  refused("ViewMode = SOLID", "BAD_VALUE");
  refused("AgentAlpha = 1.5", "BAD_VALUE");
  refused("SaveImage = face.gif", "BAD_VALUE");
  refused("AU = 40 1", "'40' at column 1 is not an action unit");
  refused("ARKit = smile 1", "'smile' is no blend shape");
  refused("Record = STOP", "no film is being recorded");
  refused("NowMask = x", "ACCESS");
}

TEST(FsmModuleTest, ASavedImageShowsTheSettledExpressionWhateverComesNext) {
  FsmStage fsm;
  fsm.Say("set Autonomous = ASYMMETRY 0");
  fsm.Say("set FaceExp = HAPPY 1 100 0");
  EXPECT_EQ(fsm.Say("set#5 SaveImage = happy.png"), "rep#5 SaveImage = happy.png");
  fsm.Say("set FaceExp = SAD 1 100 0");
  fsm.Say("set SaveImage = sad.png");
  EXPECT_FLOAT_EQ(fsm.world.pictures["happy.png"].au.left[12], 1.0f);
  EXPECT_FLOAT_EQ(fsm.world.pictures["sad.png"].au.left[12], 0);
  EXPECT_FLOAT_EQ(fsm.world.pictures["sad.png"].au.left[15], 0.7f);
}

TEST(FsmModuleTest, BusyLastsAsLongAsSomethingWithAnEndMoves) {
  FsmStage fsm;
  EXPECT_FALSE(fsm.module.Busy());
  EXPECT_FALSE(fsm.clock.Next().has_value());
  fsm.Say("set FaceExp = HAPPY 1 100 1000");
  EXPECT_TRUE(fsm.module.Busy());
  EXPECT_EQ(fsm.clock.Next(), vm::Time(std::chrono::milliseconds(1000)));
  fsm.Until(1000);
  EXPECT_FALSE(fsm.module.Busy());
  EXPECT_FALSE(fsm.clock.Next().has_value());
  fsm.Say("set FaceMot = NOD 2");
  EXPECT_TRUE(fsm.module.Busy());
  fsm.Until(1400);
  EXPECT_FALSE(fsm.module.Busy());
  fsm.Say("set Autonomous = BLINK 1");  // has no end
  EXPECT_FALSE(fsm.module.Busy());
  EXPECT_EQ(fsm.world.draws, 0);
}

TEST(FsmModuleTest, AFilmHasAFrameForEveryInstant) {
  FsmStage fsm;
  fsm.Until(17);
  fsm.Say("set Record.sound = voice.wav");
  EXPECT_EQ(fsm.Say("set#1 Record = a.mp4"), "rep#1 Record = a.mp4");
  EXPECT_EQ(fsm.Say("inq Record"), "rep Record = a.mp4");
  EXPECT_EQ(fsm.Say("inq Record.start"), "rep Record.start = 17");
  EXPECT_TRUE(fsm.Say("set#2 Record = b.mp4").starts_with("rep#2 Record.error = BUSY"));
  EXPECT_TRUE(fsm.Say("set#2 Window = 100 100").starts_with("rep#2 Window.error = BUSY"));
  fsm.Say("set LipSync.pho = pau 100 a 200 pau 200");
  fsm.Say("set Speak = NOW");
  fsm.Until(1017);
  EXPECT_EQ(fsm.Say("set#3 Record = STOP"), "rep#3 Record = STOP");
  EXPECT_EQ(fsm.Say("inq Record.start"), "rep Record.start = ");
  const auto& film = fsm.world.films["a.mp4"];
  EXPECT_EQ(film.jaws.size(), 31u);  // both ends
  EXPECT_EQ(film.sound, "voice.wav");
  EXPECT_FLOAT_EQ(film.jaws[0], 0);
  EXPECT_GT(film.jaws[3], 5);
  EXPECT_FLOAT_EQ(film.jaws[29], 0);
  EXPECT_FALSE(fsm.clock.Next().has_value());
}

TEST(FsmModuleTest, AnUnfinishedFilmIsFinishedAtTheEnd) {
  FsmStage fsm;
  fsm.Say("set Record = a.mp4");
  fsm.Until(500);
  fsm.module.Shutdown();
  EXPECT_TRUE(fsm.world.films["a.mp4"].finished);
  EXPECT_EQ(fsm.world.films["a.mp4"].jaws.size(), 16u);
}

TEST(FsmModuleTest, TheSameInputGivesTheSameFrames) {
  const auto run = [] {
    FsmStage fsm;
    fsm.Say("set Autonomous = BLINK 1");
    fsm.Say("set Autonomous = MOVE 1");
    fsm.Say("prop Frame = AutoOutput");
    fsm.Say("set LipSync.pho = pau 100 a 200 m 100 i 200 pau 200");
    fsm.Say("set Speak = + 200");
    return fsm.Until(3000);
  };
  EXPECT_EQ(run(), run());
}

TEST(FsmModuleTest, FramesWithoutAFilmAreReportedWhileSomethingMoves) {
  FsmStage fsm;
  fsm.Say("prop Frame = AutoOutput");
  fsm.Say("set FaceMot = NOD 1");
  fsm.Until(1000);
  fsm.Say("set FaceMot = NOD 1");
  const std::string said = fsm.Until(3000);
  EXPECT_TRUE(said.starts_with("rep Frame = 6 1033.333 - 0.00 0.00 50.00")) << said;
  EXPECT_FALSE(fsm.clock.Next().has_value());
  EXPECT_EQ(fsm.world.draws, 0);
}

TEST(FsmModuleTest, AChangeWithoutMovementIsReportedInOneFrame) {
  FsmStage fsm;
  fsm.Say("prop Frame = AutoOutput");
  fsm.Until(1000);
  fsm.Say("set AU = 12L 0.7 0");
  EXPECT_EQ(fsm.Until(3000), "rep Frame = 0 1033.333 - 0.00 0.00 50.00");
  EXPECT_FALSE(fsm.clock.Next().has_value());
}

TEST(FsmModuleTest, AModuleIsToldEachFrameWithoutDrawing) {
  FsmStage fsm;
  fsm.Say("set AU = 12L 0.7 0");
  const std::string first = fsm.Say("set Frame.to = VMC");
  EXPECT_EQ(first,
            "to @VMC set FaceFrame = 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 "
            "12L:0.7");
  fsm.Say("set FaceMot = NOD 1");
  const std::string said = fsm.Until(3000);
  EXPECT_TRUE(said.starts_with("to @VMC set FaceFrame = 33.333 0 0 ")) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '@'), 6) << "a nod of 0.2 s";
  EXPECT_FALSE(fsm.clock.Next().has_value()) << "nothing is told while nothing moves";
  EXPECT_EQ(fsm.world.draws, 0);
  fsm.Say("set Frame.to = NONE");
  fsm.Say("set FaceMot = NOD 1");
  EXPECT_EQ(fsm.Until(6000), "");
}

TEST(FsmModuleTest, CaptureWritesNumberedPicturesOfOneUtterance) {
  char name[] = "/tmp/galatea_capture_XXXXXX";
  ASSERT_NE(mkdtemp(name), nullptr);
  const std::string folder = std::string(name) + "/new";
  FsmStage fsm;
  fsm.Say("prop Capture = AutoOutput");
  EXPECT_EQ(fsm.Say("set Capture = " + folder + " frame 10"), "rep Capture = ENABLE");
  EXPECT_EQ(fsm.Say("inq Capture"), "rep Capture = ENABLE");
  fsm.Until(100);
  EXPECT_TRUE(fsm.world.pictures.empty());
  fsm.Say("set LipSync.pho = a 300 pau 200");
  fsm.Say("set Speak = NOW");
  EXPECT_EQ(fsm.Until(600), "rep Capture = DISABLE");
  EXPECT_EQ(fsm.world.pictures.size(), 6u);  // 0 100 .. 500
  EXPECT_TRUE(fsm.world.pictures.contains(folder + "/frame00001.bmp"));
  EXPECT_TRUE(fsm.world.pictures.contains(folder + "/frame00006.bmp"));
  fsm.Say("set Capture = " + folder + " f 10 PNG");
  fsm.Say("set LipSync.pho = a 50");
  fsm.Say("set Speak = NOW");
  fsm.Until(1000);
  EXPECT_TRUE(fsm.world.pictures.contains(folder + "/f00001.png"));
  std::filesystem::remove_all(name);
}

TEST(FsmModuleTest, NothingIsCapturedOrDrawnAfterTheEnd) {
  FsmStage fsm({}, true);
  fsm.Say("set Capture = " + testing::TempDir() + "/end_of_capture frame 10");
  fsm.Say("set LipSync.pho = a 60000");
  fsm.Say("set Speak = NOW");
  fsm.Until(1000);
  const int drawn = fsm.world.draws;
  fsm.module.Shutdown();
  EXPECT_EQ(fsm.world.pictures.size(), 11u) << "0 100 .. 1000, those still being read among them";
  fsm.Until(2000);
  EXPECT_EQ(fsm.world.pictures.size(), 11u);
  EXPECT_EQ(fsm.world.draws, drawn);
  std::filesystem::remove_all(testing::TempDir() + "/end_of_capture");
}

TEST(FsmModuleTest, InitResetsEverythingWithoutAWord) {
  FsmStage fsm;
  fsm.Say("set FaceExp = HAPPY 1 100 0");
  fsm.Say("set MouthScale = 80");
  fsm.Say("set Background = #ff0000");
  fsm.Say("set AgentAlpha = 0.2");
  fsm.Say("set LipSync.pho = a 1000");
  fsm.Say("set Speak = NOW");
  fsm.Until(500);
  EXPECT_EQ(fsm.Say("set Run = INIT"), "");
  EXPECT_EQ(fsm.Say("inq Speak.stat"), "rep Speak.stat = IDLE");
  EXPECT_EQ(fsm.Say("inq MouthScale"), "rep MouthScale = 30");
  EXPECT_EQ(fsm.Say("inq NowBackground"), "rep NowBackground = \"plain\"");
  EXPECT_FLOAT_EQ(fsm.Now().au.left[12], 0);
  EXPECT_FLOAT_EQ(fsm.Now().figure.alpha, 1);
  EXPECT_FALSE(fsm.module.Busy());
  EXPECT_EQ(fsm.Say("set Run = EXIT"), "");
  EXPECT_TRUE(fsm.module.ExitRequested());
}

TEST(FsmModuleTest, AWindowIsDrawnWhileSomethingMovesAndElseNowAndThen) {
  FsmStage fsm({}, true);
  fsm.Until(1000);
  const int still = fsm.world.shown;
  EXPECT_LE(still, 6);
  fsm.Say("set FaceMot = NOD 3");
  fsm.Until(1800);
  EXPECT_GE(fsm.world.shown - still, 46);
  EXPECT_LE(fsm.world.shown - still, 50);
  fsm.world.closed = true;
  fsm.Until(2100);
  EXPECT_TRUE(fsm.module.ExitRequested());
}

TEST(FsmModuleTest, AWindowShowsCommandsThatMoveNothingHoweverManyCome) {
  FsmStage fsm({}, true);
  fsm.Until(300);
  const int before = fsm.world.shown;
  for (int i = 1; i <= 50; ++i) {
    fsm.Say("set AgentRot = 0 " + std::to_string(i % 20) + " 0");
    fsm.Until(300 + i * 20);
  }
  EXPECT_GE(fsm.world.shown - before, 45) << "about one for each command, 20 ms apart";
}

TEST(FsmModuleTest, AWindowIsDrawnUntilNothingSwings) {
  FsmStage fsm({}, true);
  fsm.Until(1000);
  EXPECT_TRUE(fsm.world.simulated);
  fsm.world.swings = true;
  const int before = fsm.world.shown;
  fsm.Until(2000);
  EXPECT_GE(fsm.world.shown - before, 45);
  fsm.world.swings = false;
  fsm.Until(2100);
  const int still = fsm.world.shown;
  fsm.Until(3100);
  EXPECT_LE(fsm.world.shown - still, 6);
}

TEST(FsmModuleTest, SimulationCanBeSwitchedOff) {
  FsmStage fsm({}, true);
  fsm.Say("set Simulation = DISABLE");
  fsm.Until(500);
  EXPECT_FALSE(fsm.world.simulated);
  fsm.Say("set Run = INIT");
  fsm.Until(1000);
  EXPECT_TRUE(fsm.world.simulated);
}

TEST(FsmModuleTest, AWindowThatCannotBeDrawnIsAFailure) {
  bool failed = false;
  FsmOptions options;
  options.on_failure = [&failed] { failed = true; };
  FsmStage fsm(options, true);
  fsm.Until(300);
  EXPECT_FALSE(failed);
  fsm.world.no_drawing = "cannot draw: face 'man01': there is none";
  fsm.Until(1000);
  EXPECT_TRUE(fsm.module.ExitRequested());
  EXPECT_TRUE(failed);
  EXPECT_EQ(fsm.errors, std::vector<std::string>{"UNAVAILABLE " + fsm.world.no_drawing});
}

TEST(FsmModuleTest, TheOriginalsConfigurationIsTaken) {
  char name[] = "/tmp/galatea_config_XXXXXX";
  ASSERT_NE(mkdtemp(name), nullptr);
  const std::filesystem::path folder = name;
  std::ofstream(folder / "nod.dat") << "// a\n1\n// b\n// c\n300 20 0 8\n";
  std::ofstream(folder / "config.txt")
      << "# faces\nMaskFile man01 a.rgb a.pnt\nMaskEye man01 a b\nBackgroundFile bg1 x.png\n"
         "BackgroundFile bg2 y.png\nFaceMotNod nod.dat\nFaceMotBlink 100\nFaceMotBlink 200\n"
         "AutonomousBlink 1 2\nMaxFrameRate 30\nSetViseme EN\nDEF_WINDOW_WIDTH 512\n"
         "EXPRESSION_DURATION 200\nSOMETHING_ELSE 1\n";
  auto config = OriginalConfig::Read((folder / "config.txt").string());
  ASSERT_TRUE(config) << config.error().text;
  EXPECT_EQ(config->width, 512);
  FsmOptions options;
  options.config = *config;
  FsmStage fsm(options);
  EXPECT_EQ(vm::FormatMessage(fsm.module.Greeting().at(1)),
            "tell detected: -C flag: " + (folder / "config.txt").string());
  EXPECT_EQ(fsm.Say("inq BackgroundSet"), "rep BackgroundSet = \"bg1,bg2\"");
  EXPECT_EQ(fsm.Say("inq NowBackground"), "rep NowBackground = \"bg1\"");
  EXPECT_EQ(fsm.Say("inq LipSync.language"), "rep LipSync.language = EN");
  EXPECT_TRUE(fsm.Say("set#1 FaceMot = NOD 2").find("NOD has no pattern 2") != std::string::npos);
  fsm.Say("set FaceMot = NOD 1");
  fsm.Until(299);
  EXPECT_NEAR(fsm.Now().head_rotation[0], 20, 0.1);
  EXPECT_NEAR(fsm.Now().head_rotation[2], -8, 0.1) << "its z+ leans to the viewer's left";
  fsm.Say("set Autonomous = ASYMMETRY 0");
  fsm.Say("set FaceExp = HAPPY 1 100 0");
  fsm.Until(498);
  EXPECT_LT(fsm.Now().au.left[12], 1.0f);
  fsm.Until(499);
  EXPECT_FLOAT_EQ(fsm.Now().au.left[12], 1.0f);

  std::ofstream(folder / "bad.txt") << "EXPRESSION_DURATION soon\n";
  const auto bad = OriginalConfig::Read((folder / "bad.txt").string());
  ASSERT_FALSE(bad);
  EXPECT_NE(bad.error().text.find("bad.txt:1: 'soon' found"), std::string::npos);
  std::filesystem::remove_all(folder);
  EXPECT_FALSE(OriginalConfig::Read((folder / "config.txt").string()));
}

/// As with -C: a configuration that names faces and is otherwise empty.
FsmOptions WithOriginalFaces(const std::vector<std::string>& names) {
  FsmOptions options;
  options.config.path = "config.txt";
  for (const std::string& name : names) options.config.faces.push_back({name, "", "", "", "", ""});
  return options;
}

TEST(FsmModuleTest, AConfigurationsFacesAloneAreListedInItsOrder) {
  FsmStage fsm(WithOriginalFaces({"pygmalion", "gone", "galatea"}));
  EXPECT_EQ(fsm.Say("inq MaskSet"), "rep MaskSet = \"pygmalion,galatea\"");
  FsmStage one(WithOriginalFaces({"pygmalion"}));
  EXPECT_EQ(one.Say("inq MaskSet"), "rep MaskSet = \"pygmalion\"");
  EXPECT_EQ(one.Say("set#1 Mask = galatea"), "rep#1 Mask = galatea") << "worn all the same";
  FsmStage none(WithOriginalFaces({}));
  EXPECT_EQ(none.Say("inq MaskSet"), "rep MaskSet = \"galatea,pygmalion\"");
}

TEST(FsmModuleTest, FacesHaveTheOrderOfTheirMaskFileLines) {
  const std::string path = testing::TempDir() + "/mask_order_config.txt";
  std::ofstream(path) << "MaskEye b x y\nMaskFile a p w\nMaskFile b p w\nMaskTeeth c t\n";
  const auto config = OriginalConfig::Read(path);
  std::filesystem::remove(path);
  ASSERT_TRUE(config) << config.error().text;
  EXPECT_EQ(config->FaceNames(), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(config->faces[1].eye_picture.ends_with("x"));
}

TEST(FsmModuleTest, ClientsOfTheOriginalLeanAndMoveByItsMeasures) {
  FsmStage fsm(WithOriginalFaces({})), ours;
  for (FsmStage* stage : {&fsm, &ours}) {
    for (const char* line :
         {"set HeadRotAbs.1 = 1 2 15", "set HeadRotRel.1 = 0 0 3", "set AgentRot = 4 5 6",
          "set AgentTrans = 1.0 0.2", "set Camera = 2", "set SaveImage = a.png"}) {
      stage->Say(line);
    }
  }
  const FaceState there = fsm.world.last_state, here = ours.world.last_state;
  EXPECT_EQ(here.head_rotation, (std::array<float, 3>{1, 2, 18}));
  EXPECT_EQ(there.head_rotation, (std::array<float, 3>{1, 2, -18}));
  EXPECT_EQ(here.figure.rotation, (std::array<float, 3>{4, 5, 6}));
  EXPECT_EQ(there.figure.rotation, (std::array<float, 3>{4, 5, -6}));
  EXPECT_EQ(there.figure.translation, here.figure.translation);
  EXPECT_FALSE(ours.world.last_scene.camera.moves_by_half_views);
  EXPECT_TRUE(fsm.world.last_scene.camera.moves_by_half_views);
  EXPECT_TRUE(fsm.world.last_scene.wire_on_black);
  fsm.Say("set Run = INIT");
  fsm.Say("set SaveImage = a.png");
  EXPECT_TRUE(fsm.world.last_scene.camera.moves_by_half_views);
  EXPECT_EQ(fsm.Say("inq HeadRotAbs.1"), "rep HeadRotAbs.1 = 0 0 0");
}

TEST(FsmModuleTest, AConfigurationsExpressionsAreShown) {
  FsmOptions options = WithOriginalFaces({});
  options.config.expression_ms = 100;
  options.config.expressions["HAPPY"][1].au.left[14] = 0.5F;
  options.config.expressions["USERDEF"][7].residuals[3] = 1;
  FsmStage fsm(options);
  fsm.Say("set Autonomous = ASYMMETRY 0");
  fsm.Say("set FaceExp = HAPPY 1 200 0");
  fsm.Until(1000);
  EXPECT_FLOAT_EQ(fsm.Now().au.left[14], 1);
  EXPECT_FLOAT_EQ(fsm.Now().au.left[12], 0) << "and not ours";
  fsm.Say("set FaceExp = HAPPY 2 100 0");
  fsm.Until(2000);
  EXPECT_GT(fsm.Now().au.left[12], 0.4F) << "ours, where it has none";
  fsm.Say("set FaceExp = USERDEF 7 100 0");
  fsm.Until(3000);
  EXPECT_FLOAT_EQ(fsm.Now().residuals[3], 1);
}

TEST(FsmModuleTest, AConfiguredBackgroundThatIsGoneLeavesThePlainOne) {
  FsmOptions options;
  options.config.backgrounds = {{"bg1", "missing.png"}, {"bg2", "there.png"}};
  std::string logged;
  options.log = [&logged](const std::string& line) { logged += line; };
  FsmStage fsm(options);
  EXPECT_EQ(logged, "notice: background bg1: cannot read missing.png; the plain one is shown");
  EXPECT_EQ(fsm.Say("inq NowBackground"), "rep NowBackground = \"plain\"");
  EXPECT_EQ(fsm.Say("inq BackgroundSet"), "rep BackgroundSet = \"plain,studio,bg1,bg2\"");
}

TEST(FsmModuleTest, TheBackgroundOfTheCommandLineIsThatOfTheStart) {
  FsmOptions options;
  options.background = "studio";
  FsmStage fsm(options);
  EXPECT_EQ(fsm.Say("inq NowBackground"), "rep NowBackground = \"studio\"");
  fsm.Say("set Background = plain");
  fsm.Say("set Run = INIT");
  EXPECT_EQ(fsm.Say("inq Background"), "rep Background = studio");
  EXPECT_EQ(fsm.Say("inq NowBackground"), "rep NowBackground = \"studio\"");
  options.background = "nowhere";
  EXPECT_THROW(FsmStage{options}, std::runtime_error);
}

TEST(FsmModuleTest, AsymmetryIsANumberOfTheFigure) {
  FsmStage fsm;
  EXPECT_FLOAT_EQ(fsm.Now().asymmetry, 1);
  fsm.Say("set Asymmetry = 0");
  EXPECT_FLOAT_EQ(fsm.Now().asymmetry, 0);
  fsm.Say("set Run = INIT");
  EXPECT_FLOAT_EQ(fsm.Now().asymmetry, 1);
}

}  // namespace
}  // namespace fsm
