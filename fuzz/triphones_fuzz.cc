// Triphones of vdm as text, and their questions: no input may do more than be refused, and what is
// read moves a mouth.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "vdm/triphone/triphone_model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  static_cast<void>(vdm::ReadPhonemeSets("questions.txt", text));
  const auto model = vdm::ParseTriphones("x.tri", text);
  if (!model) return 0;
  static const vm::PhonemeList spoken = vm::ParsePhonemes("pau 50 m 40 aa 70 t 5 pau 90").value();
  if (!vdm::MouthOf(*model, spoken)) std::abort();
  const std::string written = vdm::FormatTriphones(*model);
  const auto again = vdm::ParseTriphones("x.tri", written);
  if (!again || vdm::FormatTriphones(*again) != written) std::abort();
  return 0;
}
