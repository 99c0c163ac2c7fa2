#include "agent_manager/web/live_source.h"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "agent_manager/routing/own_names.h"

namespace am {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

constexpr const char* kNobody = "NONE";
constexpr double kMaxMs = 1e12;  // as in all lines
constexpr unsigned kMinRateHz = 8000, kMaxRateHz = 192000;
constexpr std::size_t kReadBytes = 64u * 1024;

template <typename Number>
std::optional<Number> NumberOf(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::string_view NextWord(std::string_view& text) {
  const std::size_t end = std::min(text.find(' '), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return word;
}

struct Head {
  LivePiece piece;        // its time is the module's
  std::size_t bytes = 0;  // that follow
};

/// "picture MS BYTES", "sound MS RATE BYTES" or "end MS".
std::optional<Head> ParseHead(std::string_view line, std::size_t max_bytes) {
  Head head;
  const std::string_view kind = NextWord(line);
  const auto ms = NumberOf<double>(NextWord(line));
  if (!ms || !std::isfinite(*ms) || std::abs(*ms) > kMaxMs) return std::nullopt;
  head.piece.at = vm::Time(std::llround(*ms * 1000));
  head.piece.kind = LivePiece::Kind::kSilence;
  if (kind == "end" && line.empty()) return head;
  if (kind == "sound") {
    const auto rate = NumberOf<std::uint32_t>(NextWord(line));
    if (!rate || *rate < kMinRateHz || *rate > kMaxRateHz) return std::nullopt;
    head.piece.kind = LivePiece::Kind::kSound;
    head.piece.rate_hz = *rate;
  } else if (kind == "picture") {
    head.piece.kind = LivePiece::Kind::kPicture;
  } else {
    return std::nullopt;
  }
  const auto bytes = NumberOf<std::size_t>(NextWord(line));
  if (!bytes || *bytes > max_bytes || !line.empty()) return std::nullopt;
  if (kind == "sound" && *bytes % 2 != 0) return std::nullopt;
  head.bytes = *bytes;
  return head;
}

}  // namespace

const LiveSource::Origin LiveSource::kFace{.module = "FSM",
                                           .slot = "Picture.to",
                                           .who = "the face",
                                           .records = "picture MS BYTES",
                                           .max_bytes = 8u * 1024 * 1024};
const LiveSource::Origin LiveSource::kVoice{.module = "SSM",
                                            .slot = "Sound.to",
                                            .who = "the voice",
                                            .records = "sound MS RATE BYTES or end MS",
                                            .max_bytes = 64u * 1024};

struct LiveSource::Connection {
  explicit Connection(asio::io_context& io) : acceptor(io), socket(io), piece(kReadBytes) {}
  PrivateFolder folder;  // of the socket
  asio::local::stream_protocol::acceptor acceptor;
  asio::local::stream_protocol::socket socket;
  std::vector<char> piece;
  std::string come;    // and not yet taken
  bool asked = false;  // the module may be sending
};

LiveSource::LiveSource(asio::io_context& io, Hub& hub, const Origin& origin)
    : io_(io), hub_(hub), origin_(origin) {}
LiveSource::~LiveSource() = default;

unsigned LiveSource::Join(Audience::Member member) {
  const unsigned number = members_.Join(std::move(member));
  if (!connection_) Begin();
  return number;
}

void LiveSource::Leave(unsigned member) {
  members_.Leave(member);
  if (members_.empty()) End("");
}

void LiveSource::Ask(const vm::Message& message, std::function<void(const std::string&)> next) {
  hub_.Ask(own_name::kHub, vm::To(origin_.module, message),
           [this, weak = std::weak_ptr(connection_),
            next = std::move(next)](const vm::Result<std::string>& answer) {
             if (weak.expired()) return;  // nobody follows any more
             if (!answer) return End(answer.error().text);
             next(*answer);
           });
}

void LiveSource::Begin() {
  connection_ = std::make_shared<Connection>(io_);
  Connection& here = *connection_;
  if (!here.folder.Make("live", "socket")) return End("no folder for a socket");
  error_code error;
  here.acceptor.open(asio::local::stream_protocol(), error);
  if (!error) here.acceptor.bind(here.folder.file(), error);
  if (!error) here.acceptor.listen(1, error);
  if (error) return End("no socket: " + error.message());
  here.acceptor.async_accept(here.socket,
                             [this, weak = std::weak_ptr(connection_)](const error_code& failed) {
                               if (weak.expired() || failed) return;
                               Read();
                             });
  Ask(vm::Inq(origin_.slot), [this](const std::string& to) {
    if (to != kNobody) return End(std::string(origin_.who) + " sends to " + to + " already");
    connection_->asked = true;
    Ask(vm::Set(origin_.slot, "unix:" + connection_->folder.file()), [](const std::string&) {});
  });
}

void LiveSource::Read() {
  connection_->socket.async_read_some(
      asio::buffer(connection_->piece),
      [this, weak = std::weak_ptr(connection_)](const error_code& error, std::size_t size) {
        const auto here = weak.lock();
        if (!here) return;
        if (error) return End(std::string(origin_.who) + " sends no more");
        here->come.append(here->piece.data(), size);
        if (const auto taken = TakeRecords(); !taken) return End(taken.error().text);
        if (connection_ == here) Read();  // who follows may have been the last one and left
      });
}

vm::Result<void> LiveSource::TakeRecords() {
  const auto here = connection_;
  std::string_view rest = here->come;
  while (connection_ == here) {
    const std::size_t line = rest.substr(0, kMaxHeadBytes).find('\n');
    if (line == std::string_view::npos) {
      if (rest.size() < kMaxHeadBytes) break;
      return vm::Fail(vm::Errc::kTooLong,
                      std::string(origin_.who) + " sent a record whose head has no end");
    }
    auto head = ParseHead(rest.substr(0, line), origin_.max_bytes);
    if (!head) {
      return vm::Fail(vm::Errc::kSyntax, std::string(origin_.who) + " sent '" +
                                             std::string(rest.substr(0, line)) + "', expected " +
                                             origin_.records);
    }
    if (rest.size() - line - 1 < head->bytes) break;
    head->piece.bytes = rest.substr(line + 1, head->bytes);
    head->piece.at -= hub_.clocks().ClockOf(origin_.module).offset;
    rest.remove_prefix(line + 1 + head->bytes);
    members_.Tell(std::make_shared<const LivePiece>(std::move(head->piece)));
  }
  here->come.erase(0, here->come.size() - rest.size());
  return {};
}

void LiveSource::End(const std::string& why) {
  if (const auto here = std::exchange(connection_, nullptr);
      here && here->asked && hub_.directory().IsPresent(origin_.module)) {
    hub_.Ask(own_name::kHub, vm::To(origin_.module, vm::Set(origin_.slot, kNobody)), IgnoreAnswer);
  }
  members_.End(why);
}

}  // namespace am
