#include "gateway/speech/speech_request.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "gateway/face/live_face.h"
#include "vm_protocol/core/utf8.h"
#include "vm_protocol/http/answer.h"

namespace gateway {
namespace {

using nlohmann::json;
using vm::Errc;

constexpr std::array<SoundFormat, 6> kFormats{{{"wav", "audio/wav", ""},
                                               {"pcm", "audio/pcm", ""},
                                               {"mp3", "audio/mpeg", "mp3"},
                                               {"opus", "audio/ogg", "opus"},
                                               {"aac", "audio/aac", "adts"},
                                               {"flac", "audio/flac", "flac"}}};

// https://platform.openai.com/docs/guides/text-to-speech, its voices.
constexpr std::array<std::string_view, 13> kVoicesOfOpenAi{
    "alloy", "ash",  "ballad", "cedar", "coral",   "echo", "fable",
    "marin", "nova", "onyx",   "sage",  "shimmer", "verse"};

/// One line, and nothing in it that the voice takes for markup.
std::string Plain(const std::string& text) {
  std::string plain;
  for (const char c : text) {
    const bool blank = static_cast<unsigned char>(c) < ' ' || c == '<' || c == '>' || c == 0x7F;
    plain += blank ? ' ' : c;
  }
  return plain;
}

}  // namespace

const SoundFormat* FindSoundFormat(std::string_view name) {
  const auto found = std::ranges::find(kFormats, name, &SoundFormat::name);
  return found == kFormats.end() ? nullptr : &*found;
}

bool IsVoiceOfOpenAi(std::string_view name) {
  return std::ranges::find(kVoicesOfOpenAi, name) != kVoicesOfOpenAi.end();
}

vm::Result<SpeechRequest> ReadSpeechRequest(std::string_view body) {
  const auto json = vm::ParseAnswer(body);
  if (!json || !json->is_object()) {
    return vm::Fail(Errc::kSyntax, "expected a JSON object with input, voice, response_format");
  }
  SpeechRequest request;
  request.text = Plain(vm::TextAt(*json, "input"));
  if (request.text.find_first_not_of(' ') == std::string::npos) {
    return vm::Fail(Errc::kBadValue, "input: expected the text to be spoken");
  }
  if (request.text.size() > kMaxSpokenBytes) {
    return vm::Fail(Errc::kTooLong, "input: more than " + std::to_string(kMaxSpokenBytes) +
                                        " bytes; send it in pieces");
  }
  if (vm::FirstBadUtf8(request.text)) return vm::Fail(Errc::kBadUtf8, "input: not UTF-8");
  request.voice = vm::TextAt(*json, "voice");
  const bool word = std::ranges::all_of(request.voice, [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
           c == '_' || c == '+' || c == '.';
  });
  if (!word || request.voice.size() > 64) {
    return vm::Fail(Errc::kBadValue, "voice: expected the name of a voice");
  }
  const std::string format = vm::TextAt(*json, "response_format");
  request.format = FindSoundFormat(format.empty() ? "mp3" : format);
  if (request.format == nullptr) {
    return vm::Fail(Errc::kBadValue, "response_format: '" + vm::ShownAnswer(format) +
                                         "' found, wav, pcm, mp3, opus, aac or flac expected");
  }
  if (const std::string stream = vm::TextAt(*json, "stream_format");
      !stream.empty() && stream != "audio") {
    return vm::Fail(Errc::kBadValue, "stream_format: '" + vm::ShownAnswer(stream) +
                                         "' found, audio expected; events are not sent");
  }
  if (const auto speed = json->find("speed"); speed != json->end()) {
    request.speed = speed->is_number() ? speed->get<double>() : 0;
    if (!(request.speed >= 0.25 && request.speed <= 4)) {
      return vm::Fail(Errc::kBadValue, "speed: expected a number from 0.25 to 4");
    }
  }
  if (const auto set = json->find("visemes"); set != json->end()) {
    auto found = WeightSets::Built().Find(vm::TextAt(*json, "visemes"));
    if (!found) return vm::Fail(found.error().code, "visemes: " + found.error().text);
    request.set = *found;
  }
  if (const auto fps = json->find("fps"); fps != json->end()) {
    const auto live = ReadLive("16000", fps->dump(-1, ' ', true));
    if (!live) return std::unexpected(live.error());
    request.fps = live->fps;
  }
  return request;
}

}  // namespace gateway
