#include "vdm/triphone/phoneme_file.h"

#include <algorithm>

#include "vm_protocol/core/text_file.h"

namespace vdm {

vm::Result<vm::PhonemeList> ReadPhonemeFile(const std::string& path) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 20;
  auto text = vm::ReadTextFile(path, kMostBytes);
  if (!text) return std::unexpected(text.error());
  std::ranges::replace_if(
      *text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  text->erase(text->find_last_not_of(' ') + 1);
  auto phonemes = vm::ParsePhonemes(*text);
  if (!phonemes) return vm::Fail(phonemes.error().code, path + ": " + phonemes.error().text);
  return phonemes;
}

}  // namespace vdm
