// Learning heads: what a network can know it learns, lists of recordings, and how heads are
// compared.

#include "vdm/train/head_training.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "vdm/prosody/head_mover.h"
#include "vdm/train/distortion.h"
#include "vdm/train/head_score.h"

namespace vdm {
namespace {

/// The head is down with the pitch of now and to the right with the power of 100 ms ago; the tilt
/// is by chance in each phrase.
std::vector<HeadLesson> Lessons(std::size_t sounds) {
  std::vector<HeadLesson> lessons;
  Dice dice(4);
  for (int n = 0; n < 8; ++n) {
    HeadLesson lesson{
        .who = "made",
        .inputs = Eigen::MatrixXf::Zero(static_cast<Eigen::Index>(HeadNet::Inputs(sounds)), 400),
        .truth = Eigen::MatrixXf::Zero(4, 400),
        .phrase = std::vector<std::uint64_t>(400)};
    double tilt = 0;
    for (Eigen::Index k = 0; k < 400; ++k) {
      const std::uint64_t phrase = 1 + static_cast<std::uint64_t>(k) / 100;
      if (k % 100 == 0) tilt = dice.Normal();
      lesson.phrase[static_cast<std::size_t>(k)] = k % 100 < 90 ? phrase : 0;
      for (Eigen::Index i = 0; i < lesson.inputs.rows(); ++i) {
        lesson.inputs(i, k) = std::sin(0.05F * static_cast<float>(k + 17 * i + 90 * n) *
                                       (1 + 0.1F * static_cast<float>(i)));
      }
      const auto instant = static_cast<Eigen::Index>(HeadNet::InstantSize(sounds));
      lesson.truth(0, k) = 2 * lesson.inputs(0, k);
      lesson.truth(1, k) = lesson.inputs(5 * instant + 1, k);
      lesson.truth(2, k) = static_cast<float>(tilt);
      lesson.truth(3, k) = 0.1F;
    }
    lessons.push_back(std::move(lesson));
  }
  return lessons;
}

TEST(HeadTrainingTest, WhatPitchAndPowerSayIsLearnedTheRestIsAPose) {
  const auto lessons = Lessons(0);
  double last = 1;
  const HeadNet net = LearnHead({}, lessons, [&](std::size_t, double error) { last = error; });
  EXPECT_LT(last, 0.4);
  double off = 0, all = 0;
  for (const HeadLesson& lesson : lessons) {
    for (Eigen::Index k = 0; k < 90; ++k) {
      const HeadPose pose = PoseOf(net, lesson.inputs.col(k));
      off += std::pow(pose.angles[0] - lesson.truth(0, k), 2);
      all += std::pow(lesson.truth(0, k), 2);
    }
  }
  EXPECT_LT(off, 0.3 * all);
  EXPECT_GT(net.pose[2], 0.5F);
  EXPECT_LT(net.pose[0], 0.5F);
}

TEST(HeadTrainingTest, TheSameLessonsGiveTheSameNetwork) {
  const auto quiet = [](std::size_t, double) {};
  const HeadPlan plan{.width = 6, .epochs = 3};
  EXPECT_EQ(FormatHeadNet(LearnHead(plan, Lessons(0), quiet)),
            FormatHeadNet(LearnHead(plan, Lessons(0), quiet)));
}

TEST(HeadTrainingTest, TalksAreOfOneVoiceWithPauses) {
  std::vector<Take> takes;
  for (int n = 0; n < 7; ++n) {
    takes.push_back({.voice = n < 5 ? "a" : "b",
                     .samples = std::vector<std::int16_t>(1600, 1),
                     .phonemes = vm::ParsePhonemes("aa 100").value()});
  }
  const auto talks = TalksOf(takes, 2, Dice(1));
  ASSERT_EQ(talks.size(), 3U);  // the fifth of a is left
  EXPECT_EQ(talks[2].voice, "b");
  for (const Talk& talk : talks) {
    EXPECT_EQ(talk.phonemes.size(), 4U);
    EXPECT_EQ(talk.samples.size(),
              static_cast<std::size_t>(vm::TotalDuration(talk.phonemes).count()) * 16 + 16000);
  }
}

TEST(HeadTrainingTest, TheTextDrivenHeadIsTheFacesOwnAndGrowsWithTheEmotion) {
  const fsm::MotionTables tables = fsm::MotionTables::Load().value();
  const Talk talk{
      .voice = "a",
      .samples = {},
      .phonemes = vm::ParsePhonemes("pau 300 m 80 aa 250 m 80 ih 60 m 80 aa 220").value()};
  const HeadTruth calm = TextDrivenHead(talk, 0, tables, 5),
                  lively = TextDrivenHead(talk, 1, tables, 5);
  const auto& sizes = tables.motions.auto_speeches;
  for (double ms = 0; ms < 1200; ms += 50) {
    EXPECT_NEAR(lively(ms).angles[0], calm(ms).angles[0] * sizes[1].nod / sizes[0].nod, 1e-4) << ms;
    EXPECT_NEAR(lively(ms).angles[1], calm(ms).angles[1] * sizes[1].turn / sizes[0].turn, 1e-4);
  }
}

class HeadListTest : public testing::Test {
 protected:
  HeadListTest() { std::filesystem::create_directories(folder_); }
  ~HeadListTest() override { std::filesystem::remove_all(folder_); }
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  void WriteWav(const std::string& name, std::size_t samples) const {
    const auto bytes = [](std::uint32_t value, int count) {
      std::string text;
      for (int i = 0; i < count; ++i) text += static_cast<char>(value >> (8 * i) & 0xFF);
      return text;
    };
    std::string sound;
    for (std::size_t i = 0; i < samples; ++i) {
      sound += bytes(static_cast<std::uint32_t>(
                         static_cast<std::int32_t>(3000 * std::sin(0.05 * static_cast<double>(i)))),
                     2);
    }
    const auto size = static_cast<std::uint32_t>(sound.size());
    Write(name, "RIFF" + bytes(36 + size, 4) + "WAVEfmt " + bytes(16, 4) + bytes(1, 2) +
                    bytes(1, 2) + bytes(16000, 4) + bytes(32000, 4) + bytes(2, 2) + bytes(16, 2) +
                    "data" + bytes(size, 4) + sound);
  }
  std::string ErrorOf(const std::string& list) const {
    const auto lessons = ReadHeadLessons(Write("list", list), 0, 0);
    if (lessons) return "none";
    std::string text = lessons.error().text;
    for (std::size_t at; (at = text.find(folder_.string() + "/")) != text.npos;) {
      text.erase(at, folder_.string().size() + 1);
    }
    return text;
  }
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("head_list_test_" + std::to_string(::getpid()));
};

TEST_F(HeadListTest, ARecordingsAnglesAreSampledWithItsSound) {
  WriteWav("a.wav", 16000);
  Write("a.csv",
        "ms,tilt,down,right,brow,more\n0,1,0,-5,0.5,x\n100,1,10,-5,0.5,x\n500,1,10,-5,0.5,x\n");
  const auto lessons = ReadHeadLessons(Write("list", "# mine\na.wav a.csv 0.5\n"), 0, 0);
  ASSERT_TRUE(lessons) << lessons.error().text;
  ASSERT_EQ(lessons->size(), 1U);
  const HeadLesson& lesson = lessons->front();
  EXPECT_NEAR(lesson.truth(0, 5), 5, 1e-4);
  EXPECT_NEAR(lesson.truth(1, 5), -5, 1e-4);
  EXPECT_NEAR(lesson.truth(2, 5), 1, 1e-4);
  EXPECT_NEAR(lesson.truth(3, 5), 0.5, 1e-4);
  EXPECT_EQ(lesson.inputs(lesson.inputs.rows() - 1, 5), 0.5F);
  for (std::size_t k = 11; k < lesson.phrase.size(); ++k) {
    EXPECT_EQ(lesson.phrase[k], 0U) << "instants 400 ms apart are not learned from";
  }
}

TEST_F(HeadListTest, WhatFaceTrackPrintsOfAFilmIsReadAsItIs) {
  WriteWav("a.wav", 16000);
  const std::string names =
      "ms,person,certainty,down,right,tilt,x,lidR,jaw,au1R,au1L,au2R,au2L,miss\n";
  Write("a.csv", names +
                     "0.0,1,0.9,3,-4,2,0,1,0,0.4,0.6,0,0,1\n"
                     "100.0,1,0.9,13,-4,2,0,1,0,0.4,0.6,0,0,1\n"
                     "140.0,0,0,,,,,,,,,,,\n"
                     "180.0,1,0.9,3,-4,2,0,1,0,0.4,0.6,0,0,1\n"
                     "500.0,0,0,,,,,,,,,,,\n");
  const auto lessons = ReadHeadLessons(Write("list", "a.wav a.csv\n"), 0, 0);
  ASSERT_TRUE(lessons) << lessons.error().text;
  const HeadLesson& lesson = lessons->front();
  EXPECT_NEAR(lesson.truth(0, 5), 5, 1e-4) << "counted from the median";
  EXPECT_NEAR(lesson.truth(0, 14), 5, 1e-4) << "a picture without a face is bridged";
  EXPECT_NEAR(lesson.truth(1, 5), 0, 1e-4);
  EXPECT_NEAR(lesson.truth(2, 5), 0, 1e-4);
  EXPECT_NEAR(lesson.truth(3, 5), 0.25, 1e-4);
  for (std::size_t k = 19; k < lesson.phrase.size(); ++k) EXPECT_EQ(lesson.phrase[k], 0U);
  Write("a.csv", names + "0.0,1,0.9,3,,2,0,1,0,0.4,0.6,0,0,1\n");
  EXPECT_EQ(ErrorOf("a.wav a.csv\n"), "a.csv:2: '' found for right, a number within +-90 expected");
}

TEST_F(HeadListTest, BadListsAndTablesAreRefusedWithFileAndLine) {
  WriteWav("a.wav", 1600);
  Write("a.csv", "ms,down,right,tilt,brow\n0,0,0,0,0\n10,0,0,0,0\n");
  Write("b.csv", "ms,down,right,tilt\n0,0,0,0\n");
  Write("c.csv", "ms,down,right,tilt,brow\n0,0,0,0,0\n0,0,0,0,0\n");
  Write("d.csv", "ms,down,right,tilt,brow\n0,0,95,0,0\n");
  Write("e.csv", "ms,down,right,tilt,brow\n0,0,,0,0\n");
  EXPECT_EQ(ErrorOf("a.wav a.csv\n"), "none");
  EXPECT_EQ(ErrorOf(""), "list:1: no recording found, WAV CSV [EMOTION] expected");
  EXPECT_EQ(ErrorOf("\na.wav\n"), "list:2: WAV CSV [EMOTION, 0 to 1] expected");
  EXPECT_EQ(ErrorOf("a.wav a.csv 2\n"), "list:1: WAV CSV [EMOTION, 0 to 1] expected");
  EXPECT_EQ(ErrorOf("a.wav b.csv\n"),
            "b.csv:1: no column 'brow' found, ms down right tilt brow expected");
  EXPECT_EQ(ErrorOf("a.wav c.csv\n"), "c.csv:3: 0 ms found after 0 ms");
  EXPECT_EQ(ErrorOf("a.wav d.csv\n"),
            "d.csv:2: '95' found for right, a number within +-90 expected");
  EXPECT_EQ(ErrorOf("a.wav e.csv\n"), "e.csv:2: '' found for right, a number within +-90 expected");
  EXPECT_NE(ErrorOf("none.wav a.csv\n").find("none.wav"), std::string::npos);
}

TEST(HeadOfTest, InNoiseMusicAndSilenceTheHeadRests) {
  std::size_t moved = 0, all = 0;
  for (std::uint64_t n = 0; n < 30; ++n) {
    for (const HeadPose& pose : HeadOf(ShippedHeadNet(false), NoSpeech(Dice(31).For(n)), 0)) {
      ++all;
      moved +=
          std::abs(pose.angles[0]) + std::abs(pose.angles[1]) + std::abs(pose.angles[2]) > 0.1F;
    }
  }
  EXPECT_LT(moved, all / 100) << "of " << all;
}

std::vector<HeadPose> Nods(const std::vector<double>& at_ms, double degrees = 2) {
  std::vector<HeadPose> poses(600);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    for (const double at : at_ms) {
      const double off = (10 * static_cast<double>(k) - at) / 80;
      poses[k].angles[0] += static_cast<float>(degrees * std::exp(-off * off));
    }
  }
  return poses;
}

TEST(HeadScoreTest, BeatsAreFoundWhereTheyAre) {
  const auto beats = BeatsOf(Nods({500, 1500, 2300}));
  EXPECT_EQ(beats, (std::vector<double>{500, 1500, 2300}));
  EXPECT_TRUE(BeatsOf(Nods({500}, 0.4)).empty());
}

TEST(HeadScoreTest, NearBeatsCountFarOnesDoNot) {
  HeadScore score;
  score.Add(Nods({550, 1700, 2300, 4000}), Nods({500, 1500, 2300}));
  EXPECT_NEAR(score.found(), 2.0 / 3, 1e-9);
  EXPECT_NEAR(score.right(), 0.5, 1e-9);
  EXPECT_NEAR(score.late_ms(), 25, 1e-9);
  EXPECT_NEAR(score.range(0, true), 2, 0.3);
}

TEST(HeadScoreTest, ALateCopyCorrelatesWhereItIsLate) {
  HeadScore score;
  score.Add(Nods({560, 1560, 2360}), Nods({500, 1500, 2300}));
  EXPECT_GT(score.correlation(0, 60), 0.99);
  EXPECT_LT(score.correlation(0, 0), 0.8);
}

}  // namespace
}  // namespace vdm
