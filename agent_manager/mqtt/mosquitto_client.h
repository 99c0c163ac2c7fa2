#pragma once

#include <functional>
#include <string>

#include "agent_manager/mqtt/broker.h"
#include "vm_protocol/runtime/endpoint.h"

struct mosquitto;

namespace am::mqtt {

/// One connection to a broker, by libmosquitto, which is included nowhere else. Whoever owns it
/// waits for the socket and calls Move; events come within Move only.
/// Thread: none of its own, and no lock; one call at a time.
/// Limits: kWindow packets on their way each way, if the broker allows as many.
/// Errors: a sentence why there is no connection, or no more; empty: there is.
class MosquittoClient {
 public:
  static constexpr int kWindow = 1000;
  /// As long as one lives the library is initialised.
  struct Library {
    Library();
    ~Library();
    Library(const Library&) = delete;
  };
  struct Settings {
    const MqttConfig& config;
    vm::Endpoint endpoint{};
    std::string password{};
    std::string id{};
    Packet will{};
  };
  struct Events {
    std::function<void()> on_connected;
    std::function<void(Packet packet)> on_packet;
    std::function<void(const Broker::Events::Receipt& receipt)> on_receipt;
  };
  /// The settings outlive it.
  MosquittoClient(const Settings& settings, Events events);
  ~MosquittoClient();
  MosquittoClient(const MosquittoClient&) = delete;

  /// Begins to connect.
  std::string Connect();
  int socket() const;
  bool wants_write() const;
  /// Reads and writes what can be; `ready`: what poll says of the socket.
  std::string Move(short ready);

  struct Published {
    int number = 0;         ///< 0: the connection is gone, or the packet was refused
    std::string refusal{};  ///< by the library, before it left
  };
  Published Publish(const Packet& packet);
  void Subscribe(const std::string& filter, bool retained);
  void Unsubscribe(const std::string& filter);
  /// Says goodbye; the broker publishes no will.
  void Disconnect();

 private:
  struct Callbacks;
  std::string UseTls();

  const Settings& settings_;
  const Events events_;
  mosquitto* const client_;
  std::string fault_;  // why the broker ends the connection
};

}  // namespace am::mqtt
