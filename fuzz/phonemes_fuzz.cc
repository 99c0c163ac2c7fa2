// A list that was read is written so that it reads the same, in each spelling.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "vm_protocol/core/phonemes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto list = vm::ParsePhonemes(std::string_view(reinterpret_cast<const char*>(data), size));
  if (!list) return 0;
  for (const auto& text : {vm::FormatPhonemesVoice(*list), vm::FormatPhonemesFace(*list),
                           vm::FormatPhonemesPlain(*list)}) {
    const auto again = vm::ParsePhonemes(text);
    const bool ends_oddly = !list->empty() && list->back().name == "phoneme_end";
    if (!ends_oddly && again != list) std::abort();
  }
  return 0;
}
