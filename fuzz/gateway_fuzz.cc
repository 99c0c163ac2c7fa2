// What clients of the gateway send: requests for speech, messages of control, tables of weights,
// sound. No input may do more than be refused.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gateway/face/face_messages.h"
#include "gateway/speech/speech_request.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  static_cast<void>(gateway::ReadControl(text));
  static_cast<void>(gateway::WeightSets::Read(text, ""));
  static_cast<void>(gateway::WeightSets::Read("", text));
  const auto request = gateway::ReadSpeechRequest(text);
  // Nothing of a text may end its line, or be markup.
  if (request && request->text.find_first_of("<>\n\r") != std::string::npos) std::abort();
  return 0;
}
