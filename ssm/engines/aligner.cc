#include "ssm/engines/aligner.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "ssm/process/child_process.h"

namespace ssm {
namespace {

using Json = nlohmann::json;

vm::Error BadAlignment(const std::string& line) {
  return {vm::Errc::kBadValue, "the aligner answered '" + line.substr(0, 60) + "'", 0};
}

/// {"phonemes":[{"name":"hh","ms":60}...],"words":[{"text":"hello","start":10,"end":300}...]}
vm::Result<Piece> ReadAnswer(const std::string& line) {
  const Json answer = Json::parse(line, nullptr, false);
  if (!answer.is_object()) return std::unexpected(BadAlignment(line));
  if (answer.contains("error")) {
    return vm::Fail(vm::Errc::kUnavailable, "align: " + answer["error"].dump());
  }
  Piece piece;
  try {
    for (const Json& phoneme : answer.at("phonemes")) {
      piece.phonemes.push_back(
          {phoneme.at("name").get<std::string>(), Millis(phoneme.at("ms").get<std::int64_t>())});
    }
    for (const Json& word : answer.at("words")) {
      piece.words.push_back({word.at("text").get<std::string>(),
                             Millis(word.at("start").get<std::int64_t>()),
                             Millis(word.at("end").get<std::int64_t>())});
    }
  } catch (const Json::exception&) {
    return std::unexpected(BadAlignment(line));
  }
  return piece;
}

}  // namespace

Aligner::Aligner(Options options) : options_(std::move(options)) {}
Aligner::~Aligner() = default;

vm::Result<Piece> Aligner::Align(const std::string& wav_path, const std::string& text,
                                 const std::atomic<bool>& cancelled) {
  if (!process_) {
    auto started = ChildProcess::Start({options_.program, "--resident", "--format", "json"}, true);
    if (!started) return std::unexpected(started.error());
    process_ = std::move(*started);
  }
  const ChildProcess::Wait wait{ChildProcess::Clock::now() + options_.limit, &cancelled};
  const Json job = {{"wav", wav_path}, {"text", text}};
  vm::Result<std::string> line;
  if (auto sent =
          process_->Write(job.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n", wait);
      !sent) {
    line = std::unexpected(sent.error());
  } else {
    line = process_->ReadLine(wait);
  }
  if (!line) {
    process_.reset();  // the next job gets a new one
    return std::unexpected(line.error());
  }
  return ReadAnswer(*line);
}

}  // namespace ssm
