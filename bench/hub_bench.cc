// One-way latency and throughput between two clients of a hub or broker on this machine, with the
// same sizes and pacing for each:
//
//   hub_bench galatea tcp:PORT | unix:PATH
//   hub_bench mqtt | zmq | redis PORT
//   hub_bench relay PATH                bytes copied by a process that looks at none of them:
//                                       the least any hub can cost on this machine
//   hub_bench relay-run PATH            is that process; runs until killed
//   hub_bench zmq-forward PORT          is the broker ZeroMQ does not have; runs until killed
//
// Prints one line of JSON. Latency: messages of 65 bytes, one every 250 us, time from just before
// the write to just after the read in another thread of this process: one clock, nothing halved.
// Throughput: at most kWindow messages on their way, so that no broker has to drop any.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bench/hub_lane.h"

namespace {

using bench::Lane;
using Clock = std::chrono::steady_clock;

constexpr int kLatencyMessages = 8000;
constexpr int kWarmUp = 500;
constexpr int kThroughputMessages = 400'000;
constexpr int kWindow = 2000;
constexpr int kBatch = 50;  // messages per write while measuring throughput
constexpr auto kPace = std::chrono::microseconds(250);

double Percentile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

std::vector<double> Latencies(Lane& lane) {
  std::vector<Clock::time_point> sent(kLatencyMessages + kWarmUp);
  std::vector<double> microseconds;
  std::atomic<int> published{0};
  std::thread reader([&] {
    for (int got = 0; got < kLatencyMessages + kWarmUp;) {
      const int more = lane.Receive();
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
    lane.Send(1);
  }
  reader.join();
  return microseconds;
}

double Throughput(Lane& lane) {
  std::atomic<int> received{0};
  const auto start = Clock::now();
  std::thread reader([&] {
    while (received.load() < kThroughputMessages) {
      received += lane.Receive();
      received.notify_one();
    }
  });
  for (int sent = 0; sent < kThroughputMessages; sent += kBatch) {
    for (int got = received.load(); sent + kBatch - got > kWindow; got = received.load())
      received.wait(got);
    lane.Send(kBatch);
  }
  reader.join();
  return kThroughputMessages / std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  const std::map<std::string, std::function<std::unique_ptr<Lane>(const std::string&)>> lanes{
      {"galatea", [](const std::string& at) { return bench::GalateaLane(at); }},
      {"relay", [](const std::string& path) { return bench::RelayLane(path); }},
      {"mqtt", [](const std::string& port) { return bench::MqttLane(std::stoi(port)); }},
#ifdef BENCH_HAS_ZMQ
      {"zmq", [](const std::string& port) { return bench::ZmqLane(std::stoi(port)); }},
#endif
#ifdef BENCH_HAS_REDIS
      {"redis", [](const std::string& port) { return bench::RedisLane(std::stoi(port)); }},
#endif
  };
  const std::string kind = argc == 3 ? argv[1] : "";
  try {
    if (kind == "relay-run") bench::Relay(argv[2]);
#ifdef BENCH_HAS_ZMQ
    if (kind == "zmq-forward") {
      bench::ZmqForward(std::atoi(argv[2]));
      return 0;
    }
#endif
    const auto make = lanes.find(kind);
    if (make == lanes.end()) {
      std::fprintf(stderr, "usage: hub_bench KIND PORT|PATH|tcp:PORT|unix:PATH, with KIND one of");
      for (const auto& [name, unused] : lanes) std::fprintf(stderr, " %s", name.c_str());
      std::fprintf(stderr, "\n");
      return 2;
    }
    const auto lane = make->second(argv[2]);
    const auto latencies = Latencies(*lane);
    const double per_second = Throughput(*lane);
    std::printf("{\"hub\": \"%s\", \"p50_us\": %.1f, \"p99_us\": %.1f, \"messages_per_s\": %.0f}\n",
                kind.c_str(), Percentile(latencies, 0.5), Percentile(latencies, 0.99), per_second);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hub_bench: %s\n", error.what());
    return 1;
  }
}
