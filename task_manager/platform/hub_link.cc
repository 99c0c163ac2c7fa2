#include "task_manager/platform/hub_link.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <stdexcept>
#include <utility>

#include "vm_protocol/runtime/endpoint.h"

namespace vxml {
namespace {

int Connect(const std::string& text) {
  auto endpoint = vm::ParseEndpoint(text);
  if (!endpoint) throw std::runtime_error("--connect: " + endpoint.error().text);
  if (endpoint->kind == vm::Endpoint::Kind::kTls) {
    throw std::runtime_error("--connect " + text +
                             ": unix:PATH or tcp:HOST:PORT expected; over TLS, join a hub here that "
                             "calls the other");
  }
  boost::asio::io_context io;
  vm::Result<int> connected = vm::Fail(vm::Errc::kUnavailable, "no answer");
  vm::ConnectTo(io, *endpoint, [&](vm::Result<int> fd) { connected = std::move(fd); });
  io.run();
  if (!connected) throw std::runtime_error("--connect " + text + ": " + connected.error().text);
  return *connected;
}

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

HubLink::HubLink(const std::string& endpoint, const std::string& name, bool keyboard)
    : fd_(Connect(endpoint)), keyboard_(keyboard) {
  client_ =
      std::make_unique<vm::Client>([this](std::string_view line) { Send(std::string(line)); });
  auto named = Ask("to @AM set Name = " + name, Millis(5000));
  if (!named)
    throw std::runtime_error("the hub refuses the name " + name + ": " + named.error().text);
}

HubLink::~HubLink() {
  if (fd_ >= 0) ::close(fd_);
}

void HubLink::Send(const std::string& line) {
  held_ += line + "\n";
  if (!holding_) Release();
}

void HubLink::Release() {
  holding_ = false;
  const std::string whole = std::exchange(held_, "");
  std::string_view left = whole;
  while (!left.empty() && !gone_) {
    const ssize_t n = ::send(fd_, left.data(), left.size(), MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      pollfd wait{fd_, POLLOUT, 0};
      ::poll(&wait, 1, 1000);
      continue;
    }
    if (n < 0) {
      gone_ = true;
      return;
    }
    left.remove_prefix(static_cast<std::size_t>(n));
  }
}

vm::Result<std::string> HubLink::Ask(const std::string& line, Millis limit) {
  auto message = vm::ParseMessage(line);
  if (!message) return std::unexpected(message.error());
  std::optional<vm::Result<std::string>> answer;
  const std::string tag = client_->Request(
      *message, [&answer](vm::Result<std::string> value) { answer = std::move(value); });
  if (!WaitFor([&] { return answer.has_value(); }, limit)) {
    client_->Abandon(tag, {vm::Errc::kTimeout, "no answer to: " + line, 0});
  }
  if (!answer) return vm::Fail(vm::Errc::kUnavailable, "the hub is gone");
  return *answer;
}

bool HubLink::WaitFor(const std::function<bool()>& done, std::optional<Millis> limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit.value_or(Millis(0));
  while (!done()) {
    if (gone_) return false;
    int timeout = 1000;
    if (limit) {
      const auto left = std::chrono::ceil<Millis>(deadline - std::chrono::steady_clock::now());
      if (left.count() <= 0) return false;
      timeout = static_cast<int>(std::min<long long>(left.count(), 1000));
    }
    Pump(timeout);
  }
  return true;
}

bool HubLink::Pump(int timeout_ms) {
  Release();
  std::array<pollfd, 2> wait{{{fd_, POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}}};
  const nfds_t count = keyboard_ && !typed_end_ ? 2 : 1;
  if (::poll(wait.data(), count, timeout_ms) <= 0) return false;
  std::array<char, 65536> bytes{};
  if (count == 2 && wait[1].revents != 0) {
    const ssize_t n = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    if (n <= 0) typed_end_ = true;
    if (n > 0) typed_.append(bytes.data(), static_cast<std::size_t>(n));
    while (auto line = TakeLine(typed_)) {
      if (on_typed) on_typed(*line);
    }
  }
  if (wait[0].revents != 0) {
    const ssize_t n = ::recv(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) gone_ = true;
    if (n > 0) input_.append(bytes.data(), static_cast<std::size_t>(n));
    while (auto line = TakeLine(input_)) client_->HandleLine(*line);
  }
  return true;
}

}  // namespace vxml
