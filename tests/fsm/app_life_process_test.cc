// What the real program's face does by itself, part by part, seen in films of it.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace fsm {
namespace {

struct IdleFilmTest : testing::Test {
  IdleFilmTest() {
    char name[] = "/tmp/galatea_life_XXXXXX";
    EXPECT_NE(mkdtemp(name), nullptr);
    folder = name;
  }
  ~IdleFilmTest() override { std::filesystem::remove_all(folder); }

  /// The pictures, byte by byte, of a film of what the lines make the face do.
  std::string Film(const std::string& lines, const std::string& options = "") {
    std::ofstream(folder / "in.txt") << "set Record.fps = 10\n" << lines << "set#1 Record = STOP\n";
    const std::string command = "cd " + folder.string() + " && unset DISPLAY WAYLAND_DISPLAY && " +
                                GALATEA_BIN_DIR "/fsm --headless --strict --size 64x64 " + options +
                                " < in.txt > out.txt 2> err.txt";
    EXPECT_EQ(std::system(command.c_str()), 0) << Read("err.txt");
    return Read("film.rgba");
  }
  std::string Read(const char* file) const {
    std::ifstream in(folder / file, std::ios::binary);
    std::ostringstream bytes;
    bytes << in.rdbuf();
    return bytes.str();
  }

  std::filesystem::path folder;
};

constexpr const char* kRecord = "set Record = film.rgba\n";
constexpr const char* kUtterance =
    "set LipSync.pho = pau 100 dh 60 ih 90 s 100 ih 80 z 90 ax 60 l 90 ao 160 ng 110 s 110 eh "
    "160 n 80 t 60 ax 70 n 80 s 120 w 80 ih 120 th 80 s 90 t 60 r 60 eh 160 s 110 pau 300\n"
    "set Speak = + 100\nset Wait = IDLE\nset Wait = 500\n";

struct Part {
  const char* name;
  std::string meanwhile;  ///< in which the part has something to do
};

TEST_F(IdleFilmTest, EveryPartMovesTheFaceAloneAndSwitchedOffItDoesNot) {
  const std::string rest = "set Wait = 2000\n";
  const std::string long_rest = "set Wait = 7000\n";
  const std::string glances =
      "set Gaze = 25 0\nset Wait = 600\nset Gaze = -25 10\nset Wait = 600\nset Gaze = 25 -10\n"
      "set Wait = 600\n";
  const Part parts[] = {{"BLINK", long_rest},
                        {"MOVE", rest},
                        {"GAZE", rest},
                        {"BREATH", rest},
                        {"NODS", long_rest},
                        {"FACE", "set Wait = 1500\n"},
                        {"SPEECH", kUtterance},
                        {"AVERT", kUtterance},
                        {"ENDBLINK", std::string(kUtterance) + kUtterance},
                        {"GAZEBLINK", glances},
                        {"ASYMMETRY", "set FaceExp = HAPPY 1 100 400\nset Wait = 600\n"}};
  std::map<std::string, std::string> without;  // films of nothing, by what is done meanwhile
  for (const Part& part : parts) {
    // All others are off. What moved comes to rest softly, so films begin after that.
    const std::string off = "set Life = OFF\nset Autonomous = ASYMMETRY 0\n";
    const std::string settle = "set Wait = 4000\n";
    const std::string on = "set Autonomous = " + std::string(part.name) + " 1\n";
    const std::string stop = "set Autonomous = " + std::string(part.name) + " 0\n";
    std::string& never = without[part.meanwhile];
    if (never.empty()) never = Film(off + settle + kRecord + part.meanwhile);
    ASSERT_GT(never.size(), 64U * 64 * 4 * 5) << part.name;
    EXPECT_NE(Film(off + on + settle + kRecord + part.meanwhile), never)
        << part.name << " moves nothing";
    EXPECT_EQ(Film(off + on + stop + settle + kRecord + part.meanwhile), never)
        << part.name << " goes on";
  }
}

TEST_F(IdleFilmTest, ASeedsFilmIsTheSameToTheByteAndAnotherSeedsIsNot) {
  const std::string lines = std::string("set Life = LIVELY\n") + kRecord + kUtterance;
  const std::string film = Film(lines, "--seed 7");
  ASSERT_GT(film.size(), 64U * 64 * 4 * 20);
  EXPECT_EQ(Film(lines, "--seed 7"), film);
  EXPECT_NE(Film(lines, "--seed 8"), film);
}

}  // namespace
}  // namespace fsm
