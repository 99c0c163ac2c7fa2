// vdm_train: makes the networks of vdm from speech that it has made itself. See docs/vdm.md.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "vdm/train/emotion_training.h"
#include "vdm/train/people.h"
#include "vdm/train/prosody_lessons.h"
#include "vdm/train/recorded_track.h"
#include "vdm/train/training.h"
#include "vdm/train/triphone_training.h"
#include "vdm/train/truth.h"
#include "vm_protocol/core/spawn.h"
#include "vm_protocol/core/text_file.h"

namespace {

using Clock = std::chrono::steady_clock;
constexpr const char* kSynthetic = "SYNTHETIC";

struct Options {
  std::string out, work = "vdm_training", features = "mel";
  std::string people;  // a list of recordings
  std::string from;    // a network's file
  std::vector<std::string> teachers;
  std::vector<std::string> without;
  vdm::TrainingPlan plan;
  std::string head, emotion;  // a list of recordings, or kSynthetic; empty: not asked for
  vdm::HeadPlan head_plan;
  bool head_by_prosody = false;
  long stop_after = 0;
  bool triphones = false;
  std::string recordings;  // with --triphones; empty: the speech made here
  vdm::TreePlan tree;
};

template <typename T>
T OrThrow(vm::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

void Tell(const std::string& text) { std::cerr << "vdm_train: " << text << std::endl; }

std::vector<vdm::Take> Corpus(const Options& options) {
  const std::string path = options.work + "/takes";
  if (!std::filesystem::exists(path)) {
    const std::string espeak = vm::ProgramBeside("ssm_espeak");
    // First what may be wrong with a list.
    std::vector<vdm::Take> people;
    if (!options.people.empty()) people = OrThrow(vdm::ReadPeople(options.people, espeak, Tell));
    auto takes = OrThrow(vdm::MakeCorpus(espeak, options.work + "/festival", Tell));
    std::ranges::move(people, std::back_inserter(takes));
    OrThrow(vdm::SaveCorpus(takes, path));
  }
  auto takes = OrThrow(vdm::LoadCorpus(path));
  const auto of_people = [](const vdm::Take& take) { return take.voice.starts_with("people-"); };
  if (options.people.empty()) {
    std::erase_if(takes, of_people);
  } else if (std::ranges::none_of(takes, of_people)) {
    throw std::runtime_error(path + ": made without --people; another --work is for other speech");
  }
  return takes;
}

void ShowProgress(std::size_t epoch, std::size_t epochs, double done, Clock::time_point start) {
  static int shown = -1;
  const int tenth = static_cast<int>(done * 10);
  if (tenth == shown) return;
  shown = tenth;
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  std::cerr << fmt::format("vdm_train: epoch {} of {}, {} %, {:.0f} s\n", epoch, epochs, tenth * 10,
                           seconds);
}

void ShowScore(const char* who, const vdm::Score& score) {
  if (score.instants() == 0) return;
  std::cerr << fmt::format(
      "vdm_train: {}: opening r {:.3f} rms {:.2f} mm, closures seen {:.1f} % of {}, shut by "
      "mistake {:.2f} %\n",
      who, score.correlation(), score.rms_mm(), 100 * score.closures_seen(), score.closures(),
      100 * score.shut_by_mistake());
}

void Write(const std::string& path, const std::string& text) {
  OrThrow(vm::WriteTextFile(path, text));
  std::cerr << "vdm_train: wrote " << path << std::endl;
}

bool LeftOut(const Options& options, const vdm::Take& take) {
  return std::ranges::any_of(
      options.without, [&](const std::string& begin) { return take.voice.starts_with(begin); });
}

int TrainHead(const Options& options) {
  if (options.head != kSynthetic) {
    Write(options.out, OrThrow(vdm::TeachHead(options.head_plan, options.head, Tell)));
    return 0;
  }
  std::filesystem::create_directories(options.work);
  std::vector<vdm::Take> takes = Corpus(options);
  std::erase_if(takes, [&](const vdm::Take& take) { return LeftOut(options, take); });
  const fsm::MotionTables tables = OrThrow(fsm::MotionTables::Load());
  Write(options.out, OrThrow(vdm::TeachHead(options.head_plan, takes, tables, Tell)));
  return 0;
}

int TrainEmotion(const Options& options) {
  const bool made = options.emotion == kSynthetic;
  const auto takes =
      OrThrow(made ? vdm::MakeEmotionTakes(vm::ProgramBeside("ssm_espeak"), options.without,
                                           vdm::Dice(options.plan.seed), Tell)
                   : vdm::ReadEmotionTakes(options.emotion));
  const std::string from = made ? "synthetic voices in manners of ssm" : "recordings";
  Write(options.out, OrThrow(vdm::TeachEmotion(takes, from, Tell)));
  return 0;
}

struct Voices {
  std::vector<vdm::Take> learned, left_out;
};

Voices VoicesOf(const Options& options) {
  std::filesystem::create_directories(options.work);
  Voices voices;
  for (vdm::Take& take : Corpus(options)) {
    (LeftOut(options, take) ? voices.left_out : voices.learned).push_back(std::move(take));
  }
  if (voices.learned.empty()) throw std::runtime_error("--without leaves no voice to learn from");
  return voices;
}

void Write(const Options& options, const char* what, const std::string& text) {
  const std::string without =
      options.without.empty() ? "nobody" : fmt::format("{}", fmt::join(options.without, " "));
  Write(options.out, fmt::format("# {} of vdm (docs/vdm.md says how it was made). Left out: {}.\n",
                                 what, without) +
                         text);
}

int TrainTriphones(const Options& options) {
  constexpr double kStepMs = 10;
  vdm::TriphoneTraining training(kStepMs);
  if (options.recordings.empty()) {
    const fsm::MotionTables tables = OrThrow(fsm::MotionTables::Load());
    for (const vdm::Take& take : VoicesOf(options).learned) {
      const vdm::TextDrivenMouth mouth(take.phonemes, tables);
      training.Add(
          take.phonemes,
          mouth.Sampled(0, kStepMs, static_cast<std::size_t>(mouth.length_ms() / kStepMs)));
    }
  } else {
    for (const auto& [phonemes, track] : OrThrow(vdm::ReadRecordings(options.recordings))) {
      training.Add(phonemes, Resampled(track, kStepMs));
    }
  }
  const auto model = OrThrow(training.Grow(vdm::BuiltPhonemeSets(), options.tree));
  std::cerr << fmt::format("vdm_train: trees of {}, {} and {} nodes\n", model.trees[0].size(),
                           model.trees[1].size(), model.trees[2].size());
  Write(options, "Triphones", FormatTriphones(model));
  return 0;
}

vdm::MouthNet ReadNet(const std::string& path) {
  return OrThrow(vdm::ParseMouthNet(path, OrThrow(vm::ReadTextFile(path, std::size_t{8} << 20))));
}

int Train(const Options& options) {
  const fsm::MotionTables tables = OrThrow(fsm::MotionTables::Load());
  const auto [takes, others] = VoicesOf(options);
  // What is looked at in between: every 20th take, and of those left out every 5th.
  const auto some = [](const std::vector<vdm::Take>& all, std::size_t step) {
    std::vector<vdm::Take> few;
    for (std::size_t i = 0; i < all.size(); i += step) few.push_back(all[i]);
    return few;
  };
  const auto known = some(takes, 20), unknown = some(others, 5);

  vdm::TrainingPlan plan = options.plan;
  for (const std::string& path : options.teachers) plan.teachers.push_back(ReadNet(path));
  if (!options.from.empty()) plan.from = ReadNet(options.from);
  vdm::Training training(plan, takes, tables);
  const std::string course =
      options.work + "/" + std::filesystem::path(options.out).filename().string() + ".course";
  if (std::filesystem::exists(course)) {
    OrThrow(training.Load(course));
    std::cerr << fmt::format("vdm_train: goes on after epoch {}\n", training.epoch());
  }
  std::cerr << fmt::format("vdm_train: {} takes, {} parameters\n", takes.size(),
                           training.net().net.parameters());
  for (long left = options.stop_after; !training.done();) {
    const auto start = Clock::now();
    const auto report = training.Epoch(
        [&](double done) { ShowProgress(training.epoch() + 1, options.plan.epochs, done, start); });
    OrThrow(training.Save(course));
    std::cerr << fmt::format(
        "vdm_train: epoch {}: loss {:.4f} (shape {:.4f}, closure {:.4f}, sounds {:.4f})\n",
        training.epoch(), report.loss.total(), report.loss.shape, report.loss.closure,
        report.loss.sounds);
    if (training.epoch() % 4 == 0 || training.done()) {
      ShowScore("voices learned", ScoreOf(training.net(), known, tables));
      ShowScore("voices left out", ScoreOf(training.net(), unknown, tables));
    }
    if (left > 0 && --left == 0) break;
  }
  if (!training.done()) return 0;
  Write(options, "A network", FormatMouthNet(training.net()));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Teaches vdm how mouths move, by speech that the voices of the toolkit say");
  app.set_version_flag("--version", "vdm_train (Galatea) " GALATEA_VERSION);
  app.add_option("out", options.out, "The file of what is learned")->required();
  app.add_option(
         "--work", options.work,
         "Folder for the speech and the courses of trainings, which go on from there; one for all")
      ->capture_default_str();
  app.add_option("--features", options.features,
                 "mel; phones or words, which need pocketsphinx-en-us; or cepstra as in the papers")
      ->check(CLI::IsMember({"mel", "phones", "words", "cepstra"}))
      ->capture_default_str();
  app.add_option(
         "--people", options.people,
         "A list of recordings of people to learn from as well, a line each: FILE, LANGUAGE "
         "and TEXT between tabs; needs pocketsphinx-en-us")
      ->check(CLI::ExistingFile);
  app.add_option("--teachers", options.teachers,
                 "Networks of the same kind: the mean of their outputs is learned beside the truth")
      ->delimiter(',')
      ->check(CLI::ExistingFile);
  app.add_option("--from", options.from, "A network to begin with, in place of one by chance")
      ->check(CLI::ExistingFile);
  app.add_option("--without", options.without,
                 "Voices to leave out, by what their names begin with (vdm/tables/voices.txt)")
      ->delimiter(',');
  app.add_option("--epochs", options.plan.epochs, "How often all is gone through")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--width", options.plan.width, "Units of each hidden layer (not cepstra)")
      ->check(CLI::Range(4, 512))
      ->capture_default_str();
  app.add_flag("--long-past", options.plan.long_past,
               "It hears 80 ms more before an instant (not cepstra)");
  app.add_option("--disturbance", options.plan.disturbance,
                 "By how much, twice, hidden units are larger or smaller by chance (not cepstra)")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  app.add_option("--masking", options.plan.masking,
                 "Share of the lessons in which bands, moments and phones are hidden (not cepstra)")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--rate", options.plan.rate, "The highest step")->capture_default_str();
  app.add_option("--seed", options.plan.seed, "Of all that happens by chance")
      ->capture_default_str();
  app.add_option("--head", options.head,
                 "Learns a network of heads instead: a list of recordings, a line each: WAV CSV "
                 "[EMOTION]; or SYNTHETIC (docs/vdm.md)");
  app.add_flag("--head-prosody", options.head_by_prosody,
               "The papers' network, which hears of pitch, power and position alone");
  app.add_option("--head-late", options.head_plan.late_ms, "ms by which the head is late")
      ->check(CLI::Range(0, 500))
      ->capture_default_str();
  app.add_option(
      "--emotion", options.emotion,
      "Learns how to tell emotions apart instead: a list of recordings, a line each: WAV "
      "LABEL [SPEAKER], one label being neutral; or SYNTHETIC (docs/vdm.md)");
  app.add_option("--stop-after", options.stop_after,
                 "Ends after so many epochs; call again to go on");
  auto* triphones =
      app.add_flag("--triphones", options.triphones,
                   "Learn how the mouth moves in phonemes with neighbours, not a network");
  app.add_option("--recordings", options.recordings,
                 "A list of recordings to learn triphones from: PHONEMES TRACK in each line")
      ->needs(triphones);
  app.add_option("--leaves", options.tree.leaves, "Of the tree of a state, at most")
      ->needs(triphones)
      ->check(CLI::Range(1, 2048))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (options.features == "cepstra") options.plan.features = vdm::FeatureKind::kCepstra;
  if (options.features == "phones") options.plan.features = vdm::FeatureKind::kPhones;
  if (options.features == "words") options.plan.features = vdm::FeatureKind::kWords;
  options.head_plan.seed = options.plan.seed;
  if (!options.head_by_prosody) {
    options.head_plan.sounds = vdm::ShippedNet(vdm::FeatureKind::kMel).sounds.size();
  }
  try {
    OrThrow(vdm::CanMakeFeatures(options.plan.features));
    if (!options.emotion.empty()) return TrainEmotion(options);
    if (!options.head.empty()) return TrainHead(options);
    return options.triphones ? TrainTriphones(options) : Train(options);
  } catch (const std::exception& error) {
    std::cerr << "vdm_train: " << error.what() << std::endl;
    return 1;
  }
}
