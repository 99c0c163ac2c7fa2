// A training on a handful of sounds: it learns, is the same each time, and goes on where it was.

#include "vdm/train/training.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "vdm/train/lesson.h"
#include "vdm/train/truth.h"

namespace vdm {
namespace {

const fsm::MotionTables& Tables() {
  static const fsm::MotionTables tables = fsm::MotionTables::Load().value();
  return tables;
}

/// Buzzes whose spectrum says which of three sounds they are.
std::vector<Take> Takes() {
  std::vector<Take> takes;
  for (int n = 0; n < 6; ++n) {
    Take take{.voice = "buzz",
              .samples = {},
              .phonemes = vm::ParsePhonemes("pau 200 aa 200 m 100 aa 150 pau 200").value()};
    for (std::size_t i = 0; i < 850 * 16; ++i) {
      const double ms = static_cast<double>(i) / 16, t = ms / 1000;
      double x = 0;
      if (ms > 200 && ms < 650) {
        const bool closed = ms > 400 && ms < 500;
        for (int k = 1; k < 20; ++k) {
          const double hz = (110 + 10 * n) * k, at = closed ? 250 : 800;
          x += std::sin(6.2831853 * hz * t) / (1 + std::pow((hz - at) / 150, 2));
        }
      }
      take.samples.push_back(static_cast<std::int16_t>(std::lround(5000 * x)));
    }
    takes.push_back(std::move(take));
  }
  return takes;
}

TrainingPlan Plan() { return {.width = 12, .epochs = 6}; }
const auto kQuiet = [](double) {};

TEST(TrainingTest, ItLearns) {
  const auto takes = Takes();
  TrainingPlan plan = Plan();
  plan.epochs = 60;
  plan.rate = 0.01;
  Training training(plan, takes, Tables());
  const double first = training.Epoch(kQuiet).loss.total();
  double last = first;
  while (!training.done()) last = training.Epoch(kQuiet).loss.total();
  EXPECT_LT(last, 0.6 * first);
  EXPECT_GT(ScoreOf(training.net(), takes, Tables()).correlation(), 0.7);
}

TEST(TrainingTest, ACourseThatIsKeptAndResumedGivesTheSameNetwork) {
  const auto takes = Takes();
  const auto path = (std::filesystem::temp_directory_path() / "vdm_course_test").string();
  Training straight(Plan(), takes, Tables());
  while (!straight.done()) straight.Epoch(kQuiet);
  {
    Training begun(Plan(), takes, Tables());
    begun.Epoch(kQuiet);
    begun.Epoch(kQuiet);
    ASSERT_TRUE(begun.Save(path));
  }
  Training resumed(Plan(), takes, Tables());
  ASSERT_TRUE(resumed.Load(path));
  EXPECT_EQ(resumed.epoch(), 2U);
  while (!resumed.done()) resumed.Epoch(kQuiet);
  EXPECT_EQ(FormatMouthNet(resumed.net()), FormatMouthNet(straight.net()));

  for (TrainingPlan other : {TrainingPlan{.width = 12, .epochs = 6, .seed = 2},
                             TrainingPlan{.width = 12, .epochs = 6, .masking = 0.5}}) {
    EXPECT_NE(
        Training(other, takes, Tables()).Load(path).error().text.find("is no course of this plan"),
        std::string::npos);
  }
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 3);
  EXPECT_NE(Training(Plan(), takes, Tables()).Load(path).error().text.find("damaged"),
            std::string::npos);
  std::filesystem::remove(path);
}

TEST(TrainingTest, ItBeginsWithANetworkAndHeedsItsTeachers) {
  const auto takes = Takes();
  TrainingPlan plan = Plan();
  plan.epochs = 20;
  plan.rate = 0.01;
  const MouthNet start = StartingNet(plan, takes, Tables());
  plan.from = start;
  EXPECT_EQ(FormatMouthNet(Training(plan, takes, Tables()).net()), FormatMouthNet(start));
  // Says that lips never close, and of the corners' height, by its scale, nothing.
  MouthNet teacher = start;
  auto& last = teacher.net.layers.back();
  last.weights.setZero();
  last.biases.setZero();
  last.biases[static_cast<Eigen::Index>(start.closure_row())] = -20;
  last.biases[9] = 1000;
  teacher.scales[9] *= 5;
  const auto closed = [&](const TrainingPlan& wanted) {
    Training training(wanted, takes, Tables());
    while (!training.done()) training.Epoch(kQuiet);
    const Lesson lesson = PlainLesson(takes[0], wanted.features, Tables());
    const Eigen::MatrixXf outputs =
        WantedOf(training.net(), training.net().net.Outputs(lesson.features));
    EXPECT_LT(outputs.row(9).cwiseAbs().maxCoeff(), 50);
    return outputs.row(static_cast<Eigen::Index>(start.closure_row())).mean();
  };
  const float alone = closed(plan);
  plan.teachers = {teacher};
  EXPECT_LT(closed(plan), 0.6F * alone);
}

TEST(LessonTest, MaskingHidesBandsMomentsAndPhonesButNoLevels) {
  constexpr Eigen::Index kBands = 24, kFrames = 400;
  const auto size = static_cast<Eigen::Index>(FeatureSize(FeatureKind::kPhones));
  const auto mel = static_cast<Eigen::Index>(FeatureSize(FeatureKind::kMel));
  Eigen::ArrayXf hidden = Eigen::ArrayXf::Zero(size);
  Dice dice(3);
  for (int n = 0; n < 200; ++n) {
    Eigen::MatrixXf features = Eigen::MatrixXf::Ones(size, kFrames);
    Mask(features, FeatureKind::kPhones, dice);
    hidden += 1 - features.array().rowwise().mean();
  }
  hidden /= 200;
  EXPECT_EQ(hidden.segment(kBands, mel - kBands).maxCoeff(), 0);
  // Two ranges of 3 of 24 bands on average, and four moments of 35 of 4000 ms.
  EXPECT_NEAR(hidden.head(kBands).mean(), 0.25F, 0.06F);
  EXPECT_GT(hidden.head(kBands).minCoeff(), 0.04F);
  EXPECT_NEAR(hidden.tail(size - mel).mean(), 0.1F, 0.02F);
}

TEST(CorpusTest, TakesAreKeptWhole) {
  const auto path = (std::filesystem::temp_directory_path() / "vdm_takes_test").string();
  const auto takes = Takes();
  ASSERT_TRUE(SaveCorpus(takes, path));
  const auto back = LoadCorpus(path);
  ASSERT_TRUE(back);
  ASSERT_EQ(back->size(), takes.size());
  EXPECT_EQ(back->back().samples, takes.back().samples);
  EXPECT_EQ(back->back().phonemes, takes.back().phonemes);
  EXPECT_EQ(back->back().voice, "buzz");
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
  EXPECT_EQ(LoadCorpus(path).error().text, path + ": ends within a take");
  std::ofstream(path) << "something else";
  EXPECT_EQ(LoadCorpus(path).error().text, path + ": no takes of vdm_train");
  std::filesystem::remove(path);
}

TEST(TruthTest, ItIsTheFacesOwnMouth) {
  const TextDrivenMouth mouth(vm::ParsePhonemes("pau 200 aa 300 m 100 aa 200 pau 200").value(),
                              Tables());
  const MouthTruth truth = mouth.Sampled(0, 10, 100);
  EXPECT_EQ(truth.closed[0], 1);
  EXPECT_NEAR(truth.shape(11, 35), 9, 0.5);  // the jaw of aa
  EXPECT_EQ(truth.closed[52], 1);            // in the m
  EXPECT_LT(truth.closed[35], 0.01);
  EXPECT_EQ(truth.sound[52], 1U);  // pbm
}

}  // namespace
}  // namespace vdm
