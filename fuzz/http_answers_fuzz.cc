// What servers of voices and ears answer, and configurations that name them.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "srm/http/http_transcriber.h"
#include "vm_protocol/http/answer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (vm::ErrorTextOf(text).contains('\n')) std::abort();
  static_cast<void>(srm::ParseHttpEar(text, "/nowhere"));
  const auto heard = srm::ReadTranscript(text);
  if (heard && heard->text.contains('\n')) std::abort();
  if (heard && !(heard->confidence >= 0 && heard->confidence <= 1)) std::abort();
  return 0;
}
