// One-way latency and throughput between two clients of a message hub on loopback TCP, for our hub
// and for an MQTT broker (QoS 0), with the same client code, sizes and pacing:
//
//   hub_bench galatea PORT      hub listening on 127.0.0.1:PORT
//   hub_bench mqtt PORT         MQTT 3.1.1 broker, OASIS standard of 29 October 2014
//
// Prints one line of JSON. Latency: messages of 65 bytes, one every 250 us, time from just before
// the write to just after the read in another thread of this process. Throughput: at most kWindow
// messages on their way, so that no broker has to drop any.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMessageBytes = 65;  // the line as sent, newline included
constexpr int kLatencyMessages = 8000;
constexpr int kWarmUp = 500;
constexpr int kThroughputMessages = 400'000;
constexpr int kWindow = 2000;
constexpr int kBatch = 50;  // messages per write while measuring throughput
constexpr auto kPace = std::chrono::microseconds(250);

int Dial(int port) {
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0) {
    throw std::runtime_error("cannot connect to 127.0.0.1:" + std::to_string(port) + ": " +
                             std::strerror(errno));
  }
  const int on = 1;
  setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  return fd;
}

void WriteAll(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write(fd, bytes.data(), bytes.size());
    if (n <= 0) throw std::runtime_error("write: " + std::string(std::strerror(errno)));
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

/// Reads bytes and counts whole messages in them.
class Receiver {
 public:
  Receiver(int fd, bool mqtt) : fd_(fd), mqtt_(mqtt) {}

  /// Waits for at least one whole message; says how many came.
  int Read() {
    while (true) {
      if (const int whole = Count(); whole > 0) return whole;
      char chunk[65536];
      const ssize_t n = read(fd_, chunk, sizeof(chunk));
      if (n <= 0) throw std::runtime_error("the hub closed the connection");
      buffer_.append(chunk, static_cast<std::size_t>(n));
    }
  }
  std::string TakeRaw(std::size_t bytes) {
    while (buffer_.size() < bytes) {
      char chunk[4096];
      const ssize_t n = read(fd_, chunk, sizeof(chunk));
      if (n <= 0) throw std::runtime_error("the hub closed the connection");
      buffer_.append(chunk, static_cast<std::size_t>(n));
    }
    const std::string taken = buffer_.substr(0, bytes);
    buffer_.erase(0, bytes);
    return taken;
  }

 private:
  int Count() {
    int whole = 0;
    std::size_t used = 0;
    while (true) {
      if (mqtt_) {  // type byte, then a length below 128
        if (buffer_.size() < used + 2) break;
        const std::size_t length = 2 + static_cast<unsigned char>(buffer_[used + 1]);
        if (buffer_.size() < used + length) break;
        if ((static_cast<unsigned char>(buffer_[used]) >> 4) == 3) ++whole;
        used += length;
      } else {
        const std::size_t newline = buffer_.find('\n', used);
        if (newline == std::string::npos) break;
        if (buffer_.compare(used, 8, "set Load") == 0) ++whole;
        used = newline + 1;
      }
    }
    buffer_.erase(0, used);
    return whole;
  }

  int fd_;
  bool mqtt_;
  std::string buffer_;
};

std::string MqttString(std::string_view text) {
  std::string bytes{static_cast<char>(text.size() >> 8), static_cast<char>(text.size() & 0xff)};
  return bytes.append(text);
}

std::string MqttPacket(char type, const std::string& body) {
  if (body.size() > 127) throw std::runtime_error("packet too long for this bench");
  return std::string{type, static_cast<char>(body.size())} + body;
}

int MqttConnect(int port, std::string_view id) {
  const int fd = Dial(port);
  const std::string body = MqttString("MQTT") + std::string("\x04\x02\x00\x3c", 4) + MqttString(id);
  WriteAll(fd, MqttPacket(0x10, body));
  Receiver receiver(fd, true);
  const std::string answer = receiver.TakeRaw(4);
  if (answer[3] != 0) throw std::runtime_error("the broker refused the connection");
  return fd;
}

int GalateaConnect(int port, const std::string& name) {
  const int fd = Dial(port);
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

struct Pair {
  int sender;
  int receiver;
  std::string message;
};

Pair Connect(bool mqtt, int port) {
  if (mqtt) {
    const int receiver = MqttConnect(port, "bench-b");
    WriteAll(receiver,
             MqttPacket(static_cast<char>(0x82),
                        std::string("\x00\x01", 2) + MqttString("B/Load") + std::string(1, 0)));
    Receiver(receiver, true).TakeRaw(5);
    std::string body = MqttString("B/Load");
    body.resize(kMessageBytes - 2, 'x');
    return {MqttConnect(port, "bench-a"), receiver, MqttPacket(0x30, body)};
  }
  const int receiver = GalateaConnect(port, "B");
  std::string line = "to @B set Load = ";
  line.resize(kMessageBytes - 1, 'x');
  return {GalateaConnect(port, "A"), receiver, line + "\n"};
}

double Percentile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

std::vector<double> Latencies(const Pair& pair, bool mqtt) {
  std::vector<Clock::time_point> sent(kLatencyMessages + kWarmUp);
  std::vector<double> microseconds;
  std::atomic<int> published{0};
  std::thread reader([&] {
    Receiver receiver(pair.receiver, mqtt);
    for (int got = 0; got < kLatencyMessages + kWarmUp;) {
      const int more = receiver.Read();
      const auto now = Clock::now();
      published.load(std::memory_order_acquire);
      for (int i = 0; i < more; ++i, ++got) {
        if (got < kWarmUp) continue;
        microseconds.push_back(
            std::chrono::duration<double, std::micro>(now - sent[static_cast<std::size_t>(got)])
                .count());
      }
    }
  });
  auto next = Clock::now();
  for (std::size_t i = 0; i < sent.size(); ++i) {
    next += kPace;
    std::this_thread::sleep_until(next);
    sent[i] = Clock::now();
    published.store(static_cast<int>(i), std::memory_order_release);
    WriteAll(pair.sender, pair.message);
  }
  reader.join();
  return microseconds;
}

double Throughput(const Pair& pair, bool mqtt) {
  std::atomic<int> received{0};
  const auto start = Clock::now();
  std::thread reader([&] {
    Receiver receiver(pair.receiver, mqtt);
    while (received.load() < kThroughputMessages) {
      received += receiver.Read();
      received.notify_one();
    }
  });
  std::string batch;
  for (int i = 0; i < kBatch; ++i) batch += pair.message;
  for (int sent = 0; sent < kThroughputMessages; sent += kBatch) {
    for (int got = received.load(); sent + kBatch - got > kWindow; got = received.load())
      received.wait(got);
    WriteAll(pair.sender, batch);
  }
  reader.join();
  return kThroughputMessages / std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 ||
      (std::string_view(argv[1]) != "galatea" && std::string_view(argv[1]) != "mqtt")) {
    std::fprintf(stderr, "usage: hub_bench galatea|mqtt PORT\n");
    return 2;
  }
  try {
    const bool mqtt = std::string_view(argv[1]) == "mqtt";
    const Pair pair = Connect(mqtt, std::atoi(argv[2]));
    const auto latencies = Latencies(pair, mqtt);
    const double per_second = Throughput(pair, mqtt);
    std::printf("{\"hub\": \"%s\", \"p50_us\": %.1f, \"p99_us\": %.1f, \"messages_per_s\": %.0f}\n",
                argv[1], Percentile(latencies, 0.5), Percentile(latencies, 0.99), per_second);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hub_bench: %s\n", error.what());
    return 1;
  }
}
