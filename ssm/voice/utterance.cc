#include "ssm/voice/utterance.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "ssm/voice/wav_file.h"
#include "vm_protocol/core/file_kind.h"

namespace ssm {
namespace {

constexpr Millis kMaxMismatch{50};

vm::Error InfoError(vm::Errc code, const std::string& path, const std::string& why) {
  return {code, "'" + path + ".info': " + why, 0};
}

}  // namespace

std::string Utterance::SpokenWords(Millis spoken) const {
  std::string words;
  for (const WordTime& word : plan.words) {
    if (word.start < spoken) words += (words.empty() ? "" : " ") + word.text;
  }
  return words;
}

vm::Result<void> SaveUtterance(const Utterance& utterance, const std::string& path,
                               SoundFormat format) {
  const auto samples = utterance.samples->Ready();
  auto saved = format == SoundFormat::kWav ? WriteWav(path, samples) : WriteRaw(path, samples);
  if (!saved) return saved;
  if (auto fit = vm::CheckWritable(path + ".info"); !fit) return fit;
  std::ofstream info(path + ".info", std::ios::trunc);
  info << "input_text: " << utterance.text << "\nspoken_text: " << utterance.spoken_text
       << "\n-----\n";
  for (const vm::Phoneme& phoneme : utterance.plan.phonemes) {
    info << phoneme.name << " [" << phoneme.duration.count() << "]\n";
  }
  info << "-----\n";
  info.close();
  if (info) return {};
  const std::string why = std::strerror(errno);
  return std::unexpected(
      InfoError(vm::Errc::kUnavailable, path, why + vm::RemovePart(path + ".info")));
}

vm::Result<void> SaveLabels(const Utterance& utterance, const std::string& path) {
  constexpr std::int64_t kPerMs = 10'000;
  if (auto fit = vm::CheckWritable(path); !fit) return fit;
  std::ofstream file(path, std::ios::trunc);
  Millis at{0};
  for (const vm::Phoneme& phoneme : utterance.plan.phonemes) {
    const Millis end = at + phoneme.duration;
    file << at.count() * kPerMs << " " << end.count() * kPerMs << " " << phoneme.name << "\n";
    at = end;
  }
  file.close();
  if (file) return {};
  const std::string why = std::strerror(errno);
  return vm::Fail(vm::Errc::kUnavailable,
                  "cannot write '" + path + "': " + why + vm::RemovePart(path));
}

vm::Result<InfoFile> ReadInfo(const std::string& path) {
  constexpr const char* kExpected = "; it must hold the phonemes, NAME [MS]";
  if (const auto fit = vm::CheckReadable(path + ".info"); !fit) {
    return vm::Fail(fit.error().code, fit.error().text + kExpected);
  }
  std::ifstream info(path + ".info");
  if (!info) {
    return std::unexpected(
        InfoError(vm::Errc::kUnavailable, path, std::string(std::strerror(errno)) + kExpected));
  }
  InfoFile read;
  std::string list;
  int rules = 0;
  for (std::string line; std::getline(info, line) && rules < 2;) {
    if (line.ends_with('\r')) line.pop_back();
    if (line.starts_with('-')) {
      ++rules;
    } else if (line.starts_with("phonemes: ")) {  // on one line, as we wrote them once
      list = line.substr(10);
    } else if (rules == 1) {
      list += line + " ";
    } else if (line.starts_with("input_text: ")) {
      read.text = read.spoken_text = line.substr(12);
    } else if (line.starts_with("spoken_text: ")) {
      read.spoken_text = line.substr(13);
    }
  }
  auto phonemes = vm::ParsePhonemes(list);
  if (!phonemes) {
    return std::unexpected(InfoError(phonemes.error().code, path, phonemes.error().text));
  }
  read.phonemes = std::move(*phonemes);
  return read;
}

vm::Result<std::shared_ptr<Utterance>> LoadUtterance(const std::string& path, SoundFormat format) {
  auto samples = format == SoundFormat::kWav ? ReadWav(path) : ReadRaw(path);
  if (!samples) return std::unexpected(samples.error());
  auto info = ReadInfo(path);
  if (!info) return std::unexpected(info.error());
  auto loaded = std::make_shared<Utterance>();
  loaded->text = std::move(info->text);
  loaded->spoken_text = std::move(info->spoken_text);
  loaded->plan.phonemes = std::move(info->phonemes);
  const Millis said = loaded->duration();
  const Millis heard = ToMs(samples->size());
  if (loaded->plan.phonemes.empty() || abs(said - heard) > kMaxMismatch) {
    return std::unexpected(InfoError(vm::Errc::kBadValue, path,
                                     "the phonemes last " + std::to_string(said.count()) +
                                         " ms and the sound " + std::to_string(heard.count()) +
                                         " ms, expected the same within 50 ms"));
  }
  loaded->samples = std::make_shared<SampleBuffer>(ToFrames(said));
  loaded->samples->Append(*samples);
  loaded->samples->Finish();
  return loaded;
}

}  // namespace ssm
