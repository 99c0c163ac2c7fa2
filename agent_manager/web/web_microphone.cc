// A browser's microphone as the ear's input: receives samples (16 bit, one channel, little-endian,
// kRate a second) from a WebSocket and passes them to @SRM over a Unix socket.

#include <algorithm>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/write.hpp>
#include <utility>

#include "agent_manager/routing/own_names.h"
#include "agent_manager/web/web_impl.h"
#include "vm_protocol/runtime/private_folder.h"
#include "vm_protocol/web/web_socket.h"

namespace am::web {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

constexpr int kRate = 16000;
constexpr std::size_t kMaxSoundBytes = 64u * 1024;
// Of sound that waits, so much is kept and the rest dropped: 20 s while the ear makes itself ready,
// which may have to load its models first, and 2 s once it takes sound.
constexpr std::size_t kMaxKeptSoundBytes = 20 * 2 * kRate;
constexpr std::size_t kMaxWaitingSoundBytes = 2 * 2 * kRate;
/// What the browser is told once the ear takes sound.
constexpr std::string_view kReady = "READY";
constexpr const char* kEar = "SRM";

/// One browser's microphone. Sets the ear's Input to a socket and restores the old value at the
/// end. Lifetime: kept alive by its pending operations. Thread: the context's. Limits:
/// kMaxSoundBytes a message, kMaxKeptSoundBytes and kMaxWaitingSoundBytes.
/// Errors: closes the WebSocket with the reason, a code and a text, and reports it.
class MicrophoneSession : public std::enable_shared_from_this<MicrophoneSession> {
 public:
  MicrophoneSession(std::shared_ptr<WebServer::Impl> server, boost::beast::tcp_stream stream)
      : server_(std::move(server)),
        place_(*server_->door),
        socket_(std::move(stream), {.message_bytes = kMaxSoundBytes}),
        ear_(server_->io) {
    server_->microphone = true;
  }

  void Start(const Request& request) {
    socket_.Accept(request, "", [self = shared_from_this()](const error_code& error) {
      if (error) return self->End();
      self->Read();  // from now on, so that it is seen to go while the ear is still being asked
      self->AskEar();
    });
  }

 private:
  void Ask(const vm::Message& message, std::function<void(const vm::Result<std::string>&)> next) {
    server_->hub.Ask(
        own_name::kHub, vm::To(kEar, message),
        [self = shared_from_this(), next = std::move(next)](const vm::Result<std::string>& answer) {
          if (!self->server_->closed && !self->ended_) next(answer);
        });
  }

  void AskEar() {
    if (!folder_.Make("ear", "sound")) return Refuse(Unavailable("no folder for the sound"));
    Ask(vm::Inq("Input"), [this](const vm::Result<std::string>& input) {
      if (!input) return Refuse(input.error());
      before_ = *input;
      Ask(vm::Set("Input", "unix@" + std::to_string(kRate) + ":" + folder_.file()),
          [this](const vm::Result<std::string>& set) {
            if (!set) return Refuse(set.error());
            ear_.async_connect(folder_.file(), [self =
                                                    shared_from_this()](const error_code& error) {
              if (self->ended_) return;
              if (error)
                return self->Refuse(Unavailable("the ear does not take sound: " + error.message()));
              self->connected_ = true;
              self->socket_.Write("", kReady, false, [self](const error_code&) {});
              self->Write();
            });
          });
    });
  }

  static vm::Error Unavailable(std::string why) {
    return {vm::Errc::kUnavailable, std::move(why), 0};
  }
  void Refuse(const vm::Error& why) {
    server_->on_refusal("no microphone: " + why.text);
    socket_.Close(vm::FormatError(why),
                  [self = shared_from_this()](const error_code&) { self->End(); });
  }

  void Read() {
    socket_.Read([self = shared_from_this()](const error_code& error, const std::string& samples,
                                             bool binary) {
      if (error || self->server_->closed) return self->End();
      const std::size_t most = self->connected_ ? kMaxWaitingSoundBytes : kMaxKeptSoundBytes;
      if (binary && self->waiting_.size() + samples.size() <= most) self->waiting_ += samples;
      self->Write();
      self->Read();
    });
  }

  void Write() {
    if (!connected_ || writing_ || waiting_.empty()) return;
    writing_ = true;
    going_ = std::exchange(waiting_, {});
    asio::async_write(ear_, asio::buffer(going_),
                      [self = shared_from_this()](const error_code& error, std::size_t) {
                        self->writing_ = false;
                        if (error) return self->End();
                        self->Write();
                      });
  }

  void End() {
    if (std::exchange(ended_, true)) return;
    server_->microphone = false;  // another may come while the ear still owes us an answer
    error_code ignored;
    ear_.close(ignored);
    socket_.Cut();
    if (before_.empty() || server_->closed || !server_->hub.directory().IsPresent(kEar)) return;
    Ask(vm::Set("Input", before_), IgnoreAnswer);
  }

  std::shared_ptr<WebServer::Impl> server_;
  const vm::WebDoor::Place place_;
  vm::WebSocket socket_;
  asio::local::stream_protocol::socket ear_;
  vm::PrivateFolder folder_;  // of the socket
  std::string before_, waiting_, going_;
  bool connected_ = false, writing_ = false, ended_ = false;
};

}  // namespace

void ServeMicrophone(std::shared_ptr<WebServer::Impl> server, boost::beast::tcp_stream stream,
                     const Request& request) {
  std::make_shared<MicrophoneSession>(std::move(server), std::move(stream))->Start(request);
}

}  // namespace am::web
