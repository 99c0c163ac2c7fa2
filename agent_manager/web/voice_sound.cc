#include "agent_manager/web/voice_sound.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "agent_manager/routing/own_names.h"

namespace am {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

constexpr const char* kVoice = "SSM";
constexpr const char* kNobody = "NONE";
constexpr double kMaxMs = 1e12;  // as in all lines
constexpr unsigned kMinRateHz = 8000, kMaxRateHz = 192000;

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
  LivePiece piece;              // its time is the voice's
  std::size_t sound_bytes = 0;  // that follow
};

/// "sound MS RATE BYTES" or "end MS".
std::optional<Head> ParseHead(std::string_view line) {
  Head head;
  const std::string_view kind = NextWord(line);
  const auto ms = NumberOf<double>(NextWord(line));
  if (!ms || !std::isfinite(*ms) || std::abs(*ms) > kMaxMs) return std::nullopt;
  head.piece.at = vm::Time(std::llround(*ms * 1000));
  head.piece.kind = LivePiece::Kind::kSilence;
  if (kind == "end" && line.empty()) return head;
  const auto rate = NumberOf<std::uint32_t>(NextWord(line));
  const auto bytes = NumberOf<std::size_t>(NextWord(line));
  const bool fits = rate && *rate >= kMinRateHz && *rate <= kMaxRateHz && bytes &&
                    *bytes <= VoiceSound::kMaxSoundBytes && *bytes % 2 == 0;
  if (kind != "sound" || !fits || !line.empty()) return std::nullopt;
  head.piece.kind = LivePiece::Kind::kSound;
  head.piece.rate_hz = *rate;
  head.sound_bytes = *bytes;
  return head;
}

}  // namespace

struct VoiceSound::Connection {
  explicit Connection(asio::io_context& io) : acceptor(io), socket(io) {}
  PrivateFolder folder;  // of the socket
  asio::local::stream_protocol::acceptor acceptor;
  asio::local::stream_protocol::socket socket;
  std::array<char, 16 * 1024> piece{};
  std::string come;    // and not yet taken
  bool asked = false;  // the voice may be sending
};

VoiceSound::VoiceSound(asio::io_context& io, Hub& hub) : io_(io), hub_(hub) {}
VoiceSound::~VoiceSound() = default;

unsigned VoiceSound::Listen(Audience::Member member) {
  const unsigned number = listeners_.Join(std::move(member));
  if (!connection_) Begin();
  return number;
}

void VoiceSound::Leave(unsigned member) {
  listeners_.Leave(member);
  if (listeners_.empty()) End("");
}

void VoiceSound::Ask(const vm::Message& message, std::function<void(const std::string&)> next) {
  hub_.Ask(own_name::kHub, vm::To(kVoice, message),
           [this, weak = std::weak_ptr(connection_),
            next = std::move(next)](const vm::Result<std::string>& answer) {
             if (weak.expired()) return;  // nobody listens any more
             if (!answer) return End(answer.error().text);
             next(*answer);
           });
}

void VoiceSound::Begin() {
  connection_ = std::make_shared<Connection>(io_);
  Connection& here = *connection_;
  if (!here.folder.Make("voice", "sound")) return End("no folder for the sound");
  error_code error;
  here.acceptor.open(asio::local::stream_protocol(), error);
  if (!error) here.acceptor.bind(here.folder.file(), error);
  if (!error) here.acceptor.listen(1, error);
  if (error) return End("no socket for the sound: " + error.message());
  here.acceptor.async_accept(here.socket,
                             [this, weak = std::weak_ptr(connection_)](const error_code& failed) {
                               if (weak.expired() || failed) return;
                               Read();
                             });
  Ask(vm::Inq("Sound.to"), [this](const std::string& to) {
    if (to != kNobody) return End("the voice's sound goes to " + to);
    connection_->asked = true;
    Ask(vm::Set("Sound.to", "unix:" + connection_->folder.file()), [](const std::string&) {});
  });
}

void VoiceSound::Read() {
  connection_->socket.async_read_some(
      asio::buffer(connection_->piece),
      [this, weak = std::weak_ptr(connection_)](const error_code& error, std::size_t size) {
        const auto here = weak.lock();
        if (!here) return;
        if (error) return End("the voice sends no more");
        here->come.append(here->piece.data(), size);
        if (const auto taken = TakeRecords(); !taken) return End(taken.error().text);
        if (connection_ == here) Read();  // a listener may have been the last one and left
      });
}

vm::Result<void> VoiceSound::TakeRecords() {
  const auto here = connection_;
  std::string_view rest = here->come;
  while (connection_ == here) {
    const std::size_t line = rest.substr(0, kMaxHeadBytes).find('\n');
    if (line == std::string_view::npos) {
      if (rest.size() < kMaxHeadBytes) break;
      return vm::Fail(vm::Errc::kTooLong, "the voice sent a record whose head has no end");
    }
    auto head = ParseHead(rest.substr(0, line));
    if (!head) {
      return vm::Fail(vm::Errc::kSyntax, "the voice sent '" + std::string(rest.substr(0, line)) +
                                             "', expected sound MS RATE BYTES or end MS");
    }
    if (rest.size() - line - 1 < head->sound_bytes) break;
    head->piece.bytes = rest.substr(line + 1, head->sound_bytes);
    head->piece.at -= hub_.clocks().ClockOf(kVoice).offset;
    rest.remove_prefix(line + 1 + head->sound_bytes);
    listeners_.Tell(std::make_shared<const LivePiece>(std::move(head->piece)));
  }
  here->come.erase(0, here->come.size() - rest.size());
  return {};
}

void VoiceSound::End(const std::string& why) {
  if (const auto here = std::exchange(connection_, nullptr);
      here && here->asked && hub_.directory().IsPresent(kVoice)) {
    hub_.Ask(own_name::kHub, vm::To(kVoice, vm::Set("Sound.to", kNobody)), IgnoreAnswer);
  }
  listeners_.End(why);
}

}  // namespace am
