#include "vdm/train/reading.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <sstream>
#include <stdexcept>

#include "embedded/reading_cs.h"
#include "embedded/reading_en.h"
#include "embedded/reading_fi.h"
#include "embedded/reading_it.h"
#include "embedded/reading_ja.h"
#include "embedded/reading_ru.h"
#include "embedded/voices.h"

namespace vdm {
namespace {

constexpr std::array<std::string_view, 7> kLanguages = {"en", "en-gb", "ja", "it",
                                                        "fi", "cs",    "ru"};

std::unexpected<vm::Error> Wrong(const std::string& name, int line, const std::string& what) {
  return vm::Fail(vm::Errc::kBadValue, name + ":" + std::to_string(line) + ": " + what);
}

template <typename T>
T OrThrow(vm::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text);
  return std::move(*result);
}

}  // namespace

vm::Result<std::vector<TrainingVoice>> ReadVoices(const std::string& name, std::string_view text) {
  std::vector<TrainingVoice> voices;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    TrainingVoice voice;
    std::string count, more;
    if (!(words >> voice.name) || voice.name.starts_with('#')) continue;
    if (!(words >> voice.engine >> voice.language >> count >> voice.variant) || words >> more) {
      return Wrong(name, number, "NAME ENGINE LANGUAGE SENTENCES VARIANT expected");
    }
    const auto [end, error] =
        std::from_chars(count.data(), count.data() + count.size(), voice.sentences);
    if (error != std::errc() || end != count.data() + count.size() || voice.sentences > 10'000) {
      return Wrong(name, number, "'" + count + "' found, 0 to 10000 sentences expected");
    }
    if (voice.engine != "flite" && voice.engine != "espeak" && voice.engine != "festival") {
      return Wrong(name, number,
                   "'" + voice.engine + "' found, flite, espeak or festival expected");
    }
    if (std::ranges::find(kLanguages, voice.language) == kLanguages.end()) {
      return Wrong(name, number,
                   "'" + voice.language + "' found, one of en, en-gb, ja, it, fi, cs, ru expected");
    }
    if (voice.variant == "-") voice.variant.clear();
    voices.push_back(std::move(voice));
  }
  return voices;
}

const std::vector<TrainingVoice>& BuiltVoices() {
  static const auto voices = OrThrow(ReadVoices("voices.txt", embedded::voices()));
  return voices;
}

std::string Reading::Text(std::size_t n, Dice dice) const {
  if (n % 2 == 0) {
    const std::size_t first = dice.Below(sentences.size());
    return sentences[(first + n / 2) % sentences.size()];
  }
  Dice chance = dice.For(n);
  std::string text;
  for (std::size_t count = 4 + chance.Below(6); count > 0; --count) {
    text += (text.empty() ? "" : between) + words[chance.Below(words.size())];
  }
  return text + stop;
}

vm::Result<Reading> ReadReading(const std::string& name, std::string_view text) {
  Reading out;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::string kind, word;
    if (!(words >> kind) || kind.starts_with('#')) continue;
    if (kind == "sentence" && std::getline(words >> std::ws, word)) {
      out.sentences.push_back(word);
    } else if (kind == "words") {
      while (words >> word) out.words.push_back(word);
    } else {
      return Wrong(name, number,
                   "'" + kind + "' found, 'sentence TEXT' or 'words WORD...' expected");
    }
  }
  if (out.sentences.empty() || out.words.empty()) {
    return Wrong(name, number, "no sentences or no words found, both expected");
  }
  return out;
}

const Reading& BuiltReading(const std::string& language) {
  static const auto built = [] {
    std::map<std::string, Reading> readings;
    const auto add = [&](const std::string& name, std::string_view text, const char* between,
                         const char* stop) {
      Reading read = OrThrow(ReadReading("reading_" + name + ".txt", text));
      read.between = between;
      read.stop = stop;
      readings.emplace(name, std::move(read));
    };
    add("en", embedded::reading_en(), " ", ".");
    add("ja", embedded::reading_ja(), "、", "。");
    add("it", embedded::reading_it(), " ", ".");
    add("fi", embedded::reading_fi(), " ", ".");
    add("cs", embedded::reading_cs(), " ", ".");
    add("ru", embedded::reading_ru(), " ", ".");
    return readings;
  }();
  return built.at(language == "en-gb" ? "en" : language);
}

}  // namespace vdm
