#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "srm/engine/transcriber.h"
#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/http/endpoint.h"
#include "vm_protocol/http/http.h"

namespace srm {

struct HttpEarSettings {
  vm::ServerSettings server{.stall = std::chrono::milliseconds(30'000), .max_bytes = 1u << 20};
  std::string model{};
  std::string language{};  ///< "en", "ja"; empty: the server finds out
  std::string prompt{};    ///< words it should expect; empty: none
  bool words = false;      ///< ask for the time of each word (verbose_json)
};
/// From a configuration in JSON (docs/speech.md, An ear by HTTP); files relative to `folder`.
/// Errors: kSyntax, kBadValue, kUnavailable.
vm::Result<HttpEarSettings> ParseHttpEar(std::string_view json, const std::string& folder);

/// What a server answers: {"text": ..., "words": [{"word", "start", "end"}], "segments":
/// [{"avg_logprob"}]}; the last two may be missing. The confidence is the mean of the segments'
/// exp(avg_logprob), 1 without them. Pure. Errors: kSyntax, kUnavailable (it reports an error).
vm::Result<Hypothesis> ReadTranscript(std::string_view body);

/// An OpenAI-compatible ear: each utterance is one POST of a WAV file to /v1/audio/transcriptions,
/// one after the other. Lifetime: the clock outlives it. Thread: the scheduler's.
/// Limits: kMostWaiting utterances beside the one that is asked about. Errors name the address and
/// never the key.
class HttpTranscriber final : public Transcriber {
 public:
  static constexpr std::size_t kMostWaiting = 4;
  HttpTranscriber(vm::Scheduler& clock, std::shared_ptr<vm::HttpTransport> transport,
                  HttpEarSettings settings);
  ~HttpTranscriber() override { Abandon(); }
  vm::Result<void> Transcribe(std::span<const std::int16_t> sound, Done done) override;
  bool Busy() const override { return !jobs_.empty(); }
  void Abandon() override;

 private:
  struct Job {
    std::vector<std::int16_t> sound;
    Done done;
  };
  void AskNext();
  void AwaitMore();
  void OnEnd(const vm::Result<void>& end);
  void Fail(vm::Error error);
  void End(vm::Result<Hypothesis> heard);

  vm::Scheduler& clock_;
  const std::shared_ptr<vm::HttpTransport> transport_;
  const HttpEarSettings settings_;
  std::deque<Job> jobs_;  // the first is asked about
  std::optional<vm::HttpHead> head_;
  std::string body_;
  vm::TimerId stall_timer_ = 0, next_timer_ = 0;
  std::unique_ptr<vm::HttpExchange> exchange_;
};

}  // namespace srm
