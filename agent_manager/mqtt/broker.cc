#include "agent_manager/mqtt/broker.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "agent_manager/mqtt/mosquitto_client.h"
#include "vm_protocol/core/guarded.h"
#include "vm_protocol/core/text_file.h"
#include "vm_protocol/runtime/credentials.h"
#include "vm_protocol/runtime/endpoint.h"

namespace am::mqtt {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kFirstWait{500}, kLongestWait{30000};
constexpr std::size_t kMaxCertificateBytes = 4U << 20;
constexpr milliseconds kConnectLimit{10000}, kGoodbyeLimit{1000}, kLookAround{500};

/// One connection after another. Its own thread connects, reads and waits; the context's thread
/// publishes. Constant after construction: everything up to `mutex_`, which guards the rest, and
/// every call of the client. (The library says it can be called by several threads, but reads some
/// of its members unguarded.)
class MosquittoBroker final : public Broker {
 public:
  MosquittoBroker(boost::asio::io_context& io, const MqttConfig& config, Packet will,
                  Broker::Events events)
      : io_(io), config_(config), events_(std::move(events)) {
    settings_.will = std::move(will);
    settings_.id = "galatea-" + config_.agent + "-" + vm::MakeNonce().substr(0, 8);
    const auto endpoint = vm::ParseEndpoint(config_.broker);
    if (!endpoint) throw std::runtime_error("mqtt: " + endpoint.error().text);
    settings_.endpoint = *endpoint;
    if (!config_.password_file.empty()) {
      const auto secret = vm::ReadSecret(config_.password_file, "password", 1);
      if (!secret) throw std::runtime_error("mqtt: " + secret.error().text);
      settings_.password = *secret;
    }
    for (const std::string& file : {config_.credentials.authority, config_.credentials.certificate,
                                    config_.credentials.key}) {
      if (file.empty()) continue;
      if (const auto text = vm::ReadTextFile(file, kMaxCertificateBytes); !text)
        throw std::runtime_error("mqtt: " + text.error().text);
    }
    wake_fd_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (wake_fd_ < 0) throw std::runtime_error("mqtt: no event descriptor is left");
    thread_ = std::thread([this] { Work(); });
  }

  ~MosquittoBroker() override {
    *alive_ = false;
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    Wake();
    thread_.join();
    close(wake_fd_);
  }

  int Publish(const Packet& packet) override {
    const std::lock_guard lock(mutex_);
    if (!Usable()) return 0;
    const MosquittoClient::Published published = client_->Publish(packet);
    Wake();
    if (published.number != 0) {
      ++unacknowledged_;
      return published.number;
    }
    if (published.refusal.empty()) return 0;
    // Refused before it left: it has a receipt, too.
    const int number = --last_refused_;
    Post([this, receipt = Events::Receipt{number, false, published.refusal}] {
      events_.on_receipt(receipt);
    });
    return number;
  }

  void Subscribe(const std::string& filter, bool retained) override {
    const std::lock_guard lock(mutex_);
    if (!Usable()) return;
    client_->Subscribe(filter, retained);
    Wake();
  }
  void Rest(const std::string& reason) override {
    const std::lock_guard lock(mutex_);
    rest_ = reason;
    Wake();
  }
  void Unsubscribe(const std::string& filter) override {
    const std::lock_guard lock(mutex_);
    if (!Usable()) return;
    client_->Unsubscribe(filter);
    Wake();
  }

 private:
  /// REQUIRES: the lock. The connection is up, and its owner has heard of it.
  bool Usable() const { return client_ != nullptr && connected_ && told_ == connection_; }

  void Wake() const {
    const std::uint64_t one = 1;
    static_cast<void>(!write(wake_fd_, &one, sizeof(one)));
  }

  template <typename F>
  void Post(F&& then) {
    boost::asio::post(io_, [alive = alive_, then = std::forward<F>(then)] {
      if (*alive) then();
    });
  }

  // The thread.
  void Work() {
    // What comes up to here is no connection's end: there is none from then on.
    if (const auto worked = vm::Guarded([this] { WorkOn(); }); !worked)
      static_cast<void>(vm::Guarded(
          [&] { Post([this, text = worked.error().text] { events_.on_lost(text); }); }));
  }

  void WorkOn() {
    milliseconds wait = kFirstWait / 2;
    while (true) {
      const auto start = steady_clock::now();
      const auto [was_online, reason] = OneConnection();
      {
        std::unique_lock lock(mutex_);
        if (ending_) return;
      }
      if (was_online || reason != last_reason_) {
        last_reason_ = reason;
        Post([this, text = reason] { events_.on_lost(text); });
      }
      std::unique_lock lock(mutex_);
      const bool lasted = was_online && steady_clock::now() - start > kLongestWait;
      wait = !rest_.empty() ? kLongestWait : lasted ? kFirstWait : std::min(wait * 2, kLongestWait);
      if (changed_.wait_for(lock, wait, [this] { return ending_; })) return;
    }
  }

  std::pair<bool, std::string> OneConnection() {
    MosquittoClient client(
        settings_, {.on_connected = [this] { OnConnected(); },
                    .on_packet = [this](Packet packet) { OnPacket(std::move(packet)); },
                    .on_receipt = [this](const Events::Receipt& receipt) { OnReceipt(receipt); }});
    {
      const std::lock_guard lock(mutex_);
      client_ = &client;
      rest_.clear();
      connected_ = false;
      unacknowledged_ = 0;
    }
    std::string reason;
    const auto served = vm::Guarded([&] {
      reason = client.Connect();
      if (reason.empty()) reason = Serve(client);
    });
    if (!served) reason = served.error().text;
    const std::lock_guard lock(mutex_);
    client_ = nullptr;
    return {std::exchange(connected_, false), reason};
  }

  /// Until the connection ends; why it did.
  std::string Serve(MosquittoClient& client) {
    const auto start = steady_clock::now();
    std::optional<steady_clock::time_point> goodbye;
    std::unique_lock lock(mutex_);
    lock_ = &lock;
    while (true) {
      std::array<pollfd, 2> waits{{{client.socket(), POLLIN, 0}, {wake_fd_, POLLIN, 0}}};
      if (client.wants_write()) waits[0].events |= POLLOUT;
      lock.unlock();
      poll(waits.data(), waits.size(), static_cast<int>(kLookAround.count()));
      std::uint64_t ignored = 0;
      if (waits[1].revents != 0) static_cast<void>(!read(wake_fd_, &ignored, sizeof(ignored)));
      lock.lock();
      if (const std::string reason = client.Move(waits[0].revents); !reason.empty()) return reason;
      const auto now = steady_clock::now();
      if (!connected_ && (ending_ || now - start > kConnectLimit)) return "it does not answer";
      if (!ending_ && rest_.empty()) continue;
      if (!goodbye) goodbye = now + kGoodbyeLimit;
      if (unacknowledged_ > 0 && now < *goodbye) continue;
      client.Disconnect();
      return rest_;
    }
  }

  // The client calls these on the thread, under the lock.
  void OnConnected() {
    connected_ = true;
    last_reason_.clear();
    Post([this, connection = ++connection_] {
      {
        const std::lock_guard lock(mutex_);
        told_ = connection;
      }
      events_.on_online();
    });
  }

  void OnPacket(Packet packet) {
    // While we wait nothing is read, and the broker keeps the rest.
    changed_.wait(*lock_, [this] {
      return ending_ || (waiting_ < kMaxWaiting && waiting_bytes_ < kMaxWaitingBytes);
    });
    if (ending_) return;
    const std::size_t bytes = packet.payload.size() + packet.topic.size();
    Post([this, packet = std::move(packet), bytes] {
      {
        const std::lock_guard lock(mutex_);
        --waiting_;
        waiting_bytes_ -= bytes;
      }
      changed_.notify_all();
      events_.on_packet(packet);
    });
    ++waiting_;  // before the other thread can count it out, which takes the lock
    waiting_bytes_ += bytes;
  }

  void OnReceipt(const Events::Receipt& receipt) {
    if (unacknowledged_ > 0) --unacknowledged_;
    Post([this, receipt] { events_.on_receipt(receipt); });
  }

  boost::asio::io_context& io_;
  const MqttConfig config_;
  const Broker::Events events_;
  const MosquittoClient::Library library_;
  MosquittoClient::Settings settings_{.config = config_};
  int wake_fd_ = -1;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);  // the context's thread only

  std::mutex mutex_;
  std::condition_variable changed_;
  MosquittoClient* client_ = nullptr;
  bool connected_ = false;
  bool ending_ = false;
  std::string rest_;                // why the connection is to be ended
  std::size_t waiting_ = 0;         // packets on their way to the context's thread
  std::size_t waiting_bytes_ = 0;   // of these
  std::size_t unacknowledged_ = 0;  // published, no receipt yet
  unsigned long connection_ = 0;    // how many there have been
  unsigned long told_ = 0;          // the last one its owner has heard of
  int last_refused_ = 0;            // numbers of what never left: below zero

  // The thread's own.
  std::string last_reason_;
  std::unique_lock<std::mutex>* lock_ = nullptr;  // held while the client moves
  std::thread thread_;                            // last: it uses all the others
};

}  // namespace

std::unique_ptr<Broker> ConnectToBroker(boost::asio::io_context& io, const MqttConfig& config,
                                        const Packet& will, Broker::Events events) {
  return std::make_unique<MosquittoBroker>(io, config, will, std::move(events));
}

}  // namespace am::mqtt
