#include "ssm/voice/wav_file.h"

#include <sndfile.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "vm_protocol/core/file_kind.h"

namespace ssm {
namespace {

constexpr int kWavFormat = SF_FORMAT_WAV | SF_FORMAT_PCM_16;

vm::Error CannotWrite(const std::string& path, const std::string& why) {
  return {vm::Errc::kUnavailable, "cannot write '" + path + "': " + why, 0};
}
vm::Error CannotRead(const std::string& path, const std::string& why) {
  return {vm::Errc::kUnavailable, "cannot read '" + path + "': " + why, 0};
}
vm::Error TooLong(const std::string& path) {
  return {vm::Errc::kTooLong, "'" + path + "' holds more than an hour of sound", 0};
}

}  // namespace

struct WavWriter::File {
  File(SNDFILE* opened, std::string its_path) : handle(opened), path(std::move(its_path)) {}
  ~File() { sf_close(handle); }
  File(const File&) = delete;
  SNDFILE* handle;
  std::string path;
};

WavWriter::WavWriter(std::unique_ptr<File> file) : file_(std::move(file)) {}
WavWriter::~WavWriter() = default;

vm::Result<std::unique_ptr<WavWriter>> WavWriter::Open(const std::string& path) {
  SF_INFO info{};
  info.samplerate = static_cast<int>(kSampleRateHz);
  info.channels = 1;
  info.format = kWavFormat;
  SNDFILE* handle = sf_open(path.c_str(), SFM_WRITE, &info);
  if (handle == nullptr) return std::unexpected(CannotWrite(path, sf_strerror(nullptr)));
  return std::unique_ptr<WavWriter>(new WavWriter(std::make_unique<File>(handle, path)));
}

vm::Result<void> WavWriter::Write(std::span<const std::int16_t> samples) {
  const auto wanted = static_cast<sf_count_t>(samples.size());
  const sf_count_t written = sf_writef_short(file_->handle, samples.data(), wanted);
  frames_ += static_cast<std::size_t>(std::max<sf_count_t>(written, 0));
  if (written == wanted) return {};
  return std::unexpected(CannotWrite(file_->path, sf_strerror(file_->handle)));
}

vm::Result<void> WavWriter::WriteSilence(std::size_t frames) {
  static constexpr std::array<std::int16_t, kSampleRateHz> kSecond{};
  while (frames > 0) {
    const std::size_t piece = std::min(frames, kSecond.size());
    if (auto written = Write(std::span(kSecond).first(piece)); !written) return written;
    frames -= piece;
  }
  return {};
}

void WavWriter::Flush() {
  sf_command(file_->handle, SFC_UPDATE_HEADER_NOW, nullptr, 0);
  sf_write_sync(file_->handle);
}

vm::Result<void> WriteWav(const std::string& path, std::span<const std::int16_t> samples) {
  if (auto fit = vm::CheckWritable(path); !fit) return fit;
  auto writer = WavWriter::Open(path);
  if (!writer) return std::unexpected(writer.error());
  auto written = (*writer)->Write(samples);
  if (!written) written.error().text += vm::RemovePart(path);
  return written;
}

vm::Result<void> WriteRaw(const std::string& path, std::span<const std::int16_t> samples) {
  if (auto fit = vm::CheckWritable(path); !fit) return fit;
  std::string bytes;
  bytes.reserve(samples.size() * 2);
  for (const std::int16_t sample : samples) {
    const auto bits = static_cast<std::uint16_t>(sample);
    bytes += static_cast<char>(bits >> 8);
    bytes += static_cast<char>(bits & 0xff);
  }
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (file) return {};
  const std::string why = std::strerror(errno);
  return std::unexpected(CannotWrite(path, why + vm::RemovePart(path)));
}

vm::Result<std::vector<std::int16_t>> ReadWav(const std::string& path) {
  if (auto fit = vm::CheckReadable(path); !fit) return std::unexpected(fit.error());
  SF_INFO info{};
  SNDFILE* handle = sf_open(path.c_str(), SFM_READ, &info);
  if (handle == nullptr) return std::unexpected(CannotRead(path, sf_strerror(nullptr)));
  std::vector<std::int16_t> samples;
  vm::Result<void> outcome;
  if (info.samplerate != kSampleRateHz || info.channels != 1) {
    outcome = vm::Fail(vm::Errc::kBadValue, "'" + path + "' has " + std::to_string(info.channels) +
                                                " channels at " + std::to_string(info.samplerate) +
                                                " Hz, expected one channel at 16000 Hz");
  } else if (info.frames < 0 || info.frames > static_cast<sf_count_t>(kMaxLoadedFrames)) {
    outcome = std::unexpected(TooLong(path));
  } else {
    samples.resize(static_cast<std::size_t>(info.frames));
    const sf_count_t got = sf_readf_short(handle, samples.data(), info.frames);
    samples.resize(static_cast<std::size_t>(std::max<sf_count_t>(got, 0)));
  }
  sf_close(handle);
  if (!outcome) return std::unexpected(outcome.error());
  return samples;
}

vm::Result<std::vector<std::int16_t>> ReadRaw(const std::string& path) {
  if (auto fit = vm::CheckReadable(path); !fit) return std::unexpected(fit.error());
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  if (size < 0) return std::unexpected(CannotRead(path, std::strerror(errno)));
  if (static_cast<std::size_t>(size) > kMaxLoadedFrames * 2) return std::unexpected(TooLong(path));
  std::string bytes(static_cast<std::size_t>(size), '\0');
  file.seekg(0);
  if (!file.read(bytes.data(), size))
    return std::unexpected(CannotRead(path, std::strerror(errno)));
  std::vector<std::int16_t> samples(bytes.size() / 2);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto high = static_cast<unsigned char>(bytes[2 * i]);
    const auto low = static_cast<unsigned char>(bytes[2 * i + 1]);
    samples[i] = static_cast<std::int16_t>(static_cast<std::uint16_t>(high << 8 | low));
  }
  return samples;
}

bool IsSoundFile(const std::string& path) {
  if (!vm::CheckReadable(path)) return false;
  SF_INFO info{};
  SNDFILE* file = sf_open(path.c_str(), SFM_READ, &info);
  if (file == nullptr) return false;
  sf_close(file);
  return info.frames > 0;
}

}  // namespace ssm
