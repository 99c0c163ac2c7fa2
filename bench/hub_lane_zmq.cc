// ZeroMQ, by its own library; it has no broker, so a forwarder in a process of its own is one.

#include <zmq.h>

#include <cerrno>
#include <stdexcept>

#include "bench/hub_lane.h"

namespace bench {
namespace {

void Check(int result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string(what) + ": " + zmq_strerror(errno));
}

std::string At(int port) { return "tcp://127.0.0.1:" + std::to_string(port); }

class Forwarded final : public Lane {
 public:
  explicit Forwarded(int port) : context_(zmq_ctx_new()) {
    const int none = 0;
    for (auto [socket, type, at] :
         {std::tuple{&sender_, ZMQ_PUB, port}, {&receiver_, ZMQ_SUB, port + 1}}) {
      *socket = zmq_socket(context_, type);
      Check(zmq_setsockopt(*socket, ZMQ_SNDHWM, &none, sizeof(none)), "ZMQ_SNDHWM");
      Check(zmq_setsockopt(*socket, ZMQ_RCVHWM, &none, sizeof(none)), "ZMQ_RCVHWM");
      Check(zmq_setsockopt(*socket, ZMQ_LINGER, &none, sizeof(none)), "ZMQ_LINGER");
      Check(zmq_connect(*socket, At(at).c_str()), "connect");
    }
    Check(zmq_setsockopt(receiver_, ZMQ_SUBSCRIBE, "B/Load", 6), "subscribe");
    message_.resize(kMessageBytes, 'x');
    // A subscription needs a moment to reach the sender; until then messages go nowhere.
    const int wait_ms = 10;
    Check(zmq_setsockopt(receiver_, ZMQ_RCVTIMEO, &wait_ms, sizeof(wait_ms)), "ZMQ_RCVTIMEO");
    int sent = 0;
    do {
      if (++sent > 1000) throw std::runtime_error("the forwarder does not answer");
      Send(1);
    } while (zmq_recv(receiver_, chunk_, sizeof(chunk_), 0) < 0);
    while (zmq_recv(receiver_, chunk_, sizeof(chunk_), 0) >= 0) {
    }
    const int forever = -1;
    Check(zmq_setsockopt(receiver_, ZMQ_RCVTIMEO, &forever, sizeof(forever)), "ZMQ_RCVTIMEO");
  }
  ~Forwarded() override {
    zmq_close(sender_);
    zmq_close(receiver_);
    zmq_ctx_term(context_);
  }
  void Send(int count) override {
    for (int i = 0; i < count; ++i)
      Check(zmq_send(sender_, message_.data(), message_.size(), 0), "send");
  }
  int Receive() override {
    Check(zmq_recv(receiver_, chunk_, sizeof(chunk_), 0), "receive");
    int whole = 1;
    while (whole < 1000 && zmq_recv(receiver_, chunk_, sizeof(chunk_), ZMQ_DONTWAIT) >= 0) ++whole;
    return whole;
  }

 private:
  void* context_;
  void* sender_ = nullptr;
  void* receiver_ = nullptr;
  std::string message_ = "B/Load";
  char chunk_[256];
};

}  // namespace

std::unique_ptr<Lane> ZmqLane(int port) { return std::make_unique<Forwarded>(port); }

void ZmqForward(int port) {
  void* const context = zmq_ctx_new();
  void* const in = zmq_socket(context, ZMQ_XSUB);
  void* const out = zmq_socket(context, ZMQ_XPUB);
  const int none = 0;
  for (void* socket : {in, out}) {
    Check(zmq_setsockopt(socket, ZMQ_SNDHWM, &none, sizeof(none)), "ZMQ_SNDHWM");
    Check(zmq_setsockopt(socket, ZMQ_RCVHWM, &none, sizeof(none)), "ZMQ_RCVHWM");
  }
  Check(zmq_bind(in, At(port).c_str()), "bind");
  Check(zmq_bind(out, At(port + 1).c_str()), "bind");
  zmq_proxy(in, out, nullptr);
}

}  // namespace bench
