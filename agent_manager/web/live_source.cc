#include "agent_manager/web/live_source.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <utility>
#include <vector>

#include "agent_manager/routing/own_names.h"

namespace am {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

constexpr const char* kNobody = "NONE";
constexpr std::size_t kReadBytes = 64u * 1024;

vm::Error Unavailable(std::string why) { return {vm::Errc::kUnavailable, std::move(why), 0}; }

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
  Connection(asio::io_context& io, const Origin& origin)
      : acceptor(io),
        socket(io),
        piece(kReadBytes),
        records(origin.who, origin.records, origin.max_bytes) {}
  vm::PrivateFolder folder;  // of the socket
  asio::local::stream_protocol::acceptor acceptor;
  asio::local::stream_protocol::socket socket;
  std::vector<char> piece;
  vm::LiveRecords records;
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
  if (members_.empty()) End({});
}

void LiveSource::Ask(const vm::Message& message, std::function<void(const std::string&)> next) {
  hub_.Ask(own_name::kHub, vm::To(origin_.module, message),
           [this, weak = std::weak_ptr(connection_),
            next = std::move(next)](const vm::Result<std::string>& answer) {
             if (weak.expired()) return;  // nobody follows any more
             if (!answer) return End(answer.error());
             next(*answer);
           });
}

void LiveSource::Begin() {
  connection_ = std::make_shared<Connection>(io_, origin_);
  Connection& here = *connection_;
  if (!here.folder.Make("live", "socket")) return End(Unavailable("no folder for a socket"));
  error_code error;
  here.acceptor.open(asio::local::stream_protocol(), error);
  if (!error) here.acceptor.bind(here.folder.file(), error);
  if (!error) here.acceptor.listen(1, error);
  if (error) return End(Unavailable("no socket: " + error.message()));
  here.acceptor.async_accept(here.socket,
                             [this, weak = std::weak_ptr(connection_)](const error_code& failed) {
                               if (weak.expired() || failed) return;
                               Read();
                             });
  Ask(vm::Inq(origin_.slot), [this](const std::string& to) {
    if (to != kNobody)
      return End(
          vm::Error{vm::Errc::kBusy, std::string(origin_.who) + " sends to " + to + " already", 0});
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
        if (error) return End(Unavailable(std::string(origin_.who) + " sends no more"));
        here->records.Add({here->piece.data(), size});
        if (const auto taken = TakeRecords(); !taken) return End(taken.error());
        if (connection_ == here) Read();  // who follows may have been the last one and left
      });
}

vm::Result<void> LiveSource::TakeRecords() {
  const auto here = connection_;
  while (connection_ == here) {
    auto piece = here->records.Next();
    if (!piece) return std::unexpected(piece.error());
    if (!*piece) break;
    (*piece)->at -= hub_.clocks().ClockOf(origin_.module).offset;
    members_.Tell(std::make_shared<const LivePiece>(std::move(**piece)));
  }
  return {};
}

void LiveSource::End(const std::optional<vm::Error>& why) {
  if (const auto here = std::exchange(connection_, nullptr);
      here && here->asked && hub_.directory().IsPresent(origin_.module)) {
    hub_.Ask(own_name::kHub, vm::To(origin_.module, vm::Set(origin_.slot, kNobody)), IgnoreAnswer);
  }
  members_.End(why ? vm::FormatError(*why) : "");
}

}  // namespace am
