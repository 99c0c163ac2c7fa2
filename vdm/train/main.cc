// vdm_train: makes the networks of vdm from speech that it has made itself. See docs/vdm.md.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "vdm/train/training.h"

namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  std::string out, work = "vdm_training", features = "mel";
  std::vector<std::string> without;
  vdm::TrainingPlan plan;
  long stop_after = 0;
};

template <typename T>
T OrThrow(vm::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

std::vector<vdm::Take> Corpus(const Options& options) {
  const std::string path = options.work + "/takes";
  if (!std::filesystem::exists(path)) {
    const auto self = std::filesystem::read_symlink("/proc/self/exe");
    const auto takes = OrThrow(vdm::MakeCorpus(
        (self.parent_path() / "ssm_espeak").string(), options.work + "/festival",
        [](const std::string& text) { std::cerr << "vdm_train: " << text << std::endl; }));
    OrThrow(vdm::SaveCorpus(takes, path));
  }
  return OrThrow(vdm::LoadCorpus(path));
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

int Train(const Options& options) {
  std::filesystem::create_directories(options.work);
  const fsm::MotionTables tables = OrThrow(fsm::MotionTables::Load());
  std::vector<vdm::Take> takes, others;
  for (vdm::Take& take : Corpus(options)) {
    const bool left_out = std::ranges::any_of(
        options.without, [&](const std::string& begin) { return take.voice.starts_with(begin); });
    (left_out ? others : takes).push_back(std::move(take));
  }
  if (takes.empty()) throw std::runtime_error("--without leaves no voice to learn from");
  // What is looked at in between: every 20th take, and of those left out every 5th.
  const auto some = [](const std::vector<vdm::Take>& all, std::size_t step) {
    std::vector<vdm::Take> few;
    for (std::size_t i = 0; i < all.size(); i += step) few.push_back(all[i]);
    return few;
  };
  const auto known = some(takes, 20), unknown = some(others, 5);

  vdm::Training training(options.plan, takes, tables);
  const std::string course = options.work + "/course";
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
  std::ofstream file(options.out);
  file << fmt::format(
      "# A network of vdm (docs/vdm.md says how it was made). Left out: {}.\n",
      options.without.empty() ? "nobody" : fmt::format("{}", fmt::join(options.without, " ")));
  file << FormatMouthNet(training.net());
  file.close();
  if (!file) throw std::runtime_error("cannot write '" + options.out + "'");
  std::cerr << "vdm_train: wrote " << options.out << std::endl;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Trains a network of vdm on speech made by the voices of the toolkit");
  app.set_version_flag("--version", "vdm_train (Galatea) " GALATEA_VERSION);
  app.add_option("out", options.out, "The network's file")->required();
  app.add_option("--work", options.work,
                 "Folder for the speech and the course of the training, which goes on from there")
      ->capture_default_str();
  app.add_option("--features", options.features,
                 "mel; phones, which needs pocketsphinx-en-us; or cepstra as in the papers")
      ->check(CLI::IsMember({"mel", "phones", "cepstra"}))
      ->capture_default_str();
  app.add_option("--without", options.without,
                 "Voices to leave out, by what their names begin with (vdm/tables/voices.txt)")
      ->delimiter(',');
  app.add_option("--epochs", options.plan.epochs, "How often all is gone through")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--width", options.plan.width, "Units of each hidden layer (mel)")
      ->check(CLI::Range(4, 512))
      ->capture_default_str();
  app.add_option("--rate", options.plan.rate, "The highest step")->capture_default_str();
  app.add_option("--seed", options.plan.seed, "Of all that happens by chance")
      ->capture_default_str();
  app.add_option("--stop-after", options.stop_after,
                 "Ends after so many epochs; call again to go on");
  CLI11_PARSE(app, argc, argv);
  if (options.features == "cepstra") options.plan.features = vdm::FeatureKind::kCepstra;
  if (options.features == "phones") options.plan.features = vdm::FeatureKind::kPhones;
  try {
    OrThrow(vdm::CanMakeFeatures(options.plan.features));
    return Train(options);
  } catch (const std::exception& error) {
    std::cerr << "vdm_train: " << error.what() << std::endl;
    return 1;
  }
}
