#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "agent_manager/config/config.h"
#include "vm_protocol/core/result.h"

namespace am::mqtt {

/// What an MQTT 5 PUBLISH carries, as far as it concerns us. All are sent with QoS 1.
struct Packet {
  std::string topic{};
  std::string payload{};
  bool retain = false;
  std::string response_topic{};  ///< empty: nobody waits for an answer
  std::string correlation{};     ///< any bytes
};

/// A connection to a broker that comes back by itself: after a loss it is tried again after 0.5 s,
/// doubled up to 30 s until a connection has lasted as long. Nothing is kept over a loss: who
/// published must publish again. Thread: the caller's for all calls and all events; an
/// implementation may have one of its own. Limits: packets beyond kMaxWaiting or kMaxWaitingBytes
/// that the caller has not taken are left with the broker.
class Broker {
 public:
  static constexpr std::size_t kMaxWaiting = 4096;
  static constexpr std::size_t kMaxWaitingBytes = 4u << 20;
  struct Events {
    std::function<void()> on_online;
    std::function<void(const std::string& reason)> on_lost;
    std::function<void(const Packet& packet)> on_packet;
    /// The broker has taken, or refused, what Publish gave this number. `nobody`: no subscriber.
    struct Receipt {
      int number = 0;
      bool nobody = false;
      std::string refusal;  ///< empty: taken
    };
    std::function<void(const Receipt& receipt)> on_receipt;
  };
  virtual ~Broker() = default;
  /// The number its receipt will have; 0: the broker is away. REQUIRES: a topic without wildcards.
  virtual int Publish(const Packet& packet) = 0;
  /// `retained`: also the values that stand there. Lost with the connection.
  virtual void Subscribe(const std::string& filter, bool retained) = 0;
  virtual void Unsubscribe(const std::string& filter) = 0;
  /// Ends the connection in order (no will) and tries again after the longest wait. `on_lost` is
  /// told the reason.
  virtual void Rest(const std::string& reason) = 0;
};

/// The real one (libmosquitto). `will` is published by the broker when we are lost. Destroying it
/// says goodbye (no will) and gives what was published a moment to leave. Throws std::runtime_error
/// with a sentence if the configuration's files cannot be used.
std::unique_ptr<Broker> ConnectToBroker(boost::asio::io_context& io, const MqttConfig& config,
                                        const Packet& will, Broker::Events events);

}  // namespace am::mqtt
