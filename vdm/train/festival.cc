#include "vdm/train/festival.h"

#include <fmt/format.h>
#include <iconv.h>
#include <spawn.h>
#include <sys/wait.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "embedded/festival_phones.h"
#include "sound/sound_file.h"

extern char** environ;

namespace vdm {
namespace {

std::unexpected<vm::Error> Wrong(const std::string& name, int line, const std::string& what) {
  return vm::Fail(vm::Errc::kBadValue, fmt::format("{}:{}: {}", name, line, what));
}

/// What cannot be written in the charset is left out.
std::string Encoded(const std::string& text, const std::string& charset) {
  const iconv_t converter = iconv_open((charset + "//IGNORE").c_str(), "UTF-8");
  if (converter == reinterpret_cast<iconv_t>(-1)) {
    throw std::runtime_error("festival_phones.txt: no such charset '" + charset + "'");
  }
  std::string in = text, out(4 * text.size() + 4, '\0');
  char *from = in.data(), *to = out.data();
  std::size_t left = in.size(), space = out.size();
  iconv(converter, &from, &left, &to, &space);
  iconv_close(converter);
  out.resize(out.size() - space);
  return out;
}

std::string Quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string FileOf(const std::string& folder, std::size_t n, const char* kind) {
  return fmt::format("{}/{}.{}", folder, n, kind);
}

bool RunFestival(const std::string& script) {
  const std::array<const char*, 6> words = {"timeout", "600",          "festival",
                                            "-b",      script.c_str(), nullptr};
  pid_t child = 0;
  int status = 1;
  return posix_spawnp(&child, words[0], nullptr, nullptr, const_cast<char* const*>(words.data()),
                      environ) == 0 &&
         waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

vm::Result<FestivalLanguages> ReadFestivalPhones(const std::string& name, std::string_view text) {
  FestivalLanguages languages;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::string word, charset, more;
    // A comment is "# " at the beginning: # alone is also a phone.
    if (!(words >> word) || line.starts_with("# ")) continue;
    if (word == "charset") {
      if (!(words >> word >> charset) || words >> more) {
        return Wrong(name, number, "charset LANGUAGE NAME expected");
      }
      if (!languages.try_emplace(word, FestivalLanguage{charset, {}}).second) {
        return Wrong(name, number, "'" + word + "' stands there twice");
      }
      continue;
    }
    const auto language = languages.find(word);
    if (language == languages.end()) {
      return Wrong(name, number,
                   "'" + word + "' found, charset or a language that has one expected");
    }
    while (words >> word) {
      const std::size_t sign = word.find('=', 1);
      if (sign == std::string::npos || sign + 1 == word.size()) {
        return Wrong(name, number, "'" + word + "' found, THEIRS=OURS expected");
      }
      if (!language->second.phones.try_emplace(word.substr(0, sign), word.substr(sign + 1))
               .second) {
        return Wrong(name, number, "'" + word.substr(0, sign) + "' stands there twice");
      }
    }
  }
  return languages;
}

const FestivalLanguages& BuiltFestivalPhones() {
  static const auto languages = [] {
    auto read = ReadFestivalPhones("festival_phones.txt", embedded::festival_phones());
    if (!read) throw std::runtime_error(read.error().text);
    return std::move(*read);
  }();
  return languages;
}

vm::Result<vm::PhonemeList> ReadSegments(const std::string& name, std::string_view text,
                                         const FestivalLanguage& language) {
  vm::PhonemeList list;
  std::istringstream lines{std::string(text)};
  std::int64_t at_ms = 0;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    if (++number == 1 && line == "#") continue;
    std::istringstream words(line);
    double end_s = 0;
    std::string colour, phone;
    if (!(words >> end_s >> colour >> phone) || !(end_s >= 0) || end_s > 600) {
      return Wrong(name, number, "'" + line.substr(0, 40) + "' found, END_S COLOUR PHONE expected");
    }
    const auto ours = language.phones.find(phone);
    if (ours == language.phones.end()) {
      return Wrong(name, number, "festival_phones.txt does not name the phone '" + phone + "'");
    }
    const std::int64_t end_ms = std::max(at_ms, std::int64_t{std::lround(end_s * 1000)});
    list.push_back({ours->second, std::chrono::milliseconds(end_ms - at_ms)});
    at_ms = end_ms;
  }
  if (list.empty()) return Wrong(name, number, "no segments found");
  return list;
}

vm::Result<std::vector<Take>> ReadByFestival(const TrainingVoice& voice,
                                             const std::vector<std::string>& texts,
                                             const std::string& folder) {
  const FestivalLanguage& language = BuiltFestivalPhones().at(voice.language);
  std::filesystem::create_directories(folder);
  const std::string script = folder + "/read.scm";
  std::ofstream file(script);
  file << "(voice_" << voice.variant << ")\n";
  for (std::size_t n = 0; n < texts.size(); ++n) {
    file << "(set! said (utt.synth (Utterance Text " << Quoted(Encoded(texts[n], language.charset))
         << ")))\n(utt.save.wave said " << Quoted(FileOf(folder, n, "wav"))
         << " 'riff)\n(utt.save.segs said " << Quoted(FileOf(folder, n, "segs")) << ")\n";
  }
  file.close();
  if (!file || !RunFestival(script)) {
    return vm::Fail(vm::Errc::kUnavailable,
                    fmt::format("voice '{}' cannot be had from festival (Debian: festival and the "
                                "packages that tables/voices.txt names)",
                                voice.name));
  }
  std::vector<Take> takes;
  for (std::size_t n = 0; n < texts.size(); ++n) {
    auto samples = sound::ReadSound(FileOf(folder, n, "wav"));
    if (!samples) return std::unexpected(samples.error());
    const std::string segments = FileOf(folder, n, "segs");
    std::ifstream in(segments);
    auto phonemes =
        ReadSegments(segments, std::string(std::istreambuf_iterator<char>(in), {}), language);
    if (!phonemes) return std::unexpected(phonemes.error());
    takes.push_back({voice.name, std::move(*samples), std::move(*phonemes)});
  }
  std::filesystem::remove_all(folder);
  return takes;
}

}  // namespace vdm
