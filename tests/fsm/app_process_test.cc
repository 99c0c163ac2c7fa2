// The real program, spoken to through pipes.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace fsm {
namespace {

std::string ReadAll(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

/// A folder of its own to run the program in.
struct FsmProcessTest : testing::Test {
  FsmProcessTest() {
    char name[] = "/tmp/galatea_fsm_XXXXXX";
    EXPECT_NE(mkdtemp(name), nullptr);
    folder = name;
  }
  ~FsmProcessTest() override { std::filesystem::remove_all(folder); }

  /// Gives the program the input and waits for its end.
  int Run(const std::string& options, const std::string& input) {
    std::ofstream(folder / "in.txt", std::ios::binary) << input;
    const std::string command = "cd " + folder.string() + " && unset DISPLAY WAYLAND_DISPLAY && " +
                                GALATEA_BIN_DIR "/fsm " + options +
                                " < in.txt > out.txt 2> err.txt";
    const int status = std::system(command.c_str());
    out = ReadAll(folder / "out.txt");
    err = ReadAll(folder / "err.txt");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  std::filesystem::path folder;
  std::string out, err;
};

/// The lines that are to be compared.
std::string Lines(const std::string& text) {
  std::string lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    if (const auto at = line.find("@VERSION@"); at != std::string::npos) {
      line.replace(at, 9, GALATEA_VERSION);
    }
    lines += line + '\n';
  }
  return lines;
}

TEST_F(FsmProcessTest, AnswersEveryCommandOfTheOriginal) {
  const std::filesystem::path data = GALATEA_SOURCE_DIR "/tests/fsm/data";
  EXPECT_EQ(Run("--headless --size 160x120", ReadAll(data / "every_command.txt")), 0) << err;
  EXPECT_EQ(Lines(out), Lines(ReadAll(data / "every_command.expected"))) << err;
  EXPECT_TRUE(std::filesystem::exists(folder / "face.bmp"));
  EXPECT_TRUE(std::filesystem::exists(folder / "face.rgb"));
  EXPECT_TRUE(std::filesystem::exists(folder / "pictures/shot00003.bmp"));
  EXPECT_FALSE(std::filesystem::exists(folder / "pictures/shot00004.bmp"));
}

TEST_F(FsmProcessTest, APipedBatchLeavesAHappyFace) {
  EXPECT_EQ(Run("--headless", "set FaceExp = HAPPY 1 100 0\nset SaveImage = happy.png\n"), 0);
  EXPECT_EQ(out, "rep Run = LIVE\n");
  EXPECT_EQ(Run("--headless", "set SaveImage = neutral.png\n"), 0);
  const std::string happy = ReadAll(folder / "happy.png");
  EXPECT_GT(happy.size(), 10000u);
  EXPECT_NE(happy, ReadAll(folder / "neutral.png"));
}

TEST_F(FsmProcessTest, ExitWaitsForAnExpressionAndForNothingElse) {
  support::Process program({GALATEA_BIN_DIR "/fsm", "--headless"});
  program.Write("set FaceExp = HAPPY\nset Run = EXIT\n");
  EXPECT_EQ(program.Wait(), 0) << "its input has not ended";
}

TEST_F(FsmProcessTest, TheSameInputGivesTheSameFilmAndTheSameWords) {
  const std::string input =
      "prop Frame = AutoOutput\nset Autonomous = BLINK 1\nset Record = film.mp4\n"
      "set LipSync.pho = pau 100 hh 60 ax 70 l 60 ow 160 pau 100\nset Speak = + 100\n"
      "set Wait = IDLE\nset#1 Record = STOP\n";
  ASSERT_EQ(Run("--headless --size 160x120", input), 0) << err;
  const std::string words = out;
  const std::string film = ReadAll(folder / "film.mp4");
  EXPECT_GT(film.size(), 1000u);
  ASSERT_EQ(Run("--headless --size 160x120", input), 0) << err;
  EXPECT_EQ(out, words);
  EXPECT_TRUE(ReadAll(folder / "film.mp4") == film);
  EXPECT_NE(words.find("rep#1 Record = STOP\n"), std::string::npos);
}

TEST_F(FsmProcessTest, AFilmThatWasNotStoppedIsFinishedAtTheEndOfInput) {
  EXPECT_EQ(
      Run("--headless --size 160x120", "set Record = film.mp4\nset FaceExp = HAPPY 1 100 600\n"),
      0);
  EXPECT_GT(ReadAll(folder / "film.mp4").size(), 1000u) << err;
}

TEST_F(FsmProcessTest, BadOptionsAndTablesEndInOneSentence) {
  EXPECT_EQ(Run("--headless --size big", ""), 1);
  EXPECT_EQ(err, "fsm: --size big is not WIDTHxHEIGHT, as 640x480\n");
  std::filesystem::create_directory(folder / "tables");
  std::ofstream(folder / "tables/emotions.txt") << "HAPPY 1 99:1\n";
  EXPECT_EQ(Run("--headless --tables tables", ""), 1);
  EXPECT_TRUE(err.starts_with("fsm: tables/emotions.txt:1: '99' at column 9 is not an action unit"))
      << err;
  EXPECT_EQ(Run("--headless -C nowhere.txt", ""), 1);
  EXPECT_EQ(err, "fsm: cannot read 'nowhere.txt': No such file or directory\n");
}

/// Opens the mouth by unit 26 and films it; frames are reported with the jaw's angle.
constexpr const char* kOpenMouth =
    "prop Frame = AutoOutput\nset AU = 26 1 0\nset Record = a.rgba\nset LipSync.pho = pau 100\n"
    "set Speak = NOW\nset Wait = IDLE\nset Record = STOP\n";

TEST_F(FsmProcessTest, UnitsOfOnesOwnMoveTheFace) {
  EXPECT_EQ(Run("--headless --size 64x64", kOpenMouth), 0) << err;
  EXPECT_NE(out.find("rep Frame = 0 0 pau 12.00 "), std::string::npos) << out;
  std::filesystem::create_directory(folder / "tables");
  std::ofstream(folder / "tables/action_units.txt") << "jaw 26 20 0\n";
  EXPECT_EQ(Run("--headless --size 64x64 --tables tables", kOpenMouth), 0) << err;
  EXPECT_NE(out.find("rep Frame = 0 0 pau 20.00 "), std::string::npos) << out;
  std::ofstream(folder / "tables/action_units.txt") << "jaw 26 20 0\njaw 26 far 0\n";
  EXPECT_EQ(Run("--headless --tables tables", ""), 1);
  EXPECT_EQ(err, "fsm: tables/action_units.txt:2: 'far' found where a number was expected\n");
}

TEST_F(FsmProcessTest, WhatIsOddAboutAFolderOfTablesIsTold) {
  std::filesystem::create_directory(folder / "tables");
  std::filesystem::copy(GALATEA_SOURCE_DIR "/fsm/motion/tables/action_unit_names.txt",
                        folder / "tables");
  const auto add = [&](const char* table, const char* row) {
    std::ofstream(folder / "tables" / table, std::ios::app) << row << "\n";
  };
  const auto run = [&] { return Run("--headless --size 64x64 --tables tables", ""); };
  EXPECT_EQ(run(), 0);
  EXPECT_EQ(err, "") << "a copy of a table is nothing odd";
  add("emotion.txt", "HAPPY 1 12:1");
  EXPECT_EQ(run(), 0);
  EXPECT_NE(err.find("no table has their name: emotion.txt; there are action_unit_list.txt, "),
            std::string::npos)
      << err;
  std::filesystem::remove(folder / "tables/emotion.txt");
  add("action_unit_names.txt", "unit 151 CheekTwitch\ncode 158 58b 9 0 0 -9 0 -9 0 -8");
  EXPECT_EQ(run(), 0);
  EXPECT_EQ(err,
            "fsm: notice: units without rows in the built-in action_units.txt move nothing: 151 "
            "CheekTwitch\n");
  std::filesystem::copy(GALATEA_SOURCE_DIR "/fsm/head/tables/action_units.txt", folder / "tables");
  add("action_units.txt", "field 151 43 5  20 20  both  0 3 0");
  EXPECT_EQ(run(), 0);
  EXPECT_EQ(err, "");
  std::ofstream(folder / "tables/action_units.txt") << "jaw 26 20 0\ndamp 26 152 0.5\n";
  EXPECT_EQ(run(), 1);
  EXPECT_EQ(err,
            "fsm: tables/action_units.txt:2: no unit has the number 152; one of "
            "action_unit_names.txt expected\n");
  std::ofstream(folder / "tables/action_units.txt") << "# codes\njaw 158 20 0\n";
  EXPECT_EQ(run(), 1);
  EXPECT_TRUE(err.starts_with("fsm: tables/action_units.txt:2: 158 is a code of head or eyes"))
      << err;
}

TEST_F(FsmProcessTest, AnExportedFaceIsDescribedAndDrawnAsItWas) {
  ASSERT_EQ(Run("--mask galatea --export face.glb", ""), 0) << err;
  ASSERT_EQ(Run("--mask galatea --describe", ""), 0) << err;
  const std::string described = out;
  EXPECT_NE(described.find("steps       channels, lids, "), std::string::npos) << described;
  ASSERT_EQ(Run("--head face.glb --describe", ""), 0) << err;
  EXPECT_EQ(out, described);
  const std::string batch = "set FaceExp = HAPPY 1 100 0\nset Wait = 200\nset SaveImage = face";
  ASSERT_EQ(Run("--headless --size 160x160 --mask galatea", batch + "1.png\n"), 0) << err;
  ASSERT_EQ(Run("--headless --size 160x160 --head face.glb", batch + "2.png\n"), 0) << err;
  EXPECT_FALSE(ReadAll(folder / "face1.png").empty());
  EXPECT_EQ(ReadAll(folder / "face1.png"), ReadAll(folder / "face2.png"));
}

// A triangle, and a morph target that moves its second corner.
constexpr const char* kSmirkingTriangle =
    R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"extras":{"targetNames":["Smirk"]},)"
    R"("primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":1}]}]}],"accessors":[)"
    R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
    R"({"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[)"
    R"({"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36}],"buffers":[)"
    R"({"byteLength":72,"uri":"data:application/octet-stream;base64,)"
    "AAAAAAAAAAAAAAAAzczMPQAAAAAAAAAAAAAAAM3MzD0AAAAA"
    "AAAAAAAAAAAAAAAAAAAAAArXIzwAAAAAAAAAAAAAAAAAAAAA"
    R"("}]})";

TEST_F(FsmProcessTest, ShapesOfAHeadThatAreNotUsedAreNamed) {
  std::ofstream(folder / "head.gltf") << kSmirkingTriangle;
  EXPECT_EQ(Run("--head head.gltf --describe", ""), 0) << err;
  EXPECT_NE(err.find("fsm: notice: 'head.gltf': shapes are not used, for neither ARKit nor VRM has "
                     "their names: Smirk;"),
            std::string::npos)
      << err;
}

TEST_F(FsmProcessTest, AFacesOwnUnitsGoBeforeThoseOfTheTables) {
  std::filesystem::create_directories(folder / "faces/berta");
  std::ofstream(folder / "faces/berta/identity.txt") << "base galatea\n";
  std::ofstream(folder / "faces/berta/action_units.txt") << "jaw 26 17 0\n";
  std::ofstream(folder / "action_units.txt") << "jaw 26 20 0\n";
  ASSERT_EQ(::setenv("GALATEA_FACES", (folder / "faces").c_str(), 1), 0);
  EXPECT_EQ(Run("--headless --size 64x64 --mask berta --tables .", kOpenMouth), 0) << err;
  ::unsetenv("GALATEA_FACES");
  EXPECT_NE(out.find("rep Frame = 0 0 pau 17.00 "), std::string::npos) << out;
}

TEST_F(FsmProcessTest, ASheetOfIdentitiesDoesNotShowWhatTheUserHasKept) {
  std::filesystem::create_directories(folder / "faces/damaged");
  std::ofstream(folder / "faces/damaged/identity.txt") << "junk\n";
  ASSERT_EQ(::setenv("GALATEA_FACES", (folder / "faces").c_str(), 1), 0);
  EXPECT_EQ(Run("--sheet identities --out all.png", ""), 0) << err;
  EXPECT_EQ(Run("--sheet identities --mask damaged --out one.png", ""), 1);
  ::unsetenv("GALATEA_FACES");
  EXPECT_NE(err.find("damaged/identity.txt:1: "), std::string::npos) << err;
  EXPECT_TRUE(std::filesystem::exists(folder / "all.png"));
}

TEST_F(FsmProcessTest, AFilmWithoutBackgroundIsTransparentBesideTheHead) {
  EXPECT_EQ(Run("--headless --size 160x120",
                "set Background = transparent\nset Record = film.mov\nset Wait = 200\n"
                "set Record = STOP\n"),
            0)
      << err;
  const std::string command = "ffmpeg -v error -i " + (folder / "film.mov").string() +
                              " -frames:v 1 -f rawvideo -pix_fmt rgba " +
                              (folder / "frame.rgba").string();
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string pixels = ReadAll(folder / "frame.rgba");
  ASSERT_EQ(pixels.size(), 160U * 120 * 4);
  const auto alpha = [&](std::size_t x, std::size_t y) {
    return static_cast<unsigned char>(pixels[(y * 160 + x) * 4 + 3]);
  };
  for (std::size_t y = 0; y < 120; ++y) {
    EXPECT_EQ(alpha(2, y), 0) << y;
    EXPECT_EQ(alpha(157, y), 0) << y;
  }
  EXPECT_GE(alpha(80, 60), 254) << "the nose";
}

TEST_F(FsmProcessTest, RunsThatEndAtOnceFollowTheConfiguration) {
  std::ofstream(folder / "rest") << "";
  std::ofstream(folder / "faces.txt")
      << "DEF_WFM_PNT rest\nDEF_WFM_LNK rest\nMaskFile a rest a.pnt\n";
  std::ofstream(folder / "a.pnt") << "junk\n";
  for (const char* face : {"", "--mask a "}) {
    for (const char* work : {"--describe", "--export a.glb", "--sheet emotions --out a.png"}) {
      EXPECT_EQ(Run(std::string("-C faces.txt ") + face + work, ""), 1) << work;
      EXPECT_NE(err.find("face 'a': "), std::string::npos) << work << ": " << err;
    }
  }
  std::ofstream(folder / "moves.txt") << "FaceMotNod nowhere.mot\n";
  EXPECT_EQ(Run("-C moves.txt --sheet emotions --out b.png", ""), 1);
  EXPECT_NE(err.find("nowhere.mot"), std::string::npos) << err;
}

TEST_F(FsmProcessTest, AnOutputWithoutASheetIsRefused) {
  EXPECT_NE(Run("--headless --out film.mp4", "inq Run\n"), 0);
  EXPECT_NE(err.find("--out requires --sheet"), std::string::npos) << err;
}

TEST_F(FsmProcessTest, StrictTurnsRefusalsIntoTheExitCode) {
  EXPECT_EQ(Run("--headless", "set FaceExp = BORED 1 100 0\n"), 0);
  EXPECT_NE(err.find("'BORED' is no expression"), std::string::npos);
  EXPECT_EQ(Run("--headless --strict", "set FaceExp = BORED 1 100 0\n"), 1);
}

TEST_F(FsmProcessTest, APictureAfterInitIsThatOfAFreshProgram) {
  EXPECT_EQ(Run("--headless --size 160x120", "set SaveImage = fresh.png\n"), 0) << err;
  EXPECT_EQ(Run("--headless --size 160x120",
                "set Window = 100 90\nset Mask = pygmalion\nset FaceExp = HAPPY 1 100 0\n"
                "set HeadRotAbs.1 = 5 20 5\nset AgentAlpha = 0.5\nset AgentScale = 1.3\n"
                "set Background = transparent\nset Camera = 0.5 10 40 20\nset Light.key = 3\n"
                "set ViewMode = TEXTURE_WITH_WIREFRAME\nset AU = 26 1 0\n"
                "set Record = film.rgba\nset SaveImage = used.png\nset Run = INIT\n"
                "set SaveImage = after.png\ninq Window\n"),
            0)
      << err;
  EXPECT_NE(out.find("rep Window = 160 120\n"), std::string::npos) << out;
  EXPECT_EQ(ReadAll(folder / "after.png"), ReadAll(folder / "fresh.png"));
  EXPECT_NE(ReadAll(folder / "used.png"), ReadAll(folder / "fresh.png"));
  EXPECT_EQ(std::filesystem::file_size(folder / "film.rgba"), 100U * 90 * 4);
}

/// Named pipes in the test's folder, and the face started there.
struct NamedPipeTest : FsmProcessTest {
  void Pipes(const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      ASSERT_EQ(mkfifo((folder / name).c_str(), 0600), 0) << name;
    }
  }
  std::unique_ptr<support::Process> Start(const std::vector<std::string>& more) {
    std::vector<std::string> words{GALATEA_BIN_DIR "/fsm", "--headless", "--size", "64x64"};
    words.insert(words.end(), more.begin(), more.end());
    return std::make_unique<support::Process>(
        words, support::Process::Options{.cwd = folder.string(), .env = {}});
  }
  /// The line is answered with an error that has `why` in it.
  static void Refused(support::Process& face, const std::string& line, const std::string& why) {
    face.WriteLine(line);
    const auto answer = face.Expect("rep#1 ");
    ASSERT_TRUE(answer) << line;
    EXPECT_NE(answer->find(why), std::string::npos) << line << "\n" << *answer;
  }
  static void Alive(support::Process& face) {
    face.WriteLine("inq#2 Run");
    EXPECT_TRUE(face.Expect("rep#2 Run = LIVE"));
  }
};

TEST_F(NamedPipeTest, ThoseNamedInLinesAreRefusedAndItGoesOn) {
  std::filesystem::create_directory(folder / "shots");
  Pipes({"pipe", "pipe.png", "pipe.mp4", "pipe.rgba", "pipe.wav", "shots/a00001.bmp"});
  const auto face = Start({});
  const std::string irregular = "' is not a regular file";
  Refused(*face, "save#1 mine << pipe", irregular);
  Refused(*face, "do#1 pipe", irregular);
  Refused(*face, "set#1 LipSync.pho < pipe", irregular);
  Refused(*face, "set#1 SaveImage = pipe.png", irregular);
  Refused(*face, "set#1 Background = pipe.png", irregular);
  Refused(*face, "set#1 MouthShapes = pipe", irregular);
  Refused(*face, "set#1 SaveMouthShapes = 14 pipe", irregular);
  Refused(*face, "set#1 Capture = pipe a 10", "'pipe' is not a folder");
  Refused(*face, "set#1 Record = pipe.mp4", irregular);
  Refused(*face, "set#1 Record = pipe.rgba", "nobody reads that pipe");
  face->WriteLine("set Record.sound = pipe.wav");
  face->WriteLine("set Record = film.mp4");
  Refused(*face, "set#1 Record = STOP", "'pipe.wav': 'pipe.wav" + irregular);
  face->WriteLine("set Capture = shots a 10");
  face->WriteLine("set LipSync.pho = pau 100");
  face->WriteLine("set Speak = NOW");
  Alive(*face);
  EXPECT_TRUE(face->ExpectError("a00001.bmp" + irregular)) << face->ErrorText();
}

TEST_F(NamedPipeTest, AReaderOfAPipeStillGetsTheFrames) {
  Pipes({"pipe.rgba"});
  const auto face = Start({});
  const int reader = open((folder / "pipe.rgba").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  face->WriteLine("set Record = pipe.rgba");
  face->WriteLine("set#1 Record = STOP");
  EXPECT_TRUE(face->Expect("rep#1 Record = STOP")) << face->ErrorText();
  std::vector<char> frame(64 * 64 * 4 + 1);
  EXPECT_EQ(read(reader, frame.data(), frame.size()), 64 * 64 * 4);
  close(reader);
}

TEST_F(NamedPipeTest, ThoseNamedInAConfigurationOfFacesAreRefusedWhenTheFaceIsWorn) {
  Pipes({"a.pnt"});
  std::ofstream(folder / "rest") << "";
  std::ofstream(folder / "config.txt")
      << "DEF_WFM_PNT rest\nDEF_WFM_LNK rest\nMaskFile a rest a.pnt\n";
  const auto face = Start({"-C", "config.txt", "--mask", "galatea"});
  Refused(*face, "set#1 Mask = a", "a.pnt' is not a regular file");
  Alive(*face);
}

TEST_F(NamedPipeTest, ThoseNamedInAHeadsFileDoNotHoldItUp) {
  Pipes({"pipe.bin", "pipe.mtl"});
  std::ofstream(folder / "a.gltf")
      << R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"pipe.bin"}]})";
  std::ofstream(folder / "a.obj") << "mtllib pipe.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
  for (const char* head : {"a.gltf", "a.obj"}) {
    const auto face = Start({"--head", head});
    face->WriteLine("set SaveImage = a.png");  // the head is read when it is first drawn
    face->CloseInput();
    EXPECT_TRUE(face->Wait()) << head;
  }
}

TEST_F(FsmProcessTest, SizeAndPositionAreTakenAsOptions) {
  EXPECT_EQ(Run("--headless -s 200 100 --position 0 0", "inq Window\n"), 0) << err;
  EXPECT_EQ(out, "rep Run = LIVE\nrep Window = 200 100\n");
}

TEST_F(FsmProcessTest, TwoNumbersAfterPAreThePlaceOfTheWindow) {
  EXPECT_EQ(Run("--headless -p 10 -20 -s 200 100", "inq Window\n"), 0) << err;
  EXPECT_EQ(out, "rep Run = LIVE\nrep Window = 200 100\n");
}

}  // namespace
}  // namespace fsm
