#include "task_manager/platform/hub_link.h"

#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "vm_protocol/runtime/acceptor.h"
#include "vm_protocol/runtime/endpoint.h"

namespace vxml {
namespace {

constexpr Millis kLongestWait{1000};  ///< of one look for news
constexpr Millis kFlushLimit{1000};

/// Takes the next whole line out of a buffer.
std::optional<std::string> TakeLine(std::string& buffer) {
  const std::size_t end = buffer.find('\n');
  if (end == std::string::npos) return {};
  std::string line = buffer.substr(0, end);
  if (line.ends_with("\r")) line.pop_back();
  buffer.erase(0, end + 1);
  return line;
}

}  // namespace

struct HubLink::Channel {
  explicit Channel(const HubAddress& hub) {
    const auto endpoint = vm::ParseEndpoint(hub.endpoint);
    if (!endpoint) throw std::runtime_error("--connect: " + endpoint.error().text);
    std::optional<vm::Result<std::shared_ptr<vm::StreamPeer>>> called;
    vm::Connect(io, *endpoint, hub.credentials, vm::Framing::kLf, vm::Encoding::kUtf8,
                [&called](vm::Result<std::shared_ptr<vm::StreamPeer>> given) {
                  called = std::move(given);
                });
    while (!called && io.run_one() > 0) {
    }
    if (!called || !*called) {
      throw std::runtime_error("--connect " + hub.endpoint + ": " +
                               (called ? called->error().text : "no answer"));
    }
    stream = std::move(**called);
  }

  boost::asio::io_context io;
  std::shared_ptr<vm::StreamPeer> stream;
  boost::asio::posix::stream_descriptor keys{io};
};

HubLink::HubLink(const HubAddress& hub, const std::string& name, bool keyboard)
    : name_(name), keyboard_(keyboard), channel_(std::make_unique<Channel>(hub)) {
  client_ =
      std::make_unique<vm::Client>([this](std::string_view line) { Send(std::string(line)); });
  channel_->stream->Start(
      [this](vm::Result<std::string_view> line) {
        if (line && listening_) OnLine(*line);
      },
      [this](const vm::StreamEnd&) { gone_ = true; });
  channel_->stream->ResumeReading();
  if (keyboard_) WaitForKeys();
  auto named = Ask("to @AM set Name = " + name, Millis(5000));
  if (!named)
    throw std::runtime_error("the hub refuses the name " + name + ": " + named.error().text);
}

HubLink::~HubLink() {
  if (!gone_) Flush();
  channel_->stream->Close();
  channel_->io.restart();
  channel_->io.poll();  // lets go of the callbacks that hold us
}

void HubLink::Send(const std::string& line) { channel_->stream->Send(line); }

void HubLink::StopListening() {
  listening_ = false;
  on_typed = nullptr;
}

void HubLink::Flush() {
  const auto done = std::make_shared<bool>(false);  // outlives a wait that is given up
  channel_->stream->Flush([done] { *done = true; });
  WaitFor([&] { return *done; }, kFlushLimit);
}

vm::Result<std::string> HubLink::Ask(const std::string& line, Millis limit) {
  auto message = vm::ParseMessage(line);
  if (!message) return std::unexpected(message.error());
  std::optional<vm::Result<std::string>> answer;
  const std::string tag = client_->Request(
      *message, [&answer](vm::Result<std::string> value) { answer = std::move(value); });
  if (!WaitFor([&] { return answer.has_value(); }, limit)) {
    client_->Abandon(tag, gone_ ? vm::Error{vm::Errc::kUnavailable, "the hub is gone", 0}
                                : vm::Error{vm::Errc::kTimeout, "no answer to: " + line, 0});
  }
  return *answer;
}

bool HubLink::WaitFor(const std::function<bool()>& done, std::optional<Millis> limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit.value_or(Millis(0));
  while (!done()) {
    if (gone_) return false;
    Millis wait = kLongestWait;
    if (limit) {
      const auto left = std::chrono::ceil<Millis>(deadline - std::chrono::steady_clock::now());
      if (left.count() <= 0) return false;
      wait = std::min(left, wait);
    }
    Pump(wait);
  }
  return true;
}

void HubLink::Pump(Millis limit) {
  if (channel_->io.stopped()) channel_->io.restart();
  channel_->io.run_one_for(limit);
}

/// A file cannot be waited for and never has to be.
void HubLink::WaitForKeys() {
  if (waits_for_keys_ || typed_lines_.size() >= kMostTyped) return;
  if (!channel_->keys.is_open()) {
    struct stat about {};
    keys_from_file_ = ::fstat(STDIN_FILENO, &about) == 0 && S_ISREG(about.st_mode);
    if (keys_from_file_) return;
    channel_->keys.assign(::dup(STDIN_FILENO));
  }
  waits_for_keys_ = true;
  channel_->keys.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                            [this](const boost::system::error_code& error) {
                              waits_for_keys_ = false;
                              const std::size_t waiting = typed_lines_.size();
                              // /dev/null cannot be waited for: nobody types.
                              const bool more = !error && ReadTyped();
                              while (cut_in_ == CutIn::kAll && typed_lines_.size() > waiting)
                                HandOver(waiting);
                              if (cut_in_ == CutIn::kNext && waiting == 0) TakeTyped();
                              if (more) WaitForKeys();
                            });
}

bool HubLink::ReadTyped() {
  std::array<char, 65536> bytes{};
  const ssize_t n = ::read(STDIN_FILENO, bytes.data(), bytes.size());
  if (n > 0) {
    if (typed_.size() > kMostTypedBytes) typed_.clear();  // a line that nobody types
    typed_.append(bytes.data(), static_cast<std::size_t>(n));
    typed_any_ = true;
  } else {
    typed_end_ = typed_any_ || keys_from_file_ || ::isatty(STDIN_FILENO) == 1;
    if (!typed_.empty()) typed_ += '\n';  // the last line may have no end
  }
  while (auto line = TakeLine(typed_)) typed_lines_.push_back(std::move(*line));
  return n > 0;
}

bool HubLink::HandOver(std::size_t index) {
  const std::string line = std::move(typed_lines_[index]);
  typed_lines_.erase(typed_lines_.begin() + static_cast<std::ptrdiff_t>(index));
  return on_typed && on_typed(line);
}

void HubLink::TakeTyped() {
  bool taken = false;
  while (!taken && (!typed_lines_.empty() || (keys_from_file_ && !typed_end_))) {
    if (typed_lines_.empty()) {
      ReadTyped();
    } else {
      taken = HandOver(0);
    }
  }
  if (taken && cut_in_ == CutIn::kNext) cut_in_ = CutIn::kNone;
  while (cut_in_ == CutIn::kAll && !typed_lines_.empty() && typed_lines_[0].starts_with('/')) {
    HandOver(0);
  }
  if (keyboard_ && channel_->keys.is_open() && !typed_end_) WaitForKeys();
}

bool HubLink::WatchTime() {
  if (!Ask("to @AM set Flow = ON", Millis(5000))) return false;
  if (!hub_time_) hub_time_ = Millis(0);
  return true;
}

/// "# flow MS<tab>..." says when what comes next was said.
void HubLink::OnLine(std::string_view line) {
  constexpr std::string_view kFlow = "# flow ";
  if (!line.starts_with(kFlow)) return client_->HandleLine(line);
  double ms = 0;
  const char* const end = line.data() + line.size();
  if (std::from_chars(line.data() + kFlow.size(), end, ms).ec == std::errc()) {
    hub_time_ = Millis(std::llround(ms));
  }
}

}  // namespace vxml
