// The program on films of built-in heads whose movement is known, spoiled as films are; on several
// faces; and on what is no film.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "face_fit/find/network/face_networks.h"
#include "tests/support/run.h"

namespace {

struct Ran : support::Ran {
  /// Of a CSV: each line by the names of the first.
  std::vector<std::map<std::string, std::string>> Rows() const {
    const auto cells = [](const std::string& line) {
      std::vector<std::string> found(1);
      for (const char c : line) {
        if (c == ',')
          found.emplace_back();
        else
          found.back() += c;
      }
      return found;
    };
    std::vector<std::map<std::string, std::string>> rows;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      const auto names = cells(lines[0]), values = cells(lines[i]);
      EXPECT_EQ(names.size(), values.size());
      for (std::size_t k = 0; k < std::min(names.size(), values.size()); ++k) {
        if (k == 0) rows.emplace_back();
        rows.back()[names[k]] = values[k];
      }
    }
    return rows;
  }
};

Ran RunProgram(const std::vector<std::string>& words) { return {support::RunToEnd(words)}; }

Ran Track(std::vector<std::string> words) {
  words.insert(words.begin(), GALATEA_BIN_DIR "/face_track");
  words.insert(words.end(), {"--field", "25", "--quiet"});
  return RunProgram(words);
}

constexpr int kRate = 15;

TEST(FaceTrackProgramTest, AFilmThatIsNotThereIsNamedBeforeNetworksAre) {
  const Ran ran = RunProgram({GALATEA_BIN_DIR "/face_track", "nope.mp4", "--networks", "/nowhere"});
  EXPECT_EQ(ran.code, 1);
  EXPECT_EQ(ran.error, "face_track: there is no 'nope.mp4'\n");
}

/// Films of two heads at rest that then turn to the right and shut their eyes, made once.
class FaceTrackTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto networks = facefit::FaceNetworks::Load("");
    missing_ = networks ? "" : networks.error().text;
    if (!networks) return;
    folder_ = std::make_unique<support::TempDir>();
    Film("baucis");
    Film("pygmalion");
  }
  static void TearDownTestSuite() { folder_.reset(); }
  void SetUp() override {
    if (!missing_.empty()) GTEST_SKIP() << missing_;
  }
  static std::string Path(const std::string& name) { return *folder_ / name; }

  /// 1.2 s of rest, 0.8 s turned, 0.6 s back at rest, 0.6 s of shut eyes.
  static void Film(const std::string& head) {
    support::Process fsm({GALATEA_BIN_DIR "/fsm", "--headless", "--clock", "virtual", "--size",
                          "400x400", "--mask", head});
    fsm.Write("set Camera = 1 0 25\nset Record.fps = " + std::to_string(kRate) +
              "\nset Record = " + Path(head + ".mp4") +
              "\nset Wait = 1200\nset HeadRotAbs.1 = 0 20 0\nset Wait = 800\n"
              "set HeadRotAbs.1 = 0 0 0\nset Wait = 600\nset AU = 43 1 60\nset Wait = 600\n"
              "set Record = STOP\n");
    fsm.CloseInput();
    fsm.ReadAll(support::Millis{120000});
    ASSERT_EQ(fsm.Wait(), 0) << fsm.ErrorText();
  }
  /// Made by ffmpeg; the last word is a name in the folder.
  static std::string Made(std::vector<std::string> words) {
    words.insert(words.begin(), {"ffmpeg", "-v", "error", "-nostdin"});
    words.back() = Path(words.back());
    const Ran made = RunProgram(words);
    EXPECT_EQ(made.code, 0) << made.error;
    return words.back();
  }
  /// By how many degrees the head is turned farther to the right in picture 28 than in picture 14.
  static double Turn(const Ran& ran) {
    const auto rows = ran.Rows();
    if (rows.size() < 29) return 0;
    return std::stod(rows[28].at("right")) - std::stod(rows[14].at("right"));
  }
  static void ExpectTurn(const Ran& ran, double tolerance, double shut = 0.4) {
    ASSERT_EQ(ran.code, 0) << ran.error;
    const auto rows = ran.Rows();
    ASSERT_GT(rows.size(), 45U);
    for (const auto& row : rows) EXPECT_EQ(row.at("person"), "1") << row.at("ms");
    const auto value = [&](std::size_t row, const char* name) {
      return std::stod(rows[row].at(name));
    };
    EXPECT_NEAR(Turn(ran), 20, tolerance);
    EXPECT_NEAR(value(28, "down") - value(14, "down"), 0, tolerance);
    EXPECT_NEAR(value(28, "tilt") - value(14, "tilt"), 0, tolerance);
    EXPECT_GT(value(37, "lidR"), 0.7);
    EXPECT_LT(value(46, "lidR"), shut);
    EXPECT_LT(value(46, "lidL"), shut);
  }

 private:
  static inline std::string missing_;
  static inline std::unique_ptr<support::TempDir> folder_;
};

TEST_F(FaceTrackTest, ATurnIsFollowedWithinADegreeAndAHalfAndShutLidsAreSeen) {
  ExpectTurn(Track({Path("baucis.mp4"), "--plot", Path("plot.svg")}), 1.5);
  std::ifstream plot(Path("plot.svg"));
  std::stringstream svg;
  svg << plot.rdbuf();
  EXPECT_NE(svg.str().find("</svg>"), std::string::npos);
}

TEST_F(FaceTrackTest, AHeadThatShowsUnitsFirstIsToldTheirDosesAfterwards) {
  const auto film = [](const std::string& name, const std::string& dose) {
    support::Process fsm({GALATEA_BIN_DIR "/fsm", "--headless", "--clock", "virtual", "--size",
                          "400x400", "--mask", "baucis"});
    std::string lines = "set Camera = 1 0 25\nset Record.fps = " + std::to_string(kRate) +
                        "\nset Record = " + Path(name) + "\nset Wait = 1200\n";
    for (const char* unit : {"6", "14"}) {
      lines += std::string("set AU = ") + unit + " " + dose +
               " 60\nset Wait = 1000\nset AU = " + unit + " 0 60\nset Wait = 500\n";
    }
    fsm.Write(lines + "set Record = STOP\n");
    fsm.CloseInput();
    fsm.ReadAll(support::Millis{120000});
    EXPECT_EQ(fsm.Wait(), 0) << fsm.ErrorText();
  };
  film("shown.mp4", "1");
  film("less.mp4", "0.7");
  std::ofstream(Path("prompts.txt")) << "show 1.3 2.3 6\nshow 2.8 3.8 14\n";
  const Ran learned = Track(
      {Path("shown.mp4"), "--learn-units", Path("prompts.txt"), "--out", Path("baucis.units")});
  ASSERT_EQ(learned.code, 0) << learned.error;
  // How far the doses of units 6 and 14 are from 0.7 as they are held.
  const auto off = [](std::vector<std::string> more) {
    more.insert(more.begin(), Path("less.mp4"));
    const Ran ran = Track(more);
    EXPECT_EQ(ran.code, 0) << ran.error;
    const auto rows = ran.Rows();
    return std::pair(std::abs(std::stod(rows.at(30).at("au6L")) - 0.7),
                     std::abs(std::stod(rows.at(52).at("au14L")) - 0.7));
  };
  const auto usual = off({}), own = off({"--person", Path("baucis.units")});
  EXPECT_LT(own.first, 0.15);
  EXPECT_LT(own.second, 0.15);
  EXPECT_GT(usual.first + usual.second, own.first + own.second);
  const Ran damaged = Track({Path("less.mp4"), "--person", Path("prompts.txt")});
  EXPECT_EQ(damaged.code, 1);
  EXPECT_EQ(damaged.error, "face_track: " + Path("prompts.txt") + ":1: expected 'shown'\n");
}

TEST_F(FaceTrackTest, NoiseCompressionAndHalfLightChangeLittleAndLessWithCare) {
  // The turn read from one noisy film is off by up to 0.9 degrees with the noise alone, so several
  // noises are averaged.
  constexpr int kNoises = 3;
  const double clean = Turn(Track({Path("baucis.mp4")}));
  double usual = 0, careful = 0;
  for (int seed = 1; seed <= kNoises; ++seed) {
    const std::string noise = "noise=all_seed=" + std::to_string(seed) + ":alls=8:allf=t";
    const std::string film =
        Made({"-y", "-i", Path("baucis.mp4"), "-vf", noise + ",eq=brightness=-0.1:contrast=0.6",
              "-b:v", "300k", "spoiled.mp4"});
    const Ran once = Track({film}), twice = Track({film, "--careful"});
    ExpectTurn(once, 3, 0.5);
    ExpectTurn(twice, 3, 0.5);
    usual += std::abs(Turn(once) - clean) / kNoises;
    careful += std::abs(Turn(twice) - clean) / kNoises;
  }
  EXPECT_LT(usual, 1.5);
  EXPECT_LT(careful, usual);
}

TEST_F(FaceTrackTest, InStrongNoiseAFastTurnIsNoCutAndTheSamePersonIsFollowed) {
  ExpectTurn(Track({Made({"-i", Path("baucis.mp4"), "-vf", "noise=alls=25:allf=t", "noisy.mp4"})}),
             1.5, 0.5);
}

TEST_F(FaceTrackTest, AFaceThatIsHiddenIsFoundAgainWithinThreePicturesAsTheSamePerson) {
  const auto rows =
      Track({Made({"-i", Path("baucis.mp4"), "-vf",
                   "drawbox=c=gray:t=fill:enable='between(n,34,38)'", "-r", "15", "hidden.mp4"})})
          .Rows();
  ASSERT_GT(rows.size(), 45U);
  for (std::size_t i = 34; i <= 38; ++i) EXPECT_EQ(rows[i].at("person"), "0") << i;
  EXPECT_EQ(rows[36].at("right"), "");
  for (std::size_t i = 41; i < rows.size(); ++i) EXPECT_EQ(rows[i].at("person"), "1") << i;
}

TEST_F(FaceTrackTest, AfterACutToAnotherFaceAnotherPersonIsMet) {
  // Between baucis and pygmalion, whose hair and skin are about as light, no cut is seen.
  Film("memnon");
  std::ofstream(Path("list.txt")) << "file baucis.mp4\nfile memnon.mp4\n";
  const Ran ran = Track({Made({"-f", "concat", "-i", Path("list.txt"), "-c", "copy", "cut.mp4"})});
  const auto rows = ran.Rows();
  ASSERT_EQ(ran.code, 0) << ran.error;
  ASSERT_GT(rows.size(), 90U);
  EXPECT_EQ(rows[40].at("person"), "1");
  EXPECT_EQ(rows[rows.size() / 2 + 5].at("person"), "2");
  EXPECT_EQ(rows.back().at("person"), "2");
}

TEST_F(FaceTrackTest, OfTwoFacesTheLargestIsFollowedOrTheOneAskedFor) {
  const std::string film =
      Made({"-i", Path("baucis.mp4"), "-i", Path("pygmalion.mp4"), "-filter_complex",
            "[1]scale=280:280,pad=400:400:60:60[b];[0][b]hstack", "-t", "1", "two.mp4"});
  const auto large = Track({film}).Rows(), small = Track({film, "--which", "2"}).Rows();
  ASSERT_GT(large.size(), 10U);
  ASSERT_GT(small.size(), 10U);
  EXPECT_LT(std::stod(large.back().at("x")), -50);  // on the left
  EXPECT_GT(std::stod(small.back().at("x")), 50);
  EXPECT_LT(std::stod(small.back().at("z")), 1.2 * std::stod(large.back().at("z")));  // farther
  const Ran none = Track({film, "--which", "5"});
  EXPECT_EQ(none.code, 1);
  EXPECT_NE(none.error.find("no face is seen"), std::string::npos) << none.error;
}

TEST_F(FaceTrackTest, OnePictureAndAFilmOfFourThousandPixelsAreFollowed) {
  const Ran one = Track({Made({"-i", Path("baucis.mp4"), "-frames:v", "1", "one.mp4"})});
  EXPECT_EQ(one.code, 0) << one.error;
  EXPECT_EQ(one.Rows().size(), 1U);
  const Ran large = Track({Made({"-i", Path("baucis.mp4"), "-frames:v", "2", "-vf",
                                 "scale=2160:2160,pad=3840:2160:840:0", "large.mp4"})});
  EXPECT_EQ(large.code, 0) << large.error;
  ASSERT_EQ(large.Rows().size(), 2U);
  EXPECT_NEAR(std::stod(large.Rows()[0].at("z")), std::stod(one.Rows()[0].at("z")), 10);
}

TEST_F(FaceTrackTest, TimesAreThoseOfThePicturesWhereTheRateVaries) {
  const Ran ran = Track(
      {Made({"-i", Path("baucis.mp4"), "-frames:v", "6", "-vf", "setpts='if(lt(N,3),N/15,N/5)/TB'",
             "-fps_mode", "vfr", "-r", "30", "varying.mkv"})});
  ASSERT_EQ(ran.code, 0) << ran.error;
  const auto rows = ran.Rows();
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_NEAR(std::stod(rows[2].at("ms")), 133, 20);
  EXPECT_NEAR(std::stod(rows[5].at("ms")), 1000, 20);
}

TEST_F(FaceTrackTest, AFolderOfPicturesAndArkitAndJsonComeOut) {
  std::filesystem::create_directory(Path("pictures"));
  Made({"-i", Path("baucis.mp4"), "-frames:v", "4", "pictures/%03d.png"});
  const Ran arkit = Track({Path("pictures"), "--rate", "10", "--format", "arkit"});
  ASSERT_EQ(arkit.code, 0) << arkit.error;
  ASSERT_EQ(arkit.Rows().size(), 4U);
  EXPECT_EQ(arkit.Rows()[1].at("ms"), "100.0");
  EXPECT_EQ(arkit.Rows()[1].count("eyeBlinkLeft"), 1U);
  const Ran json = Track({Path("pictures"), "--format", "jsonl", "--landmarks"});
  ASSERT_EQ(json.lines.size(), 4U);
  EXPECT_TRUE(json.lines[0].starts_with("{\"ms\":0.0,\"person\":1,")) << json.lines[0];
  EXPECT_TRUE(json.lines[0].ends_with("]]}"));
}

TEST_F(FaceTrackTest, TheMouthIsToldInParametersThatTriphonesLearnFrom) {
  // Rows of fsm/motion/tables/mouth_shapes.txt, each held for 480 ms after 1.2 s of rest.
  const std::pair<const char*, const char*> shapes[] = {
      {"a", "0.4 0 0.5 0 -0.9 0 -0.72 0 0 0 0 9 0 0 0 0 0 0 0"},
      {"m", "-1.9 -0.6 -0.6 -1.6 1 -1.8 2.3 -0.8 0.4 0 -0.5 1 0 -0.6 -0.4 0.6 -0.4 1 0.2"},
      {"o", "0.32 5 0.4 4.5 -0.6 4.5 -0.48 5 -5 0 2.25 5 0 0.2 0 0.2 0 0 0.1"},
      {"i", "0.64 -1 0.8 -0.9 -1.4 -0.9 -1.12 -1 3.5 0.5 -1.2 2 0 -0.1 -0.2 -0.1 -0.2 0 0.5"}};
  std::string lines =
      "set Camera = 1 0 25\nset Record.fps = 25\nset Record = " + Path("speaks.mp4") +
      "\nset Wait = 1200\nset MouthFrame.start = NOW\n";
  int ms = 0;
  for (const auto& [name, numbers] : shapes) {
    for (int k = 0; k < 24; ++k, ms += 20) {
      lines += "set MouthFrame = " + std::to_string(ms) + " " + numbers + "\n";
    }
  }
  support::Process fsm({GALATEA_BIN_DIR "/fsm", "--headless", "--clock", "virtual", "--size",
                        "400x400", "--mask", "baucis"});
  fsm.Write(lines + "set Wait = 1920\nset Record = STOP\n");
  fsm.CloseInput();
  fsm.ReadAll(support::Millis{120000});
  ASSERT_EQ(fsm.Wait(), 0) << fsm.ErrorText();

  const Ran ran = Track({Path("speaks.mp4"), "--mouth", "--out", Path("speaks.csv")});
  ASSERT_EQ(ran.code, 0) << ran.error;
  std::ifstream file(Path("speaks.csv"));
  std::stringstream text;
  text << file.rdbuf();
  Ran track;
  for (std::string line; std::getline(text, line);) track.lines.push_back(line);
  const auto rows = track.Rows();
  ASSERT_GT(rows.size(), 74U);
  const auto at = [&](int shape, const char* name) {
    return std::stod(rows[static_cast<std::size_t>(30 + 12 * shape + 9)].at(name));
  };
  EXPECT_NEAR(at(0, "m12"), 9, 2);
  EXPECT_NEAR(at(0, "m9"), 0, 1.5);
  EXPECT_EQ(at(0, "seal"), 0);
  EXPECT_GT(at(1, "seal"), 0.9);
  EXPECT_LT(at(1, "m12"), 2);
  EXPECT_NEAR(at(2, "m9"), -5, 3);            // rounding comes out at half its size
  EXPECT_GT(at(2, "m2"), at(3, "m2") + 1.5);  // of 6: film from the front hardly shows it
  EXPECT_EQ(at(2, "seal"), 0);
  EXPECT_NEAR(at(3, "m9"), 3.5, 1.5);
  EXPECT_LT(at(3, "m2"), 0.5);
  EXPECT_EQ(at(3, "tongue"), 0);
  EXPECT_EQ(Track({Path("baucis.mp4")}).Rows()[20].count("m1"), 0U);

  if (!std::filesystem::exists(GALATEA_BIN_DIR "/vdm_train")) return;
  std::ofstream(Path("speaks.pho")) << "pau[1200] a[480] m[480] o[480] i[480]\n";
  std::ofstream(Path("speaks.list")) << "speaks.pho speaks.csv\n";
  const Ran learned = RunProgram({GALATEA_BIN_DIR "/vdm_train", Path("speaks.tri"), "--triphones",
                                  "--recordings", Path("speaks.list")});
  EXPECT_EQ(learned.code, 0) << learned.error;
}

TEST_F(FaceTrackTest, ABrokenFilmIsFollowedAsFarAsItGoes) {
  const std::string whole = Made({"-i", Path("baucis.mp4"), "-c", "copy", "whole.ts"});
  std::filesystem::resize_file(whole, std::filesystem::file_size(whole) / 2);
  const Ran ran = Track({whole});
  EXPECT_EQ(ran.code, 0) << ran.error;
  EXPECT_GT(ran.Rows().size(), 5U);
  std::filesystem::copy_file(Path("baucis.mp4"), Path("torn.mp4"));
  std::filesystem::resize_file(Path("torn.mp4"), 2000);
  const Ran torn = Track({Path("torn.mp4")});
  EXPECT_EQ(torn.code, 1);
  EXPECT_NE(torn.error.find("is no film with a picture"), std::string::npos) << torn.error;
}

TEST_F(FaceTrackTest, WordsForFfmpegCannotMakeItWriteFiles) {
  const Ran lavfi = Track({"ffmpeg:-f lavfi -t 1 -i testsrc=r=4"});
  EXPECT_NE(lavfi.error.find("no face is seen in any of its 4"), std::string::npos) << lavfi.error;
  const std::string film = Path("baucis.mp4"), out = Path("written.mp4");
  for (const std::string& words :
       {"-i " + film + " " + out, "-re " + out + " -i " + film, "-i " + film + " -f " + out,
        std::string("-f lavfi"), "-f lavfi -i testsrc,metadata=mode=print:file=" + out}) {
    const Ran ran = Track({"ffmpeg:" + words});
    EXPECT_EQ(ran.code, 1) << words;
    EXPECT_NE(ran.error.find("expected"), std::string::npos) << ran.error;
  }
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(FaceTrackTest, AFilmReachesNoOtherFile) {
  std::ofstream(Path("list.m3u8"))
      << "#EXTM3U\n#EXT-X-TARGETDURATION:9\n#EXTINF:9,\nfile:" << Path("baucis.mp4")
      << "\n#EXT-X-ENDLIST\n";
  std::ofstream(Path("list.mp4")) << "ffconcat version 1.0\nfile baucis.mp4\n";
  ASSERT_EQ(mkfifo(Path("pipe").c_str(), 0600), 0);
  for (const auto& [name, error] : {std::pair("list.m3u8", "is no film with a picture"),
                                    {"list.mp4", "is no film with a picture"},
                                    {"pipe", "is not a regular file"}}) {
    const Ran ran = Track({Path(name)});
    EXPECT_EQ(ran.code, 1) << name;
    EXPECT_NE(ran.error.find(error), std::string::npos) << ran.error;
  }
}

TEST_F(FaceTrackTest, WhatAFilmSaysOfItselfIsNotTakenForAPicture) {
  Made({"-f", "lavfi", "-i", "testsrc=r=5", "-t", "1", "-metadata",
        "title=showinfo pts_time:1 s:2000000000x2000000000", "title.mp4"});
  const Ran ran = Track({Path("title.mp4")});
  EXPECT_NE(ran.error.find("no face is seen in any of its 5"), std::string::npos) << ran.error;
}

TEST_F(FaceTrackTest, WhatIsNoFilmOfAFaceIsOneErrorThatNamesIt) {
  std::ofstream(Path("text.mp4")) << "no film\n";
  std::filesystem::create_directory(Path("empty"));
  std::filesystem::create_directory(Path("sizes"));
  Made({"-f", "lavfi", "-i", "color=s=200x200", "-frames:v", "1", "sizes/1.png"});
  Made({"-f", "lavfi", "-i", "color=s=100x100", "-frames:v", "1", "sizes/2.png"});
  Made({"-f", "lavfi", "-i", "sine", "-t", "1", "sound.wav"});
  Made({"-f", "lavfi", "-i", "testsrc=r=5", "-t", "1", "nobody.mp4"});
  const std::pair<std::string, std::string> kBad[] = {
      {"text.mp4", "is no film with a picture"},
      {"none.mp4", "there is no"},
      {"empty", "holds no .png"},
      {"sizes", "all of a folder are of one size"},
      {"sound.wav", "is no film with a picture"},
      {"nobody.mp4", "no face is seen in any of its 5"}};
  for (const auto& [name, error] : kBad) {
    const Ran ran = Track({Path(name)});
    EXPECT_EQ(ran.code, 1) << name;
    EXPECT_NE(ran.error.find(error), std::string::npos) << ran.error;
    EXPECT_NE(ran.error.find(name), std::string::npos) << ran.error;
    EXPECT_EQ(std::ranges::count(ran.error, '\n'), 1) << ran.error;
  }
}

}  // namespace
