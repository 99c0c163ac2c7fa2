#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

/// What hub_bench measures: a sender and a receiver with a hub or broker between them.
namespace bench {

inline constexpr std::size_t kMessageBytes = 65;  ///< as sent, with what names the receiver

/// The way from one client to another. Send is called by one thread, Receive by another.
/// All throw std::runtime_error with a sentence when the connection breaks.
class Lane {
 public:
  virtual ~Lane() = default;
  /// Hands `count` messages to the system, in as few writes as the client's library knows.
  virtual void Send(int count) = 0;
  /// Waits for at least one message; how many came.
  virtual int Receive() = 0;
};

/// Our hub at tcp:PORT of 127.0.0.1 or unix:PATH.
std::unique_ptr<Lane> GalateaLane(const std::string& at);
/// Relay at a Unix socket: what two hops cost when nothing is read, kept or routed.
std::unique_ptr<Lane> RelayLane(const std::string& path);
/// Copies bytes from a second connection to the first, pair after pair, until it is killed.
[[noreturn]] void Relay(const std::string& path);
/// An MQTT 3.1.1 broker (OASIS standard of 29 October 2014), QoS 0.
std::unique_ptr<Lane> MqttLane(int port);
/// A ZeroMQ forwarder (ZmqForward) at PORT (for senders) and PORT + 1 (for receivers).
std::unique_ptr<Lane> ZmqLane(int port);
/// Runs a forwarder, XSUB to XPUB, until it is killed.
void ZmqForward(int port);
/// A Redis server, PUBLISH and SUBSCRIBE.
std::unique_ptr<Lane> RedisLane(int port);

/// A TCP connection to a port of 127.0.0.1 without Nagle's delay, or to a Unix socket.
int DialTcp(int port);
int DialUnix(const std::string& path);
void WriteAll(int fd, std::string_view bytes);

}  // namespace bench
