#include "chat/model/model_request.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "vm_protocol/core/utf8.h"
#include "vm_protocol/http/answer.h"

namespace chat {
namespace {

using std::chrono::milliseconds;
using vm::Errc;

constexpr std::size_t kMaxErrorBody = 8 << 10;
constexpr milliseconds kUsualWait{5000};       // after 429 without a number of seconds
constexpr milliseconds kLongestWait{600'000};  // whatever Retry-After says

std::string Seconds(milliseconds time) {
  const auto tenths = time.count() / 100;
  const std::string whole = std::to_string(tenths / 10);
  return (tenths % 10 == 0 ? whole : whole + "." + std::to_string(tenths % 10)) + " s";
}

milliseconds RetryAfter(const vm::HttpHead& head) {
  const auto found = head.headers.find("retry-after");
  if (found == head.headers.end()) return kUsualWait;
  const std::string& text = found->second;
  double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc() || end != text.data() + text.size() || !(seconds >= 0))
    return kUsualWait;
  const double most = static_cast<double>(kLongestWait.count()) / 1000;
  return milliseconds(static_cast<long long>(std::min(seconds, most) * 1000));
}

}  // namespace

ModelRequest::ModelRequest(vm::Scheduler& clock, vm::HttpTransport& transport,
                           vm::HttpRequest request, const std::string& key, ModelLimits limits,
                           Events events)
    : clock_(clock), url_(request.url), key_(key), limits_(limits), events_(std::move(events)) {
  whole_timer_ = clock_.After(limits_.whole, [this] {
    whole_timer_ = 0;
    Fail(Trouble::kLate, Errc::kTimeout,
         "the answer took longer than " + Seconds(limits_.whole) + " (Model.seconds)");
  });
  WaitForMore();
  exchange_ = transport.Post(std::move(request),
                             {.on_head = [this](const vm::HttpHead& head) { OnHead(head); },
                              .on_data = [this](std::string_view bytes) { OnData(bytes); },
                              .on_end = [this](const vm::Result<void>& end) { OnEnd(end); }});
}

ModelRequest::~ModelRequest() {
  exchange_.reset();
  clock_.Cancel(stall_timer_);
  clock_.Cancel(whole_timer_);
}

void ModelRequest::WaitForMore() {
  clock_.Cancel(stall_timer_);
  stall_timer_ = clock_.After(limits_.stall, [this] {
    stall_timer_ = 0;
    Fail(Trouble::kLate, Errc::kTimeout,
         "nothing has come for " + Seconds(limits_.stall) + " (Model.stall)");
  });
}

void ModelRequest::Fail(Trouble trouble, Errc code, std::string text, milliseconds wait) {
  Finish(std::unexpected(
      ModelFailure{.trouble = trouble,
                   .error = {code, url_ + ": " + vm::WithoutSecret(std::move(text), key_), 0},
                   .wait = wait}));
}

void ModelRequest::Finish(std::expected<std::vector<ToolCall>, ModelFailure> end) {
  if (std::exchange(ended_, true)) return;
  clock_.Cancel(std::exchange(stall_timer_, 0));
  clock_.Cancel(std::exchange(whole_timer_, 0));
  if (end && !end->empty() && !std::exchange(began_, true)) events_.began();
  events_.end(std::move(end));
}

void ModelRequest::OnHead(const vm::HttpHead& head) {
  if (ended_) return;
  head_ = head;
  WaitForMore();
  if (head.status != 200) return;
  const auto type = head.headers.find("content-type");
  const bool one_piece = type != head.headers.end() && type->second.starts_with("application/json");
  reader_.emplace(!one_piece);
}

void ModelRequest::OnData(std::string_view bytes) {
  if (ended_) return;
  WaitForMore();
  if (!reader_) {
    error_body_ += bytes.substr(0, kMaxErrorBody - std::min(kMaxErrorBody, error_body_.size()));
    return;
  }
  std::string words;
  const auto read = reader_->Feed(bytes, words);
  Give(words);
  if (ended_) return;
  if (!read) {
    const Trouble trouble = read.error().code == Errc::kTooLong ? Trouble::kLong : Trouble::kBroken;
    return Fail(trouble, read.error().code, read.error().text);
  }
  if (reader_->complete()) OnEnd({});  // some servers keep the connection open behind [DONE]
}

void ModelRequest::Give(const std::string& words) {
  const bool blank = words.find_first_not_of(" \t\r\n") == std::string::npos;
  if (words.empty() || (blank && !began_)) return;
  if (!std::exchange(began_, true)) events_.began();
  const std::size_t room = limits_.reply_bytes - given_;
  const std::string_view part = vm::CutUtf8(words, room);
  given_ += part.size();
  if (!part.empty()) events_.words(std::string(part));
  if (part.size() < words.size()) {
    Fail(
        Trouble::kLong, Errc::kTooLong,
        "the answer has more than " + std::to_string(limits_.reply_bytes) + " bytes (Model.bytes)");
  }
}

void ModelRequest::FailByStatus() {
  const vm::Error error = vm::StatusError(*head_, error_body_);
  if (error.code == Errc::kBusy) {
    const milliseconds wait = RetryAfter(*head_);
    return Fail(Trouble::kBusy, error.code, error.text + "; nothing is sent for " + Seconds(wait),
                wait);
  }
  const bool refused = head_->status >= 400 && head_->status < 500;
  Fail(refused ? Trouble::kRefused : Trouble::kAway, error.code, error.text);
}

void ModelRequest::OnEnd(const vm::Result<void>& end) {
  if (ended_) return;
  if (!end) {
    const Errc code = end.error().code;
    const Trouble trouble = code == Errc::kTimeout   ? Trouble::kLate
                            : code == Errc::kTooLong ? Trouble::kLong
                            : reader_                ? Trouble::kBroken
                                                     : Trouble::kAway;
    return Fail(trouble, code, end.error().text);
  }
  if (!head_) return Fail(Trouble::kAway, Errc::kUnavailable, "it has said nothing");
  if (!reader_) return FailByStatus();
  std::string words;
  const auto read = reader_->End(words);
  Give(words);
  if (ended_) return;
  if (!read) return Fail(Trouble::kBroken, read.error().code, read.error().text);
  Finish(reader_->tool_calls());
}

}  // namespace chat
