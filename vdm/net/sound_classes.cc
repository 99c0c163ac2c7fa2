#include "vdm/net/sound_classes.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "embedded/sounds.h"

namespace vdm {

vm::Result<SoundClasses> SoundClasses::Read(const std::string& name, std::string_view text) {
  SoundClasses out;
  std::istringstream lines{std::string(text)};
  int number = 0;
  const auto wrong = [&](const std::string& what) {
    return vm::Fail(vm::Errc::kBadValue, name + ":" + std::to_string(number) + ": " + what);
  };
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::string first, phoneme;
    if (!(words >> first) || first.starts_with('#')) continue;
    if (std::ranges::find(out.names_, first) != out.names_.end()) {
      return wrong("the class '" + first + "' is here twice");
    }
    const std::size_t before = out.class_of_.size();
    while (words >> phoneme) {
      if (!out.class_of_.emplace(phoneme, out.names_.size()).second) {
        return wrong("the phoneme '" + phoneme + "' is here twice");
      }
    }
    if (out.class_of_.size() == before) {
      return wrong("the class '" + first + "' found without phonemes");
    }
    out.names_.push_back(first);
  }
  if (out.names_.empty()) return wrong("no class found, at least one expected");
  return out;
}

const SoundClasses& SoundClasses::Built() {
  static const SoundClasses built = [] {
    auto read = Read("sounds.txt", embedded::sounds());
    if (!read) throw std::runtime_error(read.error().text);
    return std::move(*read);
  }();
  return built;
}

}  // namespace vdm
