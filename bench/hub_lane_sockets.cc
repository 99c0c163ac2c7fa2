// Our hub and MQTT brokers, spoken to over plain sockets.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "bench/hub_lane.h"

namespace bench {
namespace {

sockaddr_un UnixAddress(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof(address.sun_path)) throw std::runtime_error("path too long: " + path);
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

int Dial(int family, const sockaddr* address, socklen_t size, const std::string& name) {
  const int fd = socket(family, SOCK_STREAM, 0);
  if (connect(fd, address, size) != 0)
    throw std::runtime_error("cannot connect to " + name + ": " + std::strerror(errno));
  return fd;
}

/// Counts whole messages in the bytes it reads.
class SocketLane : public Lane {
 public:
  SocketLane(int sender, int receiver, std::string message)
      : sender_(sender), receiver_(receiver), message_(std::move(message)) {}
  ~SocketLane() override {
    close(sender_);
    close(receiver_);
  }
  void Send(int count) override {
    if (count == 1) return WriteAll(sender_, message_);
    std::string batch;
    for (int i = 0; i < count; ++i) batch += message_;
    WriteAll(sender_, batch);
  }
  int Receive() override {
    while (true) {
      int whole = 0;
      buffer_.erase(0, Count(buffer_, whole));
      if (whole > 0) return whole;
      char chunk[65536];
      const ssize_t n = read(receiver_, chunk, sizeof(chunk));
      if (n <= 0) throw std::runtime_error("the hub closed the connection");
      buffer_.append(chunk, static_cast<std::size_t>(n));
    }
  }

 private:
  /// How many bytes are whole messages; counts those that are meant for us.
  virtual std::size_t Count(std::string_view bytes, int& whole) const = 0;
  int sender_, receiver_;
  std::string message_, buffer_;
};

class LineLane final : public SocketLane {
  using SocketLane::SocketLane;
  std::size_t Count(std::string_view bytes, int& whole) const override {
    std::size_t used = 0;
    for (std::size_t end; (end = bytes.find('\n', used)) != std::string_view::npos; used = end + 1)
      if (bytes.substr(used, 8) == "set Load") ++whole;
    return used;
  }
};

class PacketLane final : public SocketLane {
  using SocketLane::SocketLane;
  std::size_t Count(std::string_view bytes, int& whole) const override {
    std::size_t used = 0;
    while (bytes.size() >= used + 2) {  // type byte, then a length below 128
      const std::size_t length = 2 + static_cast<unsigned char>(bytes[used + 1]);
      if (bytes.size() < used + length) break;
      if ((static_cast<unsigned char>(bytes[used]) >> 4) == 3) ++whole;
      used += length;
    }
    return used;
  }
};

std::string MqttString(std::string_view text) {
  std::string bytes{static_cast<char>(text.size() >> 8), static_cast<char>(text.size() & 0xff)};
  return bytes.append(text);
}

std::string MqttPacket(char type, const std::string& body) {
  if (body.size() > 127) throw std::runtime_error("packet too long for this bench");
  return std::string{type, static_cast<char>(body.size())} + body;
}

std::string TakeBytes(int fd, std::size_t count) {
  std::string bytes(count, '\0');
  for (std::size_t got = 0; got < count;) {
    const ssize_t n = read(fd, bytes.data() + got, count - got);
    if (n <= 0) throw std::runtime_error("the broker closed the connection");
    got += static_cast<std::size_t>(n);
  }
  return bytes;
}

int MqttConnect(int port, std::string_view id) {
  const int fd = DialTcp(port);
  WriteAll(fd, MqttPacket(
                   0x10, MqttString("MQTT") + std::string("\x04\x02\x00\x3c", 4) + MqttString(id)));
  if (TakeBytes(fd, 4)[3] != 0) throw std::runtime_error("the broker refused the connection");
  return fd;
}

int GalateaConnect(const std::string& at, const std::string& name) {
  const int fd =
      at.starts_with("unix:") ? DialUnix(at.substr(5)) : DialTcp(std::stoi(at.substr(4)));
  WriteAll(fd, "to @AM set#n Name = " + name + "\n");
  std::string line;
  char c = 0;
  while (line.find("rep#n Name = ") == std::string::npos || c != '\n') {
    if (read(fd, &c, 1) != 1) throw std::runtime_error("the hub closed the connection");
    line += c;
    if (line.find(".error") != std::string::npos)
      throw std::runtime_error("the hub refused the name: " + line);
  }
  return fd;
}

}  // namespace

int DialTcp(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int fd = Dial(AF_INET, reinterpret_cast<sockaddr*>(&address), sizeof(address),
                      "127.0.0.1:" + std::to_string(port));
  const int on = 1;
  setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  return fd;
}

int DialUnix(const std::string& path) {
  const sockaddr_un address = UnixAddress(path);
  return Dial(AF_UNIX, reinterpret_cast<const sockaddr*>(&address), sizeof(address), path);
}

void WriteAll(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write(fd, bytes.data(), bytes.size());
    if (n <= 0) throw std::runtime_error("write: " + std::string(std::strerror(errno)));
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

std::unique_ptr<Lane> GalateaLane(const std::string& at) {
  const int receiver = GalateaConnect(at, "B");
  std::string line = "to @B set Load = ";
  line.resize(kMessageBytes - 1, 'x');
  return std::make_unique<LineLane>(GalateaConnect(at, "A"), receiver, line + "\n");
}

std::unique_ptr<Lane> RelayLane(const std::string& path) {
  const int receiver = DialUnix(path);
  std::string line = "set Load = ";
  line.resize(kMessageBytes - 1, 'x');
  return std::make_unique<LineLane>(DialUnix(path), receiver, line + "\n");
}

void Relay(const std::string& path) {
  const sockaddr_un address = UnixAddress(path);
  const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  if (bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      listen(listener, 2) != 0)
    throw std::runtime_error("cannot listen at " + path + ": " + std::strerror(errno));
  while (true) {
    const int receiver = accept(listener, nullptr, nullptr);
    const int sender = accept(listener, nullptr, nullptr);
    if (receiver < 0 || sender < 0)
      throw std::runtime_error("accept: " + std::string(std::strerror(errno)));
    char chunk[65536];
    for (ssize_t n; (n = read(sender, chunk, sizeof(chunk))) > 0;)
      WriteAll(receiver, {chunk, static_cast<std::size_t>(n)});
    close(sender);
    close(receiver);
  }
}

std::unique_ptr<Lane> MqttLane(int port) {
  const int receiver = MqttConnect(port, "bench-b");
  WriteAll(receiver,
           MqttPacket(static_cast<char>(0x82),
                      std::string("\x00\x01", 2) + MqttString("B/Load") + std::string(1, 0)));
  TakeBytes(receiver, 5);
  std::string body = MqttString("B/Load");
  body.resize(kMessageBytes - 2, 'x');
  return std::make_unique<PacketLane>(MqttConnect(port, "bench-a"), receiver,
                                      MqttPacket(0x30, body));
}

}  // namespace bench
