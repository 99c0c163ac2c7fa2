// One client's WebSocket: sound in, weights and pictures out.

#include <boost/asio/post.hpp>
#include <deque>
#include <nlohmann/json.hpp>
#include <utility>

#include "gateway/face/face_messages.h"
#include "gateway/web/gateway_impl.h"
#include "vm_protocol/web/web_socket.h"

namespace gateway {
namespace {

namespace asio = boost::asio;

constexpr std::size_t kMaxMessageBytes = 1u << 20;
constexpr std::size_t kPieceBytes = 32u << 10;  // worked on in one turn of the loop
constexpr std::size_t kMaxBacklog = 4u << 20;   // of one client; beyond, its sound is not read
constexpr auto kWriteLimit = std::chrono::seconds(10);

/// Lifetime: kept alive by its pending operations. Thread: the context's. Limits: kMaxMessageBytes
/// a message; while more than kMaxBacklog is not taken, nothing is read; a message that is not
/// taken for kWriteLimit ends the connection. Errors: a message that is none is answered.
class MouthSession : public std::enable_shared_from_this<MouthSession> {
 public:
  MouthSession(std::shared_ptr<GatewayServer::Impl> server, boost::beast::tcp_stream stream,
               MouthWish wish)
      : server_(std::move(server)),
        socket_(std::move(stream), {.message_bytes = kMaxMessageBytes, .write = kWriteLimit}),
        wish_(std::move(wish)),
        face_(server_->net, wish_.live) {
    ++server_->clients;
    if (wish_.pictures) ++server_->faces;
  }
  ~MouthSession() {
    --server_->clients;
    if (wish_.pictures) --server_->faces;
  }
  MouthSession(const MouthSession&) = delete;

  void Start(const vm::WebRequest& request) {
    socket_.Accept(request, "", [self = shared_from_this()](const Error& error) {
      if (error) return;
      self->Send(ReadyText(self->face_, self->PicturesReady()));
      self->StartPictures();
      self->Read();
    });
  }

 private:
  using Error = vm::WebSocket::Error;
  nlohmann::json PicturesReady() const {
    if (!wish_.pictures) return nlohmann::json::object();
    return {{"pictures",
             {{"width", wish_.pictures->width},
              {"height", wish_.pictures->height},
              {"fps", wish_.pictures->fps}}}};
  }

  /// A face that fails is told once; the weights go on.
  void StartPictures() {
    if (!wish_.pictures) return;
    const auto act = [weak = weak_from_this()](auto what) {
      if (const auto self = weak.lock()) what(*self);
    };
    auto started = FacePictures::Start(
        server_->io, server_->options.face_command, *wish_.pictures,
        {.picture =
             [act](std::uint32_t sound, double at_s, const std::string& jpeg) {
               act([&](MouthSession& self) { self.SendPicture(sound, at_s, jpeg); });
             },
         .caught_up = [act] { act([](MouthSession& self) { self.Read(); }); },
         .failed =
             [act](const std::string& why) {
               act([&](MouthSession& self) {
                 self.Send(ErrorText(why));
                 self.Read();
               });
             }});
    if (!started) return Send(ErrorText(started.error().text));
    pictures_ = std::move(*started);
  }

  /// A slow client gets fewer pictures.
  void SendPicture(std::uint32_t sound, double at_s, const std::string& jpeg) {
    if (backlog_ > kMaxBacklog / 4) return;
    Send(vm::LiveHeader(vm::LivePiece::Kind::kPicture, sound, at_s * 1000) + jpeg, true);
  }

  void Read() {
    const auto held = std::exchange(held_, nullptr);
    if (reading_ || ended_ || ending_ || backlog_ > kMaxBacklog) return;
    if (pictures_ && pictures_->behind()) {
      held_ = shared_from_this();
      return;
    }
    reading_ = true;
    socket_.Read([self = shared_from_this()](const Error& error, std::string message, bool binary) {
      if (error || self->server_->closed) return self->End();
      self->message_ = std::move(message);
      self->is_sound_ = binary;
      self->taken_ = 0;
      self->Take();
    });
  }

  /// A piece of the message in each turn of the loop, so that other clients do not wait.
  void Take() {
    if (ended_ || server_->closed) return End();
    if (!is_sound_) {
      TakeControl();
      taken_ = message_.size();
    } else {
      Tell(face_.Add(std::string_view(message_).substr(taken_, kPieceBytes)));
      taken_ += kPieceBytes;
    }
    if (taken_ < message_.size()) {
      return asio::post(server_->io, [self = shared_from_this()] { self->Take(); });
    }
    reading_ = false;
    Read();
  }

  void TakeControl() {
    const auto control = ReadControl(message_);
    if (!control) return Send(ErrorText(control.error().text));
    if (*control == Control::kClear) {
      face_.Clear();
      if (pictures_) pictures_->Clear();
      // What was said of the sound and has not gone yet is void, but for the message on its way.
      while (outgoing_.size() > (writing_ ? 1u : 0u)) {
        backlog_ -= outgoing_.back().bytes.size();
        outgoing_.pop_back();
      }
      return Send(ClearedText());
    }
    const double heard_s = face_.heard_s();
    Tell(face_.End());
    if (!pictures_) return Send(EndText(heard_s));
    ending_ = true;
    pictures_->End([self = shared_from_this(), heard_s] {
      self->ending_ = false;
      self->Send(EndText(heard_s));
      self->Read();
    });
  }

  void Tell(const std::vector<LiveFace::Moment>& moments) {
    for (const auto& moment : moments) {
      Send(FrameText(*face_.settings().set, moment));
      if (pictures_) pictures_->Add(moment.at_s, moment.mouth);
    }
  }

  void Send(std::string bytes, bool binary = false) {
    if (ended_) return;
    backlog_ += bytes.size();
    outgoing_.push_back({std::move(bytes), binary});
    if (!writing_) Write();
  }

  void Write() {
    writing_ = true;
    const Outgoing& next = outgoing_.front();
    socket_.Write(next.bytes, "", next.binary, [self = shared_from_this()](const Error& error) {
      self->backlog_ -= self->outgoing_.front().bytes.size();
      self->outgoing_.pop_front();
      self->writing_ = false;
      if (error) return self->End();
      if (!self->outgoing_.empty()) self->Write();
      self->Read();
    });
  }

  void End() {
    if (std::exchange(ended_, true)) return;
    socket_.Cut();
  }

  const std::shared_ptr<GatewayServer::Impl> server_;
  vm::WebSocket socket_;
  const MouthWish wish_;
  LiveFace face_;
  std::unique_ptr<FacePictures> pictures_;
  std::string message_;    // being worked on
  bool is_sound_ = false;  // it, and not a control message
  std::size_t taken_ = 0;  // bytes of it
  struct Outgoing {
    std::string bytes;
    bool binary = false;
  };
  std::deque<Outgoing> outgoing_;
  std::size_t backlog_ = 0;  // bytes of it
  bool reading_ = false, writing_ = false, ended_ = false;
  std::shared_ptr<MouthSession> held_;  // by itself, while pictures are drawn and nothing is read
  bool ending_ = false;                 // the sound's last pictures are drawn
};

}  // namespace

void ServeMouth(std::shared_ptr<GatewayServer::Impl> server, boost::beast::tcp_stream stream,
                const vm::WebRequest& request, const MouthWish& wish) {
  std::make_shared<MouthSession>(std::move(server), std::move(stream), wish)->Start(request);
}

}  // namespace gateway
