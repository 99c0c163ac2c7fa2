#include "vdm/train/corpus.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <utility>

#include "ssm/engines/espeak_engine.h"
#include "ssm/flite/flite_engine.h"
#include "vdm/train/festival.h"
#include "vdm/train/reading.h"

namespace vdm {
namespace {

constexpr std::string_view kHead = "galatea takes 1";
constexpr std::uint64_t kReadingSeed = 20;

vm::Result<Take> Say(ssm::SpeechEngine& engine, const std::string& voice, const std::string& name,
                     const std::string& text) {
  const std::atomic<bool> cancelled{false};
  auto plan = engine.Plan({{.text = text, .voice = voice}}, cancelled);
  if (!plan) return std::unexpected(plan.error());
  ssm::SampleBuffer buffer(ssm::ToFrames(vm::TotalDuration(plan->phonemes)));
  if (auto made = engine.Render(*plan, buffer); !made) return std::unexpected(made.error());
  const auto ready = buffer.Ready();
  return Take{.voice = name,
              .samples = {ready.begin(), ready.end()},
              .phonemes = std::move(plan->phonemes)};
}

/// By the toolkit's own engines.
vm::Result<std::vector<Take>> ReadHere(const TrainingVoice& voice,
                                       const std::vector<std::string>& texts,
                                       const std::string& espeak_helper) {
  const bool by_flite = voice.engine == "flite";
  const auto engine =
      by_flite ? ssm::MakeFliteEngine()
               : ssm::MakeEspeakEngine({.helper = espeak_helper, .variant = voice.variant});
  std::vector<Take> takes;
  for (const std::string& text : texts) {
    auto take = Say(*engine, by_flite ? voice.name : "espeak-" + voice.language, voice.name, text);
    if (!take) return std::unexpected(take.error());
    takes.push_back(std::move(*take));
  }
  return takes;
}

}  // namespace

vm::Result<std::vector<Take>> MakeCorpus(const std::string& espeak_helper,
                                         const std::string& folder,
                                         const std::function<void(const std::string&)>& progress) {
  std::vector<Take> takes;
  std::uint64_t index = 0;
  for (const TrainingVoice& voice : BuiltVoices()) {
    const Reading& reading = BuiltReading(voice.language);
    const Dice dice = Dice(kReadingSeed).For(index++);
    std::vector<std::string> texts;
    for (std::size_t n = 0; n < voice.sentences; ++n) texts.push_back(reading.Text(n, dice));
    auto said = voice.engine == "festival" ? ReadByFestival(voice, texts, folder)
                                           : ReadHere(voice, texts, espeak_helper);
    if (!said) return std::unexpected(said.error());
    std::ranges::move(*said, std::back_inserter(takes));
    progress(voice.name + " has read " + std::to_string(voice.sentences) + " sentences");
  }
  return takes;
}

vm::Result<void> SaveCorpus(const std::vector<Take>& takes, const std::string& path) {
  // Under another name until it is whole: what is there is always complete.
  const std::string partial = path + ".part";
  std::ofstream file(partial, std::ios::binary);
  file << kHead << '\n';
  for (const Take& take : takes) {
    file << take.voice << ' ' << take.samples.size() << ' '
         << vm::FormatPhonemesPlain(take.phonemes) << '\n';
    file.write(reinterpret_cast<const char*>(take.samples.data()),
               static_cast<std::streamsize>(take.samples.size() * sizeof(std::int16_t)));
  }
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(partial, path, error);
  if (!file || error) return vm::Fail(vm::Errc::kUnavailable, "cannot write '" + path + "'");
  return {};
}

vm::Result<std::vector<Take>> LoadCorpus(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return vm::Fail(vm::Errc::kUnavailable, "cannot read '" + path + "'");
  std::string line;
  if (!std::getline(file, line) || line != kHead) {
    return vm::Fail(vm::Errc::kBadValue, path + ": no takes of vdm_train");
  }
  constexpr std::size_t kMostSamples = 16000 * 600;
  std::vector<Take> takes;
  Take take;
  for (std::size_t samples = 0; file >> take.voice >> samples && std::getline(file, line);) {
    auto phonemes = vm::ParsePhonemes(line);
    if (!phonemes || samples > kMostSamples) {
      return vm::Fail(vm::Errc::kBadValue,
                      path + ": damaged after " + std::to_string(takes.size()) + " takes");
    }
    take.phonemes = std::move(*phonemes);
    take.samples.resize(samples);
    if (!file.read(reinterpret_cast<char*>(take.samples.data()),
                   static_cast<std::streamsize>(samples * sizeof(std::int16_t)))) {
      return vm::Fail(vm::Errc::kBadValue, path + ": ends within a take");
    }
    takes.push_back(take);
  }
  return takes;
}

}  // namespace vdm
