// The program on a film of a drawn head that says something else.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <sstream>

#include "face_fit/find/network/face_networks.h"
#include "tests/support/run.h"

namespace {

using support::Ran;
using support::RunToEnd;

std::string ReadBytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

constexpr std::size_t kWide = 320, kHigh = 320;

TEST(FilmDubProgramTest, AFilmThatIsNotThereIsNamedBeforeNetworksAre) {
  const auto ran = RunToEnd({GALATEA_BIN_DIR "/film_dub", "nope.mp4", "--text", "Good evening.",
                             "--networks", "/nowhere", "--out", "new.mkv"});
  EXPECT_EQ(ran.code, 1);
  EXPECT_EQ(ran.error, "film_dub: there is no 'nope.mp4'\n");
}

/// A head at rest for two seconds, half of them turned, with a humming sound; made once.
class FilmDubTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto networks = facefit::FaceNetworks::Load("");
    missing_ = networks ? "" : networks.error().text;
    if (!networks) return;
    folder_ = std::make_unique<support::TempDir>();
    support::Process fsm({GALATEA_BIN_DIR "/fsm", "--headless", "--clock", "virtual", "--size",
                          "320x320", "--mask", "pygmalion"});
    fsm.Write("set Camera = 1 0 25\nset Record.fps = 25\nset Record = " + Path("silent.mp4") +
              "\nset Wait = 1200\nset HeadRotAbs.1 = 0 12 0\nset Wait = 800\n"
              "set Record = STOP\n");
    fsm.CloseInput();
    fsm.ReadAll(support::Millis{120000});
    ASSERT_EQ(fsm.Wait(), 0) << fsm.ErrorText();
    Make({"-i", Path("silent.mp4"), "-f", "lavfi", "-i", "sine=frequency=200:duration=2", "-c:v",
          "copy", "-shortest", Path("film.mp4")});
  }
  static void TearDownTestSuite() { folder_.reset(); }
  void SetUp() override {
    if (!missing_.empty()) GTEST_SKIP() << missing_;
  }
  static std::string Path(const std::string& name) { return *folder_ / name; }
  static void Make(std::vector<std::string> words) {
    words.insert(words.begin(), {"ffmpeg", "-v", "error", "-nostdin", "-y"});
    const Ran made = RunToEnd(words);
    ASSERT_EQ(made.code, 0) << made.error;
  }
  static Ran Dub(std::vector<std::string> words) {
    words.insert(words.begin(), GALATEA_BIN_DIR "/film_dub");
    words.insert(words.end(), {"--field", "25", "--quiet"});
    return RunToEnd(words);
  }
  /// Every picture's bytes, RGB.
  static std::vector<std::string> Pictures(const std::string& name) {
    Make({"-i", Path(name), "-f", "rawvideo", "-pix_fmt", "rgb24", Path("raw")});
    const std::string bytes = ReadBytes(Path("raw"));
    std::vector<std::string> pictures;
    constexpr std::size_t kSize = kWide * kHigh * 3;
    for (std::size_t at = 0; at + kSize <= bytes.size(); at += kSize) {
      pictures.push_back(bytes.substr(at, kSize));
    }
    return pictures;
  }

 private:
  static inline std::string missing_;
  static inline std::unique_ptr<support::TempDir> folder_;
};

constexpr std::size_t kNose = kHigh * 11 / 24;  // a row above the mouth

/// How many bytes of two pictures differ by more than `least` above and below the nose.
struct Difference {
  std::size_t above = 0, below = 0;
  Difference(const std::string& a, const std::string& b, int least = 0) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const int off = static_cast<unsigned char>(a[i]) - static_cast<unsigned char>(b[i]);
      if (std::abs(off) > least) ++(i / (kWide * 3) < kNose ? above : below);
    }
  }
};

TEST_F(FilmDubTest, NewWordsMoveTheMouthAndNothingElse) {
  const Ran ran =
      Dub({Path("film.mp4"), "--text", "Ah, my mama bought two maps.", "--out", Path("new.mkv")});
  ASSERT_EQ(ran.code, 0) << ran.error;
  EXPECT_EQ(ran.out(), "film_dub: wrote " + Path("new.mkv") + "\n");
  const auto before = Pictures("film.mp4"), after = Pictures("new.mkv");
  ASSERT_GT(after.size(), 30U);
  constexpr int kPlain = 40;  // more than the codec makes of stillness
  std::size_t most = 0;
  for (std::size_t i = 5; i < after.size() / 2 - 4; ++i) {
    const Difference difference(before[10], after[i], kPlain);
    EXPECT_EQ(difference.above, 0U) << "picture " << i;
    most = std::max(most, difference.below);
  }
  EXPECT_GT(most, 200U) << "the mouth speaks";
}

TEST_F(FilmDubTest, OutsideOfTheMouthEveryPixelIsTheFilms) {
  Make({"-f", "lavfi", "-i", "anullsrc=r=16000:cl=mono", "-t", "2", Path("silence.wav")});
  const auto before = Pictures("film.mp4");
  const std::string length = std::to_string(static_cast<double>(before.size()) / 25);
  Make({"-f", "lavfi", "-i", "anullsrc=r=16000:cl=mono", "-t", length, Path("silence.wav")});
  const Ran ran =
      Dub({Path("film.mp4"), "--sound", Path("silence.wav"), "--out", Path("same.mkv")});
  ASSERT_EQ(ran.code, 0) << ran.error;
  const auto after = Pictures("same.mkv");
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Difference difference(before[i], after[i]);
    EXPECT_EQ(difference.above, 0U) << "picture " << i;
    EXPECT_LT(difference.below, kWide * kHigh * 3 / 12) << "picture " << i;
  }
}

TEST_F(FilmDubTest, TheNewFilmSaysThatItWasAlteredAndHasTheNewSound) {
  Make({"-f", "lavfi", "-i", "sine=frequency=900:duration=2:sample_rate=16000", Path("high.wav")});
  const Ran ran = Dub({Path("film.mp4"), "--sound", Path("high.wav"), "--out", Path("told.mkv")});
  ASSERT_EQ(ran.code, 0) << ran.error;
  const Ran told = RunToEnd({"ffprobe", "-v", "error", "-show_entries",
                             "format_tags:stream=codec_name", "-of", "csv", Path("told.mkv")});
  EXPECT_NE(told.out().find("stream,ffv1"), std::string::npos) << told.out();
  EXPECT_NE(told.out().find("stream,flac"), std::string::npos) << told.out();
  EXPECT_NE(told.out().find("Altered: what is said, and mouth and chin"), std::string::npos)
      << told.out();
  Make({"-i", Path("told.mkv"), "-f", "s16le", "-ac", "1", "-ar", "16000", Path("sound")});
  const std::string bytes = ReadBytes(Path("sound"));
  std::array<std::int16_t, 16000> samples{};
  ASSERT_GE(bytes.size(), sizeof samples);
  std::memcpy(samples.data(), bytes.data(), sizeof samples);
  int crossings = 0;
  for (std::size_t i = 1; i < samples.size(); ++i)
    crossings += samples[i - 1] < 0 && samples[i] >= 0;
  EXPECT_NEAR(crossings, 900, 10) << "in the first second";
}

TEST_F(FilmDubTest, WhatCannotBeDubbedIsOneSentenceAndNoFilm) {
  std::ofstream(Path("text.mp4")) << "this is no film";
  Make({"-f", "lavfi", "-i", "testsrc=size=320x240:rate=25:duration=1", Path("nobody.mp4")});
  Make({"-i", Path("film.mp4"), "-frames:v", "1", "-an", Path("one.mp4")});
  Make({"-f", "lavfi", "-i", "anullsrc=r=16000:cl=mono", "-t", "9", Path("long.wav")});
  struct Case {
    std::vector<std::string> words;
    const char* said;
  };
  const Case cases[] = {
      {{"/nothing/here.mp4", "--text", "Ah"}, "there is no '/nothing/here.mp4'"},
      {{Path("text.mp4"), "--text", "Ah"}, "is no film with a picture"},
      {{Path("one.mp4"), "--text", "Ah"}, "is a single picture, a film expected"},
      {{Path("nobody.mp4"), "--text", "Ah"}, "no face is seen in any of its 25 pictures"},
      {{Path("film.mp4"), "--sound", Path("text.mp4")}, "cannot read '"},
      {{Path("film.mp4"), "--sound", Path("long.wav")}, "its new sound 9.00: expected at most 2"},
      {{Path("film.mp4")}, "--text or --sound expected"},
      {{"camera", "--text", "Ah"}, "'camera' can be seen only once"},
      {{Path("film.mp4"), "--sound", Path("long.wav"), "--voices", "v.json"}, "--voices: --text"},
      {{Path("film.mp4"), "--text", "Ah", "--voice", "nobody"}, "nobody"},
  };
  for (const auto& [words, said] : cases) {
    auto all = words;
    all.insert(all.end(), {"--out", Path("none.mkv")});
    const Ran ran = Dub(all);
    EXPECT_EQ(ran.code, 1) << said;
    // The voice may have said on standard error, too, what it refuses.
    const auto own = ran.error.find("film_dub: ");
    ASSERT_NE(own, std::string::npos) << said;
    EXPECT_NE(ran.error.find(said, own), std::string::npos) << ran.error;
    EXPECT_EQ(ran.error.find('\n', own), ran.error.size() - 1) << ran.error;
    EXPECT_TRUE(ReadBytes(Path("none.mkv")).empty());
  }
  const std::string film = ReadBytes(Path("film.mp4"));
  EXPECT_NE(Dub({Path("film.mp4"), "--text", "Ah", "--out", Path("film.mp4")})
                .error.find("would be overwritten"),
            std::string::npos);
  EXPECT_EQ(ReadBytes(Path("film.mp4")), film);
  EXPECT_NE(Dub({Path("film.mp4"), "--text", "Ah", "--out", Path("new.avi")})
                .error.find("is no film's name"),
            std::string::npos);
}

}  // namespace
