#include "ear/sound_keep.h"

#include <filesystem>
#include <fstream>
#include <system_error>

#include "vm_protocol/core/file_kind.h"

namespace ear {
namespace {

std::string LittleEndian(std::size_t number, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>((number >> (8 * i)) & 0xFF);
  return text;
}

/// RIFF WAVE, format 1 (PCM): Microsoft's "Multimedia Programming Interface", 1991, chapter 3.
std::string WavOf(std::span<const std::int16_t> samples) {
  const std::size_t bytes = samples.size() * 2;
  std::string wav = "RIFF" + LittleEndian(bytes + 36, 4) + "WAVEfmt " + LittleEndian(16, 4) +
                    LittleEndian(1, 2) + LittleEndian(1, 2) + LittleEndian(SoundKeep::kRateHz, 4) +
                    LittleEndian(SoundKeep::kRateHz * 2, 4) + LittleEndian(2, 2) +
                    LittleEndian(16, 2) + "data" + LittleEndian(bytes, 4);
  wav.reserve(wav.size() + bytes);
  for (const std::int16_t sample : samples) {
    wav += LittleEndian(static_cast<std::uint16_t>(sample), 2);
  }
  return wav;
}

}  // namespace

void SoundKeep::Declare() {
  slots_.Declare({.name = "Listen.keep",
                  .grammar = "NONE | <file>",
                  .initial = "NONE",
                  .help = "A folder: the sound of each utterance is written there as WAV, and "
                          "Result.sound tells of it. At most 256 files and 256 MiB; beyond, the "
                          "oldest of them go.",
                  .on_set = [this](const vm::SetValue& value) { return Choose(value.text); },
                  .saved = false});
  slots_.DeclareTold("Result.sound", "",
                     "MS BYTES WHOLE|CUT FILE: what was said, while Listen.keep names a "
                     "folder; reported before Result and NoMatch. CUT: Listen.longest ended "
                     "it.",
                     true);
}

vm::Result<std::string> SoundKeep::Choose(const std::string& folder) {
  std::error_code error;
  if (folder != "NONE" && !std::filesystem::is_directory(folder, error)) {
    return vm::Fail(vm::Errc::kBadValue, "'" + folder + "' is no folder");
  }
  const std::string chosen = folder == "NONE" ? "" : folder;
  if (chosen != folder_) {  // the files of a folder that was left are its owner's
    files_.clear();
    bytes_ = 0;
  }
  folder_ = chosen;
  return folder;
}

void SoundKeep::Keep(std::span<const std::int16_t> samples, bool longest) {
  if (!on()) return;
  const std::string wav = WavOf(samples);
  std::error_code ignored;
  while (!files_.empty() && (files_.size() >= kMaxFiles || bytes_ + wav.size() > kMaxBytes)) {
    std::filesystem::remove(files_.front().first, ignored);
    bytes_ -= files_.front().second;
    files_.pop_front();
  }
  const std::string path =
      (std::filesystem::path(folder_) / ("utterance-" + std::to_string(++count_) + ".wav"))
          .string();
  if (auto fit = vm::CheckWritable(path); !fit) {
    return slots_.ReportError("Listen.keep", fit.error());
  }
  std::ofstream file(path, std::ios::binary);
  file << wav;
  file.close();
  if (!file) {
    return slots_.ReportError(
        "Listen.keep",
        {vm::Errc::kUnavailable, path + ": cannot be written" + vm::RemovePart(path), 0});
  }
  files_.emplace_back(path, wav.size());
  bytes_ += wav.size();
  slots_.Report("Result.sound", std::to_string(samples.size() * 1000 / kRateHz) + " " +
                                    std::to_string(wav.size()) + (longest ? " CUT " : " WHOLE ") +
                                    path);
}

}  // namespace ear
