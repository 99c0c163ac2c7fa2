#include "srm/http/http_transcriber.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "vm_protocol/http/answer.h"
#include "vm_protocol/http/json_entry.h"
#include "vm_protocol/http/multipart.h"

namespace srm {
namespace {

using nlohmann::json;
using vm::Errc;

void AddLittleEndian(std::string& bytes, std::uint32_t value, int count) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFF);
}

/// A WAV file of 16 bit mono.
std::string WavOf(std::span<const std::int16_t> sound) {
  const auto rate = static_cast<std::uint32_t>(kSampleRateHz);
  const auto size = static_cast<std::uint32_t>(sound.size() * 2);
  std::string wav = "RIFF";
  AddLittleEndian(wav, 36 + size, 4);
  wav += "WAVEfmt ";
  AddLittleEndian(wav, 16, 4);  // of what follows
  AddLittleEndian(wav, 1, 2);   // PCM
  AddLittleEndian(wav, 1, 2);   // channels
  AddLittleEndian(wav, rate, 4);
  AddLittleEndian(wav, rate * 2, 4);
  AddLittleEndian(wav, 2, 2);
  AddLittleEndian(wav, 16, 2);
  wav += "data";
  AddLittleEndian(wav, size, 4);
  for (const std::int16_t sample : sound) {
    AddLittleEndian(wav, static_cast<std::uint16_t>(sample), 2);
  }
  return wav;
}

double NumberAt(const json& object, const char* key, double otherwise) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : otherwise;
}

Millis SecondsAt(const json& object, const char* key) {
  const double seconds = NumberAt(object, key, 0);
  return Millis(std::llround(std::clamp(seconds, 0.0, 7200.0) * 1000));
}

/// As many as the member has; nothing of what is no object.
std::vector<json> ObjectsAt(const json& object, const char* key) {
  const auto found = object.find(key);
  std::vector<json> objects;
  if (found == object.end() || !found->is_array()) return objects;
  for (const json& one : *found) {
    if (one.is_object()) objects.push_back(one);
  }
  return objects;
}

/// One line without control signs, blanks between the words.
std::string OneLine(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool blank = static_cast<unsigned char>(c) <= ' ' || c == 0x7F;
    if (!blank) line += c;
    if (blank && !line.empty() && line.back() != ' ') line += ' ';
  }
  if (line.ends_with(' ')) line.pop_back();
  return line;
}

class DeafDecoder final : public SpeechDecoder {
 public:
  vm::Result<void> Use(const std::vector<const ear::Grammar*>&) override { return {}; }
  vm::Result<void> Pronounce(const std::string&, const std::string&) override { return {}; }
  void Begin() override {}
  void Feed(std::span<const std::int16_t>) override {}
  std::string Partial() override { return ""; }
  Hypothesis End() override { return {}; }
  void set_most(std::size_t) override {}
};

}  // namespace

std::unique_ptr<SpeechDecoder> MakeDeafDecoder() { return std::make_unique<DeafDecoder>(); }

vm::Result<HttpEarSettings> ParseHttpEar(std::string_view text, const std::string& folder) {
  const json root = json::parse(text, nullptr, false, true);
  if (!root.is_object()) {
    return vm::Fail(Errc::kSyntax, "expected a JSON object {\"url\": ..., \"model\": ...}");
  }
  vm::JsonEntry entry(root, "ear");
  HttpEarSettings settings;
  settings.model = entry.Text("model");
  settings.language = entry.Text("language", "");
  settings.prompt = entry.Text("prompt", "");
  settings.words = entry.Flag("words", false);
  auto server = vm::ReadServer(entry, folder, "/audio/transcriptions", "an ear", settings.server);
  if (!server) return std::unexpected(server.error());
  settings.server = std::move(*server);
  return settings;
}

vm::Result<Hypothesis> ReadTranscript(std::string_view body) {
  const auto answer = vm::ParseAnswer(body);
  if (!answer || !answer->is_object()) {
    return vm::Fail(Errc::kSyntax, "expected {\"text\": ...}, got '" + vm::ShownAnswer(body) + "'");
  }
  if (const auto error = vm::ErrorIn(*answer)) {
    return vm::Fail(Errc::kUnavailable, "the server reports: " + vm::ShownAnswer(*error));
  }
  if (!answer->contains("text") || !(*answer)["text"].is_string()) {
    return vm::Fail(Errc::kSyntax, "expected {\"text\": ...}, got '" + vm::ShownAnswer(body) + "'");
  }
  Hypothesis heard{.text = OneLine(vm::TextAt(*answer, "text")), .confidence = 1};
  for (const json& word : ObjectsAt(*answer, "words")) {
    const std::string said = OneLine(vm::TextAt(word, "word"));
    if (said.empty()) continue;
    heard.words.push_back(
        {.text = said, .start = SecondsAt(word, "start"), .end = SecondsAt(word, "end")});
  }
  double sum = 0, count = 0;
  for (const json& segment : ObjectsAt(*answer, "segments")) {
    const double log_probability = NumberAt(segment, "avg_logprob", 1);
    if (log_probability > 0) continue;
    sum += std::exp(log_probability);
    ++count;
  }
  if (count > 0) heard.confidence = sum / count;
  return heard;
}

HttpTranscriber::HttpTranscriber(vm::Scheduler& clock, std::shared_ptr<vm::HttpTransport> transport,
                                 HttpEarSettings settings)
    : clock_(clock), transport_(std::move(transport)), settings_(std::move(settings)) {}

vm::Result<void> HttpTranscriber::Transcribe(std::span<const std::int16_t> sound, Done done) {
  if (jobs_.size() > kMostWaiting) {
    return vm::Fail(Errc::kLimit, settings_.server.url + ": " + std::to_string(kMostWaiting) +
                                      " utterances wait already, this one is not heard");
  }
  jobs_.push_back({{sound.begin(), sound.end()}, std::move(done)});
  if (jobs_.size() == 1) AskNext();
  return {};
}

void HttpTranscriber::AskNext() {
  vm::HttpRequest request = vm::RequestTo(settings_.server);
  std::vector<vm::FormPart> parts{
      {.name = "model", .content = settings_.model},
      {.name = "response_format", .content = settings_.words ? "verbose_json" : "json"}};
  if (settings_.words) parts.push_back({.name = "timestamp_granularities[]", .content = "word"});
  if (!settings_.language.empty()) {
    parts.push_back({.name = "language", .content = settings_.language});
  }
  if (!settings_.prompt.empty()) parts.push_back({.name = "prompt", .content = settings_.prompt});
  const json more = json::parse(settings_.server.more);
  for (const auto& [name, value] : more.items()) {
    parts.push_back(
        {.name = name, .content = value.is_string() ? value.get<std::string>() : value.dump()});
  }
  parts.push_back({.name = "file",
                   .content = WavOf(jobs_.front().sound),
                   .file_name = "utterance.wav",
                   .content_type = "audio/wav"});
  vm::SetForm(parts, request);
  head_.reset();
  body_.clear();
  AwaitMore();
  exchange_ = transport_->Post(std::move(request),
                               {.on_head =
                                    [this](const vm::HttpHead& head) {
                                      head_ = head;
                                      AwaitMore();
                                    },
                                .on_data =
                                    [this](std::string_view bytes) {
                                      body_ += bytes;
                                      AwaitMore();
                                    },
                                .on_end = [this](const vm::Result<void>& end) { OnEnd(end); }});
}

void HttpTranscriber::OnEnd(const vm::Result<void>& end) {
  if (!end) return Fail(end.error());
  if (!head_) return Fail({Errc::kUnavailable, "it has said nothing", 0});
  if (head_->status != 200) return Fail(vm::StatusError(*head_, body_));
  auto heard = ReadTranscript(body_);
  if (!heard) return Fail(heard.error());
  End(std::move(heard));
}

void HttpTranscriber::AwaitMore() {
  if (next_timer_ != 0) return;  // it has ended
  clock_.Cancel(stall_timer_);
  stall_timer_ = clock_.After(settings_.server.stall, [this] {
    stall_timer_ = 0;
    Fail({Errc::kTimeout,
          "nothing has come for " + std::to_string(settings_.server.stall.count()) + " ms", 0});
  });
}

void HttpTranscriber::Fail(vm::Error error) {
  error.text =
      settings_.server.url + ": " + vm::WithoutSecret(std::move(error.text), settings_.server.key);
  End(std::unexpected(std::move(error)));
}

void HttpTranscriber::End(vm::Result<Hypothesis> heard) {
  if (next_timer_ != 0) return;
  clock_.Cancel(std::exchange(stall_timer_, 0));
  // We may be within a call of the exchange, so it goes a little later, and the next begins then.
  next_timer_ = clock_.Post([this, heard = std::move(heard)] {
    next_timer_ = 0;
    exchange_.reset();
    const Done done = std::move(jobs_.front().done);
    jobs_.pop_front();
    if (!jobs_.empty()) AskNext();
    done(heard);
  });
}

void HttpTranscriber::Abandon() {
  clock_.Cancel(std::exchange(stall_timer_, 0));
  clock_.Cancel(std::exchange(next_timer_, 0));
  exchange_.reset();
  jobs_.clear();
}

}  // namespace srm
