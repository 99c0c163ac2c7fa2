#include "ssm/engines/wav_piece.h"

#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "ssm/voice/resample.h"
#include "ssm/voice/wav_file.h"
#include "vm_protocol/core/file_kind.h"

namespace ssm {

vm::Result<std::vector<std::int16_t>> ReadSoundFile(const std::string& path) {
  if (auto fit = vm::CheckReadable(path); !fit) return std::unexpected(fit.error());
  SF_INFO info{};
  std::unique_ptr<SNDFILE, int (*)(SNDFILE*)> file(sf_open(path.c_str(), SFM_READ, &info),
                                                   sf_close);
  if (!file) {
    return vm::Fail(vm::Errc::kUnavailable, "cannot read '" + path + "': " + sf_strerror(nullptr));
  }
  if (info.samplerate < 1000 || info.samplerate > 400'000 || info.channels < 1 ||
      info.channels > 64) {
    return vm::Fail(vm::Errc::kBadValue, "'" + path + "' has " + std::to_string(info.channels) +
                                             " channels at " + std::to_string(info.samplerate) +
                                             " Hz, expected 1 to 64 at 1000 to 400000 Hz");
  }
  // What the header says of the length is not believed; what can be read counts.
  const auto channels = static_cast<std::size_t>(info.channels);
  const auto most = static_cast<std::size_t>(info.samplerate) * 3600;
  std::vector<short> block(4096 * channels);
  std::vector<std::int16_t> mono;
  for (sf_count_t got; (got = sf_readf_short(file.get(), block.data(), 4096)) > 0;) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(got); ++i) {
      int sum = 0;
      for (std::size_t c = 0; c < channels; ++c) sum += block[i * channels + c];
      mono.push_back(static_cast<std::int16_t>(sum / info.channels));
    }
    if (mono.size() > most) {
      return vm::Fail(vm::Errc::kTooLong, "'" + path + "' holds more than an hour of sound");
    }
  }
  if (mono.empty()) return vm::Fail(vm::Errc::kBadValue, "'" + path + "' has no sound in it");
  return Resample(mono, info.samplerate, kSampleRateHz);
}

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  std::filesystem::path base = std::filesystem::temp_directory_path(error);
  if (error) base = "/tmp";
  std::string pattern = (base / "galatea-ssm-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    throw std::runtime_error("cannot make a folder in '" + base.string() + "'");
  }
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void ScaleSamples(std::vector<std::int16_t>& samples, double volume) {
  if (volume == 1) return;
  for (std::int16_t& sample : samples) {
    const double loud = volume > 1 ? Limited(sample * volume) : sample * volume;
    sample = static_cast<std::int16_t>(std::lround(loud));
  }
}

void FitToSound(vm::PhonemeList& phonemes, const std::vector<std::int16_t>& samples) {
  const Millis length = ToMs(samples.size());
  Millis said = vm::TotalDuration(phonemes);
  while (said > length && !phonemes.empty()) {
    const Millis cut = std::min(said - length, phonemes.back().duration);
    phonemes.back().duration -= cut;
    said -= cut;
    if (phonemes.back().duration.count() == 0) phonemes.pop_back();
  }
  if (said == length) return;
  if (!phonemes.empty() && (phonemes.back().name == "pau" || phonemes.back().name == "sil")) {
    phonemes.back().duration += length - said;
  } else {
    phonemes.push_back({"pau", length - said});
  }
}

std::vector<WordTime> GuessWords(const std::string& text, const vm::PhonemeList& phonemes) {
  std::vector<WordTime> words;
  std::istringstream stream(text);
  std::size_t bytes = 0;
  for (std::string word; stream >> word; words.push_back({std::move(word), {}, {}})) {
    bytes += word.size();
  }
  const auto silent = [](const vm::Phoneme& p) { return p.name == "pau" || p.name == "sil"; };
  Millis begin{0}, spoken = vm::TotalDuration(phonemes);
  if (!phonemes.empty() && silent(phonemes.front())) begin = phonemes.front().duration;
  if (phonemes.size() > 1 && silent(phonemes.back())) spoken -= phonemes.back().duration;
  spoken -= begin;
  std::size_t before = 0;
  const auto at = [&](std::size_t byte) {
    return begin + spoken * static_cast<std::int64_t>(byte) / static_cast<std::int64_t>(bytes);
  };
  for (WordTime& word : words) {
    word.start = at(before);
    before += word.text.size();
    word.end = at(before);
  }
  return words;
}

}  // namespace ssm
