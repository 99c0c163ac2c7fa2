// Prosody files and the phonemes of .info files, in the form of the original.

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>

#include "ssm/voice/prosody.h"
#include "vm_protocol/core/file_kind.h"

namespace ssm {
namespace {

constexpr std::size_t kMaxFrames = 3600u * 200u;

class Reader {
 public:
  Reader(std::ifstream& file, std::string path) : file_(file), path_(std::move(path)) {}
  bool Next() {
    if (!std::getline(file_, line_)) return false;
    ++number_;
    while (!line_.empty() && (line_.back() == '\r' || line_.back() == ' ')) line_.pop_back();
    return true;
  }
  const std::string& line() const { return line_; }
  bool IsRule() const { return line_.starts_with('-'); }
  std::unexpected<vm::Error> Wrong(const std::string& expected) const {
    return vm::Fail(vm::Errc::kBadValue, "'" + path_ + "' line " + std::to_string(number_) +
                                             ": found '" + line_.substr(0, 40) + "', expected " +
                                             expected);
  }

 private:
  std::ifstream& file_;
  const std::string path_;
  std::string line_;
  std::size_t number_ = 0;
};

/// "12: 4.79 6.1": the number must be the one it is for.
bool ReadFrame(const std::string& line, std::size_t expected, double& f0, double& power) {
  std::size_t number = 0;
  const char* end = line.data() + line.size();
  auto [at, error] = std::from_chars(line.data(), end, number);
  if (error != std::errc() || number != expected || at == end || *at != ':') return false;
  char* rest = nullptr;
  f0 = std::strtod(at + 1, &rest);
  if (rest == at + 1) return false;
  char* last = nullptr;
  power = std::strtod(rest, &last);
  return last != rest && *last == '\0' && std::isfinite(f0) && std::isfinite(power) &&
         std::abs(f0) < 20 && std::abs(power) < 50;
}

}  // namespace

vm::Result<void> WriteProsody(const Prosody& prosody, const std::string& path) {
  if (auto fit = vm::CheckWritable(path); !fit) return fit;
  std::ofstream file(path, std::ios::trunc);
  file << "input_text: " << prosody.text << "\nspoken_text: " << prosody.spoken_text
       << "\nnumber_of_phonemes: " << prosody.phonemes.size()
       << "\ntotal_duration: " << vm::TotalDuration(prosody.phonemes).count() << "\n-----\n";
  for (const vm::Phoneme& phoneme : prosody.phonemes) {
    file << phoneme.name << " [" << phoneme.duration.count() << "]\n";
  }
  file << "-----\ntotal_frame: " << prosody.f0.size() - 1 << "\n-----\n";
  for (std::size_t i = 0; i < prosody.f0.size(); ++i) {
    file << i << ": " << prosody.f0[i] << " " << prosody.power[i] << "\n";
  }
  file << "-----\n";
  file.close();
  if (file) return {};
  const std::string why = std::strerror(errno);
  return vm::Fail(vm::Errc::kUnavailable,
                  "cannot write '" + path + "': " + why + vm::RemovePart(path));
}

vm::Result<Prosody> ReadProsody(const std::string& path) {
  if (auto fit = vm::CheckReadable(path); !fit) return std::unexpected(fit.error());
  std::ifstream file(path);
  if (!file) {
    return vm::Fail(vm::Errc::kUnavailable, "cannot read '" + path + "': " + std::strerror(errno));
  }
  Reader reader(file, path);
  Prosody prosody;
  while (reader.Next() && !reader.IsRule()) {
    if (reader.line().starts_with("input_text: ")) prosody.text = reader.line().substr(12);
    if (reader.line().starts_with("spoken_text: ")) prosody.spoken_text = reader.line().substr(13);
  }
  std::string phonemes;
  while (reader.Next() && !reader.IsRule()) phonemes += reader.line() + " ";
  auto list = vm::ParsePhonemes(phonemes);
  if (!list || list->empty()) return reader.Wrong("NAME [MS] for each phoneme, then -----");
  prosody.phonemes = std::move(*list);
  while (reader.Next() && !reader.IsRule()) {
  }
  double f0 = 0, power = 0;
  while (reader.Next() && !reader.IsRule()) {
    if (prosody.f0.size() >= kMaxFrames || !ReadFrame(reader.line(), prosody.f0.size(), f0, power))
      return reader.Wrong(std::to_string(prosody.f0.size()) + ": F0 POWER");
    prosody.f0.push_back(f0);
    prosody.power.push_back(power);
  }
  if (prosody.text.empty() || prosody.f0.empty()) {
    return reader.Wrong("a prosody file: input_text, phonemes and frames");
  }
  return prosody;
}

}  // namespace ssm
