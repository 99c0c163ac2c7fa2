#include "ssm/engines/espeak_link.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <sstream>
#include <utility>

namespace ssm {
namespace {

using Answer = EspeakLink::Answer;

constexpr std::size_t kMaxSpokenFrames = 3600u * 48'000u;
constexpr std::size_t kMaxAnswerLines = 100'000;

vm::Error BadAnswer(const std::string& what) {
  return {vm::Errc::kUnavailable, "the helper for espeak-ng answered '" + what + "'", 0};
}

bool TakeLine(const std::string& line, std::vector<std::pair<Millis, std::string>>& starts,
              Answer& answer) {
  std::istringstream words(line);
  std::string kind, name;
  std::int64_t ms = 0;
  if (!(words >> kind >> ms) || ms < 0) return false;
  if (kind == "p" && words >> name) {
    starts.emplace_back(Millis(ms), name == "-" ? "" : name);
    return true;
  }
  Answer::Word word{Millis(ms), 0, 0};
  if (kind != "w" || !(words >> word.character >> word.count)) return false;
  answer.words.push_back(word);
  return true;
}

/// From where phonemes begin to how long they last. The events of one buffer are not in order.
vm::PhonemeList Durations(std::vector<std::pair<Millis, std::string>> starts, Millis end) {
  // (Of those at one instant the order stays; std::stable_sort is deprecated inside for clang.)
  const std::multimap<Millis, std::string> in_order(starts.begin(), starts.end());
  starts.assign(in_order.begin(), in_order.end());
  vm::PhonemeList list;
  if (starts.empty() || starts.front().first.count() > 0) {
    list.push_back({"", starts.empty() ? end : std::min(starts.front().first, end)});
  }
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const Millis next = i + 1 < starts.size() ? std::min(starts[i + 1].first, end) : end;
    if (next > starts[i].first) list.push_back({starts[i].second, next - starts[i].first});
  }
  return list;
}

}  // namespace

vm::Result<EspeakLink::Answer> EspeakLink::Say(const std::string& request,
                                               const std::atomic<bool>& cancelled) {
  for (int attempt = 0;; ++attempt) {
    auto answer = TrySay(request, cancelled);
    if (answer) return answer;
    // What it says itself is no reason to end it.
    if (std::exchange(spoke_, false)) return answer;
    process_.reset();
    // It may have died long ago; a new one gets the same sentence once.
    if (attempt > 0 || answer.error().code != vm::Errc::kUnavailable) return answer;
  }
}

vm::Result<EspeakLink::Answer> EspeakLink::TrySay(const std::string& request,
                                                  const std::atomic<bool>& cancelled) {
  if (!process_) {
    auto started = ChildProcess::Start({options_.helper}, true);
    if (!started) return std::unexpected(started.error());
    process_ = std::move(*started);
  }
  const ChildProcess::Wait wait{ChildProcess::Clock::now() + options_.limit, &cancelled};
  if (auto sent = process_->Write(request, wait); !sent) return std::unexpected(sent.error());
  auto head = process_->ReadLine(wait);
  if (!head) return std::unexpected(head.error());
  if (head->starts_with("error ")) {
    spoke_ = true;
    return vm::Fail(vm::Errc::kUnavailable, "espeak-ng: " + head->substr(6));
  }
  return ReadSound(*head, wait);
}

vm::Result<EspeakLink::Answer> EspeakLink::ReadSound(const std::string& head,
                                                     const ChildProcess::Wait& wait) {
  std::istringstream words(head);
  std::string verb;
  std::size_t frames = 0, lines = 0;
  Answer answer;
  if (!(words >> verb >> answer.rate >> frames >> lines) || verb != "sound" || answer.rate < 1000 ||
      answer.rate > 200'000 || frames > kMaxSpokenFrames || lines > kMaxAnswerLines) {
    return std::unexpected(BadAnswer(head.substr(0, 60)));
  }
  std::vector<std::pair<Millis, std::string>> starts;
  for (; lines > 0; --lines) {
    auto line = process_->ReadLine(wait);
    if (!line) return std::unexpected(line.error());
    if (!TakeLine(*line, starts, answer)) return std::unexpected(BadAnswer(*line));
  }
  auto bytes = process_->ReadBytes(frames * 2, wait);
  if (!bytes) return std::unexpected(bytes.error());
  answer.samples.resize(frames);
  std::memcpy(answer.samples.data(), bytes->data(), bytes->size());
  const Millis end(static_cast<std::int64_t>(frames) * 1000 / answer.rate);
  answer.phonemes = Durations(std::move(starts), end);
  return answer;
}

}  // namespace ssm
