// Redis PUBLISH and SUBSCRIBE, by hiredis.

#include <hiredis/hiredis.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <stdexcept>

#include "bench/hub_lane.h"

namespace bench {
namespace {

redisContext* Connect(int port) {
  redisContext* const context = redisConnect("127.0.0.1", port);
  if (context == nullptr || context->err != 0)
    throw std::runtime_error("cannot connect to redis at " + std::to_string(port));
  const int on = 1;
  setsockopt(context->fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  return context;
}

void TakeReply(redisContext* context) {
  void* reply = nullptr;
  if (redisGetReply(context, &reply) != REDIS_OK) throw std::runtime_error("redis has gone");
  freeReplyObject(reply);
}

class Published final : public Lane {
 public:
  explicit Published(int port) : sender_(Connect(port)), receiver_(Connect(port)) {
    payload_.resize(kMessageBytes - 6, 'x');  // the channel's name counts, as a topic does
    redisAppendCommand(receiver_, "SUBSCRIBE B/Load");
    TakeReply(receiver_);
  }
  ~Published() override {
    redisFree(sender_);
    redisFree(receiver_);
  }
  void Send(int count) override {
    for (int i = 0; i < count; ++i)
      redisAppendCommand(sender_, "PUBLISH B/Load %b", payload_.data(), payload_.size());
    for (int i = 0; i < count; ++i) TakeReply(sender_);
  }
  int Receive() override {
    TakeReply(receiver_);
    int whole = 1;
    for (void* reply = nullptr;
         redisGetReplyFromReader(receiver_, &reply) == REDIS_OK && reply != nullptr; ++whole) {
      freeReplyObject(reply);
      reply = nullptr;
    }
    return whole;
  }

 private:
  redisContext *sender_, *receiver_;
  std::string payload_;
};

}  // namespace

std::unique_ptr<Lane> RedisLane(int port) { return std::make_unique<Published>(port); }

}  // namespace bench
