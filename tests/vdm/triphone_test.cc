// Triphones: states, tracks with dynamic features, decision trees, and their files.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "vdm/train/recorded_track.h"
#include "vdm/train/triphone_training.h"
#include "vdm/triphone/triphone_model.h"

namespace vdm {
namespace {

vm::PhonemeList Phonemes(const std::string& text) { return vm::ParsePhonemes(text).value(); }

TEST(TriphoneStatesTest, APhonemeIsDividedIntoThreePartsBetweenItsNeighbours) {
  const auto states = StatesOf(Phonemes("m 90 aa 120"), 10);
  ASSERT_EQ(states.size(), 6U);
  EXPECT_EQ(states[0].triphone, (Triphone{"pau", "m", "aa"}));
  EXPECT_EQ(states[5].triphone, (Triphone{"m", "aa", "pau"}));
  EXPECT_EQ(states[1].first, 3U);
  EXPECT_EQ(states[1].end, 6U);
  EXPECT_EQ(states[5].first, 17U);
  EXPECT_EQ(states[5].end, 21U);
}

TEST(TriphoneStatesTest, APhonemeShorterThanAnInstantHasNone) {
  const auto states = StatesOf(Phonemes("m 90 t 5 aa 55"), 10);
  ASSERT_EQ(states.size(), 9U);
  std::size_t instants = 0;
  for (const auto& state : states) instants += state.end - state.first;
  EXPECT_EQ(instants, 15U);
}

Eigen::MatrixXd Wave(Eigen::Index size) {
  Eigen::MatrixXd track(2, size);
  for (Eigen::Index t = 0; t < size; ++t) {
    track(0, t) = std::sin(0.3 * static_cast<double>(t));
    track(1, t) = t < size / 2 ? 0 : 4;
  }
  return track;
}

TEST(TrajectoryTest, WindowsAreValueSlopeAndBend) {
  Eigen::MatrixXd track(1, 4);
  track << 1, 2, 4, 8;
  const Eigen::MatrixXd windows = WindowsOf(track);
  ASSERT_EQ(windows.rows(), 3);
  EXPECT_EQ(windows.row(0), track.row(0));
  EXPECT_EQ(windows.row(1), (Eigen::RowVector4d{0.5, 1.5, 3, 2}));
  EXPECT_EQ(windows.row(2), (Eigen::RowVector4d{1, 1, 2, -4}));
}

TEST(TrajectoryTest, WhatIsExpectedEverywhereIsFound) {
  const Eigen::MatrixXd track = Wave(40), windows = WindowsOf(track);
  std::vector<Expectation> expected;
  for (Eigen::Index t = 0; t < track.cols(); ++t) {
    expected.push_back({windows.col(t), Eigen::VectorXd::Constant(6, 0.1)});
  }
  std::vector<const Expectation*> each;
  for (const Expectation& e : expected) each.push_back(&e);
  EXPECT_LT((LikeliestTrack(each) - track).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(TrajectoryTest, ItGoesSmoothlyFromStateToState) {
  const auto state = [](double value) {
    Expectation e{Eigen::VectorXd::Zero(3), Eigen::Vector3d{1, 0.1, 0.1}};
    e.means[0] = value;
    return e;
  };
  const Expectation low = state(0), high = state(4);
  std::vector<const Expectation*> each(20, &low);
  each.insert(each.end(), 20, &high);
  const Eigen::MatrixXd track = LikeliestTrack(each);
  EXPECT_NEAR(track(0, 0), 0, 0.1);
  EXPECT_NEAR(track(0, 39), 4, 0.1);
  for (Eigen::Index t = 1; t < 40; ++t) {
    EXPECT_GE(track(0, t), track(0, t - 1) - 1e-9);
    EXPECT_LT(track(0, t), track(0, t - 1) + 1.2) << "a jump at " << t;
  }
}

TEST(TrajectoryTest, NothingExpectedIsNoTrack) { EXPECT_EQ(LikeliestTrack({}).cols(), 0); }

/// The mouth whose jaw (number 11) opens to `degrees` in each phoneme aa.
MouthTruth Jaw(const vm::PhonemeList& phonemes, float degrees) {
  const auto size = static_cast<Eigen::Index>(vm::TotalDuration(phonemes).count() / 10);
  MouthTruth truth{Eigen::MatrixXf::Zero(kShapeNumbers, size), Eigen::VectorXf::Zero(size), {}};
  for (const TriphoneState& state : StatesOf(phonemes, 10)) {
    for (std::size_t t = state.first; t < state.end; ++t) {
      if (state.triphone.centre == "aa") truth.shape(11, static_cast<Eigen::Index>(t)) = degrees;
      if (state.triphone.centre == "m") truth.closed[static_cast<Eigen::Index>(t)] = 1;
    }
  }
  return truth;
}

TriphoneTraining Taught() {
  TriphoneTraining training(10);
  for (int n = 0; n < 30; ++n) {
    const auto wide = Phonemes("pau 100 m 90 aa 150 t 60 pau 100");
    const auto narrow = Phonemes("pau 100 s 90 aa 150 t 60 pau 100");
    training.Add(wide, Jaw(wide, 10));
    training.Add(narrow, Jaw(narrow, 4));
  }
  return training;
}

double JawAt(const TriphoneModel& model, const std::string& phonemes, std::size_t frame) {
  return static_cast<double>(MouthOf(model, Phonemes(phonemes)).value().at(frame).mouth[11]);
}

TEST(TriphoneTrainingTest, NeighboursTellTheStatesOfAPhonemeApart) {
  const auto model = Taught().Grow(BuiltPhonemeSets(), {}).value();
  EXPECT_NEAR(JawAt(model, "pau 100 m 90 aa 150 t 60 pau 100", 26), 10, 0.3);
  EXPECT_NEAR(JawAt(model, "pau 100 s 90 aa 150 t 60 pau 100", 26), 4, 0.3);
  EXPECT_GT(MouthOf(model, Phonemes("pau 100 m 90 aa 150"))->at(14).seal, 0.9F);
}

TEST(TriphoneTrainingTest, ATriphoneNeverHeardMovesLikeOneThatAnswersAlike) {
  const auto model = Taught().Grow(BuiltPhonemeSets(), {}).value();
  EXPECT_NEAR(JawAt(model, "pau 100 b 90 aa 150 d 60 pau 100", 26), 10, 0.5);
  EXPECT_NEAR(JawAt(model, "pau 100 z 90 aa 150 d 60 pau 100", 26), 4, 0.5);
}

TEST(TriphoneTrainingTest, ATreeHasNoMoreLeavesThanItMay) {
  const auto model = Taught().Grow(BuiltPhonemeSets(), {.leaves = 2}).value();
  for (const auto& tree : model.trees) EXPECT_EQ(tree.size(), 3U);
  const auto one = Taught().Grow(BuiltPhonemeSets(), {.leaves = 1}).value();
  for (const auto& tree : one.trees) EXPECT_EQ(tree.size(), 1U);
}

TEST(TriphoneTrainingTest, NothingToLearnFromIsAnError) {
  EXPECT_EQ(TriphoneTraining(10).Grow(BuiltPhonemeSets(), {}).error().code, vm::Errc::kBadValue);
}

TEST(TriphoneModelTest, AModelIsReadAsItWasWritten) {
  const auto model = Taught().Grow(BuiltPhonemeSets(), {}).value();
  const std::string text = FormatTriphones(model);
  const auto read = ParseTriphones("a.tri", text);
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(FormatTriphones(*read), text);
  EXPECT_NEAR(JawAt(*read, "pau 100 m 90 aa 150 t 60 pau 100", 26), 10, 0.3);
}

TEST(TriphoneModelTest, ADamagedModelIsRefusedWithItsLine) {
  const auto model = Taught().Grow({{"m", {"m"}}, {"t", {"t"}}}, {}).value();
  const std::string text = FormatTriphones(model);
  const auto error = [&](const std::string& what, const std::string& by) {
    std::string changed = text;
    changed.replace(changed.find(what), what.size(), by);
    const auto read = ParseTriphones("a.tri", changed);
    return read ? "read" : read.error().text;
  };
  EXPECT_EQ(error("step 10", "step 0"), "a.tri:1: '0' found, a number from 1 to 100 expected");
  EXPECT_EQ(error("set t t", "set m t"), "a.tri:3: the set 'm' is here twice");
  EXPECT_EQ(error("set t t", "set t"), "a.tri:3: set NAME PHONEME... expected");
  EXPECT_EQ(error("state beginning", "state start"),
            "a.tri:4: state 'start' found, 'beginning' expected");
  EXPECT_NE(error("ask ", "ask above ").find("values after 'ask' found, 2 expected"),
            std::string::npos);
  EXPECT_NE(error("variances ", "variances -").find("a number from 1e-09"), std::string::npos);
  EXPECT_NE(error("means ", "means 0 ").find("58 values after 'means' found, 57 expected"),
            std::string::npos);
  EXPECT_NE(ParseTriphones("a.tri", text + "more\n").error().text.find("more found behind"),
            std::string::npos);
}

TEST(TriphoneModelTest, AModelThatEndsEarlyIsRefusedWhereverItEnds) {
  const std::string text = FormatTriphones(Taught().Grow({{"m", {"m"}}}, {}).value());
  for (std::size_t end = 0; end + 1 < text.size(); end += 1 + text.size() / 300) {
    EXPECT_FALSE(ParseTriphones("a.tri", text.substr(0, end))) << end;
  }
}

TEST(TriphoneModelTest, AnHourOfPhonemesIsRefused) {
  const auto model = Taught().Grow(BuiltPhonemeSets(), {}).value();
  const vm::PhonemeList hour(60, {"aa", std::chrono::milliseconds{60'000}});
  EXPECT_EQ(MouthOf(model, hour).error().code, vm::Errc::kLimit);
}

TEST(PhonemeSetsTest, ATableIsCheckedLineByLine) {
  EXPECT_EQ(ReadPhonemeSets("q", "a p\nb\n").error().text,
            "q:2: phonemes expected behind the name 'b'");
  EXPECT_EQ(ReadPhonemeSets("q", "a p\na t\n").error().text, "q:2: the set 'a' is here twice");
  EXPECT_EQ(ReadPhonemeSets("q", "# none\n").error().text,
            "q:1: no set found, at least one expected");
}

std::string Table(const std::vector<double>& times) {
  std::string text = "ms,sound,seal,tongue";
  for (int i = 1; i <= 17; ++i) text += ",m" + std::to_string(i);
  for (const double ms : times) {
    text += "\n" + std::to_string(ms) + ",aa,0.5,0.25";
    for (int i = 1; i <= 17; ++i) text += "," + std::to_string(i * ms / 100);
  }
  return text + "\n";
}

TEST(RecordedTrackTest, ATableIsReadByTheNamesOfItsColumns) {
  const auto track = ReadTrack("a.csv", Table({0, 40, 80}));
  ASSERT_TRUE(track) << track.error().text;
  EXPECT_NEAR(track->step_ms, 40, 1e-9);
  EXPECT_NEAR(track->truth.shape(2, 1), 1.2F, 1e-6F);
  EXPECT_NEAR(track->truth.shape(17, 1), 0.25F, 1e-6F);
  EXPECT_NEAR(track->truth.closed[2], 0.5F, 1e-6F);
}

TEST(RecordedTrackTest, BetweenInstantsAreStraightLines) {
  const auto truth = Resampled(*ReadTrack("a.csv", Table({0, 40, 80})), 10);
  ASSERT_EQ(truth.shape.cols(), 9);
  for (Eigen::Index t = 0; t < 9; ++t) {
    EXPECT_NEAR(truth.shape(0, t), 0.1F * static_cast<float>(t), 1e-5F);
  }
}

TEST(RecordedTrackTest, ABadTableIsRefusedWithItsLine) {
  const auto error = [](const std::string& text) { return ReadTrack("a.csv", text).error().text; };
  EXPECT_EQ(error(""), "a.csv:0: no line found");
  EXPECT_EQ(error("ms,seal\n"), "a.csv:1: no column 'm1' found");
  EXPECT_EQ(error(Table({0})), "a.csv:2: at least two instants expected");
  EXPECT_EQ(error(Table({0, 40, 70})),
            "a.csv:4: a step of 30 ms found, the same of 1 to 100 ms expected in all lines");
  EXPECT_EQ(error(Table({0, 40}) + "80,aa,x"), "a.csv:4: '' found in column 5, a number expected");
  EXPECT_EQ(error(Table({0, 40}) + "nan"), "a.csv:4: 'nan' found in column 1, a number expected");
}

TEST(RecordedTrackTest, AListNamesItsFilesBesideIt) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "recordings";
  std::filesystem::create_directories(folder);
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return (folder / name).string();
  };
  write("a.pho", "m[40] aa[40]\n");
  write("a.csv", Table({0, 40, 80}));
  const auto read = ReadRecordings(write("list", "# two\na.pho a.csv\n\na.pho a.csv\n"));
  ASSERT_TRUE(read) << read.error().text;
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ(read->front().phonemes, Phonemes("m 40 aa 40"));
  EXPECT_NE(ReadRecordings(write("bad", "a.pho\n")).error().text.find("bad:1: PHONEMES TRACK"),
            std::string::npos);
  EXPECT_NE(ReadRecordings(write("gone", "a.pho b.csv\n")).error().text.find("b.csv"),
            std::string::npos);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace vdm
