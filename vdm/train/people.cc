#include "vdm/train/people.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>

#include "sound/sound_file.h"
#include "ssm/engines/espeak_engine.h"
#include "vdm/train/forced_alignment.h"
#include "vdm/train/lesson.h"

namespace vdm {
namespace {

// Medians of ten languages: -1.15 (Romanian) to -1.63 (Spanish before a clipping microphone).
constexpr double kLeastFit = -1.45;
constexpr std::size_t kShortest = kSampleRateHz * 3 / 10, kLongest = kSampleRateHz * 20,
                      kTake = kSampleRateHz * 5;  // samples

/// What the voice of a language would say, without its pauses.
vm::Result<vm::PhonemeList> PhonemesOf(ssm::SpeechEngine& engine, const std::string& language,
                                       const std::string& text) {
  const std::atomic<bool> cancelled{false};
  auto plan = engine.Plan({{.text = text, .voice = "espeak-" + language}}, cancelled);
  if (!plan) return std::unexpected(plan.error());
  std::erase_if(plan->phonemes, [](const vm::Phoneme& phoneme) { return phoneme.name == "pau"; });
  return std::move(plan->phonemes);
}

/// The features of a recording as they are where its speaker has been heard before: from the second
/// of two times in a row.
Eigen::MatrixXf FeaturesOfKnown(const std::vector<std::int16_t>& samples) {
  std::vector<std::int16_t> twice = samples;
  twice.insert(twice.end(), samples.begin(), samples.end());
  const Eigen::MatrixXf features = FeaturesOf(twice, FeatureKind::kPhones);
  return features.rightCols(features.cols() / 2);
}

/// Joins recordings of one language to takes of some seconds, as speech comes.
void Join(std::vector<Take>& takes, Take take) {
  if (!takes.empty() && takes.back().voice == take.voice && takes.back().samples.size() < kTake) {
    Take& last = takes.back();
    last.samples.insert(last.samples.end(), take.samples.begin(), take.samples.end());
    std::ranges::move(take.phonemes, std::back_inserter(last.phonemes));
    return;
  }
  takes.push_back(std::move(take));
}

}  // namespace

vm::Result<std::vector<Take>> ReadPeople(const std::string& list, const std::string& espeak_helper,
                                         const std::function<void(const std::string&)>& progress) {
  std::ifstream file(list);
  if (!file) return vm::Fail(vm::Errc::kUnavailable, "cannot read '" + list + "'");
  const auto engine = ssm::MakeEspeakEngine({.helper = espeak_helper});
  const std::filesystem::path folder = std::filesystem::path(list).parent_path();
  std::vector<Take> takes;
  std::size_t number = 0, fitting = 0, unfit = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    const std::size_t first = line.find('\t'), second = line.find('\t', first + 1);
    if (first == std::string::npos || second == std::string::npos) {
      return vm::Fail(
          vm::Errc::kBadValue,
          fmt::format("{}:{}: FILE, LANGUAGE and TEXT between tabs expected", list, number));
    }
    const std::string language = line.substr(first + 1, second - first - 1);
    auto samples = sound::ReadSound(folder / line.substr(0, first));
    if (!samples) return std::unexpected(samples.error());
    const auto phonemes = PhonemesOf(*engine, language, line.substr(second + 1));
    if (!phonemes) {
      return vm::Fail(phonemes.error().code,
                      fmt::format("{}:{}: {}", list, number, phonemes.error().text));
    }
    if (phonemes->empty() || samples->size() < kShortest || samples->size() > kLongest) {
      ++unfit;
      continue;
    }
    auto aligned = AlignPhonemes(FeaturesOfKnown(*samples), *phonemes);
    if (aligned.phonemes.empty() || aligned.fit < kLeastFit) {
      ++unfit;
      continue;
    }
    samples->resize(static_cast<std::size_t>(vm::TotalDuration(aligned.phonemes).count()) *
                    kSampleRateHz / 1000);
    Join(takes, {"people-" + language, std::move(*samples), std::move(aligned.phonemes)});
    ++fitting;
    if (number % 500 == 0) progress(fmt::format("{} recordings of people are read", number));
  }
  if (takes.empty()) {
    return vm::Fail(vm::Errc::kBadValue, list + ": no recording found that fits its text");
  }
  progress(fmt::format("{} recordings of people; {} more do not fit their text", fitting, unfit));
  return takes;
}

}  // namespace vdm
