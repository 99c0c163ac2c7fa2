#include "agent_manager/mqtt/broker.h"

#include <mosquitto.h>
#include <mqtt_protocol.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "vm_protocol/runtime/credentials.h"
#include "vm_protocol/runtime/endpoint.h"

namespace am::mqtt {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kFirstWait{500}, kLongestWait{30000};
constexpr milliseconds kConnectLimit{10000}, kGoodbyeLimit{1000}, kLookAround{500};
constexpr int kQos = 1;
constexpr int kWindow = 1000;  // packets on their way each way, if the broker allows as many

/// The library's, freed by it.
class Properties {
 public:
  Properties() = default;
  Properties(const Properties&) = delete;
  ~Properties() { mosquitto_property_free_all(&list_); }
  explicit Properties(const Packet& packet) {
    if (!packet.response_topic.empty())
      mosquitto_property_add_string(&list_, MQTT_PROP_RESPONSE_TOPIC,
                                    packet.response_topic.c_str());
    if (!packet.correlation.empty())
      mosquitto_property_add_binary(&list_, MQTT_PROP_CORRELATION_DATA, packet.correlation.data(),
                                    static_cast<std::uint16_t>(packet.correlation.size()));
  }
  const mosquitto_property* get() const { return list_; }

 private:
  mosquitto_property* list_ = nullptr;
};

Packet PacketOf(const mosquitto_message& message, const mosquitto_property* properties) {
  Packet packet;
  packet.topic = message.topic;
  packet.payload.assign(static_cast<const char*>(message.payload),
                        static_cast<std::size_t>(message.payloadlen));
  packet.retain = message.retain;
  char* text = nullptr;
  if (mosquitto_property_read_string(properties, MQTT_PROP_RESPONSE_TOPIC, &text, false) !=
      nullptr) {
    packet.response_topic = text;
    std::free(text);
  }
  void* bytes = nullptr;
  std::uint16_t size = 0;
  if (mosquitto_property_read_binary(properties, MQTT_PROP_CORRELATION_DATA, &bytes, &size,
                                     false) != nullptr) {
    packet.correlation.assign(static_cast<const char*>(bytes), size);
    std::free(bytes);
  }
  return packet;
}

/// One connection after another. Its own thread connects, reads and waits; the context's thread
/// publishes. Constant after construction: everything up to `mutex_`, which guards the rest, and
/// every call of the library: it says it can be called by several threads, but reads some of its
/// members unguarded.
class MosquittoBroker final : public Broker {
 public:
  MosquittoBroker(boost::asio::io_context& io, const MqttConfig& config, Packet will,
                  Broker::Events events)
      : io_(io), config_(config), will_(std::move(will)), events_(std::move(events)) {
    const auto endpoint = vm::ParseEndpoint(config_.broker);
    if (!endpoint) throw std::runtime_error("mqtt: " + endpoint.error().text);
    endpoint_ = *endpoint;
    if (!config_.password_file.empty()) {
      const auto secret = vm::ReadSecret(config_.password_file, "password", 1);
      if (!secret) throw std::runtime_error("mqtt: " + secret.error().text);
      password_ = *secret;
    }
    for (const std::string& file : {config_.credentials.authority, config_.credentials.certificate,
                                    config_.credentials.key}) {
      if (!file.empty() && access(file.c_str(), R_OK) != 0)
        throw std::runtime_error("mqtt: cannot read '" + file + "'");
    }
    wake_fd_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (wake_fd_ < 0) throw std::runtime_error("mqtt: no event descriptor is left");
    mosquitto_lib_init();
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
    mosquitto_lib_cleanup();
  }

  int Publish(const Packet& packet) override {
    const std::lock_guard lock(mutex_);
    if (!Usable()) return 0;
    const Properties properties(packet);
    int number = 0;
    const int failed = mosquitto_publish_v5(
        client_, &number, packet.topic.c_str(), static_cast<int>(packet.payload.size()),
        packet.payload.data(), kQos, packet.retain, properties.get());
    Wake();
    if (failed == MOSQ_ERR_SUCCESS) {
      ++unacknowledged_;
      return number;
    }
    if (failed == MOSQ_ERR_NO_CONN || failed == MOSQ_ERR_CONN_LOST) return 0;
    // Refused before it left: it has a receipt, too.
    number = --last_refused_;
    Post([this, receipt = Events::Receipt{number, false, mosquitto_strerror(failed)}] {
      events_.on_receipt(receipt);
    });
    return number;
  }

  void Subscribe(const std::string& filter, bool retained) override {
    const std::lock_guard lock(mutex_);
    if (!Usable()) return;
    mosquitto_subscribe_v5(
        client_, nullptr, filter.c_str(), kQos,
        retained ? MQTT_SUB_OPT_SEND_RETAIN_ALWAYS : MQTT_SUB_OPT_SEND_RETAIN_NEVER, nullptr);
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
    mosquitto_unsubscribe(client_, nullptr, filter.c_str());
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
    fault_.clear();
    mosquitto* const client = mosquitto_new(id_.c_str(), true, static_cast<void*>(this));
    if (client == nullptr) return {false, "no memory"};
    {
      const std::lock_guard lock(mutex_);
      client_ = client;
      rest_.clear();
      connected_ = false;
      unacknowledged_ = 0;
    }
    std::string reason = Prepare(client);
    if (reason.empty()) reason = Serve(client);
    const std::lock_guard lock(mutex_);
    const bool was_online = std::exchange(connected_, false);
    client_ = nullptr;
    mosquitto_destroy(client);
    return {was_online, reason};
  }

  /// Empty, or why there can be no connection.
  std::string Prepare(mosquitto* client) {
    mosquitto_int_option(client, MOSQ_OPT_PROTOCOL_VERSION, MQTT_PROTOCOL_V5);
    mosquitto_int_option(client, MOSQ_OPT_TCP_NODELAY, 1);
    mosquitto_int_option(client, MOSQ_OPT_SEND_MAXIMUM, kWindow);
    mosquitto_int_option(client, MOSQ_OPT_RECEIVE_MAXIMUM, kWindow);
    if (!config_.user.empty())
      mosquitto_username_pw_set(client, config_.user.c_str(),
                                password_.empty() ? nullptr : password_.c_str());
    if (endpoint_.kind == vm::Endpoint::Kind::kTls) {
      const vm::Credentials& files = config_.credentials;
      const auto name = [](const std::string& file) {
        return file.empty() ? nullptr : file.c_str();
      };
      const int failed = mosquitto_tls_set(client, name(files.authority),
                                           files.authority.empty() ? "/etc/ssl/certs" : nullptr,
                                           name(files.certificate), name(files.key), nullptr);
      if (failed != MOSQ_ERR_SUCCESS) return mosquitto_strerror(failed);
    }
    mosquitto_will_set_v5(client, will_.topic.c_str(), static_cast<int>(will_.payload.size()),
                          will_.payload.data(), kQos, will_.retain, nullptr);
    mosquitto_connect_v5_callback_set(client, &OnConnect);
    mosquitto_disconnect_v5_callback_set(client, &OnDisconnect);
    mosquitto_message_v5_callback_set(client, &OnMessage);
    mosquitto_publish_v5_callback_set(client, &OnPublish);
    const int failed = mosquitto_connect_async(client, endpoint_.host.c_str(), endpoint_.port,
                                               static_cast<int>(config_.keep_alive.count()));
    if (failed == MOSQ_ERR_ERRNO) return std::string(std::strerror(errno));
    return failed == MOSQ_ERR_SUCCESS ? "" : mosquitto_strerror(failed);
  }

  /// Until the connection ends; why it did.
  std::string Serve(mosquitto* client) {
    const auto start = steady_clock::now();
    std::optional<steady_clock::time_point> goodbye;
    std::unique_lock lock(mutex_);
    lock_ = &lock;
    while (true) {
      std::array<pollfd, 2> waits{{{mosquitto_socket(client), POLLIN, 0}, {wake_fd_, POLLIN, 0}}};
      if (mosquitto_want_write(client)) waits[0].events |= POLLOUT;
      lock.unlock();
      poll(waits.data(), waits.size(), static_cast<int>(kLookAround.count()));
      std::uint64_t ignored = 0;
      if (waits[1].revents != 0) static_cast<void>(!read(wake_fd_, &ignored, sizeof(ignored)));
      lock.lock();
      const int failed = Move(client, waits[0].revents);
      if (!fault_.empty()) return fault_;
      if (failed == MOSQ_ERR_ERRNO) return std::strerror(errno);
      if (failed != MOSQ_ERR_SUCCESS) return mosquitto_strerror(failed);
      const auto now = steady_clock::now();
      if (!connected_ && (ending_ || now - start > kConnectLimit)) return "it does not answer";
      if (!ending_ && rest_.empty()) continue;
      if (!goodbye) goodbye = now + kGoodbyeLimit;
      if (unacknowledged_ > 0 && now < *goodbye) continue;
      mosquitto_disconnect_v5(client, MQTT_RC_NORMAL_DISCONNECTION, nullptr);
      return rest_;
    }
  }

  /// Reads and writes what can be. REQUIRES: the lock.
  static int Move(mosquitto* client, short ready) {
    int failed = MOSQ_ERR_SUCCESS;
    // Reading first: a broker that closes says why before it does.
    if ((ready & (POLLIN | POLLERR | POLLHUP)) != 0) {
      // Decrypted bytes wait in the TLS layer, where poll does not see them.
      do {
        failed = mosquitto_loop_read(client, 1);
      } while (failed == MOSQ_ERR_SUCCESS && mosquitto_ssl_get(client) != nullptr &&
               SSL_pending(static_cast<SSL*>(mosquitto_ssl_get(client))) > 0);
    }
    if (failed == MOSQ_ERR_SUCCESS && ((ready & POLLOUT) != 0 || mosquitto_want_write(client)))
      failed = mosquitto_loop_write(client, 1);
    return failed == MOSQ_ERR_SUCCESS ? mosquitto_loop_misc(client) : failed;
  }

  // The library calls these on the thread, under the lock.
  static void OnConnect(mosquitto*, void* self, int code, int, const mosquitto_property*) {
    auto& broker = *static_cast<MosquittoBroker*>(self);
    if (code != MQTT_RC_SUCCESS) {
      broker.fault_ = "refused: " + std::string(mosquitto_reason_string(code));
      return;
    }
    broker.connected_ = true;
    broker.last_reason_.clear();
    broker.Post([&broker, connection = ++broker.connection_] {
      {
        const std::lock_guard lock(broker.mutex_);
        broker.told_ = connection;
      }
      broker.events_.on_online();
    });
  }

  static void OnDisconnect(mosquitto*, void* self, int code, const mosquitto_property*) {
    if (code >= 128)
      static_cast<MosquittoBroker*>(self)->fault_ = std::string(mosquitto_reason_string(code));
  }

  static void OnMessage(mosquitto*, void* self, const mosquitto_message* message,
                        const mosquitto_property* properties) {
    auto& broker = *static_cast<MosquittoBroker*>(self);
    // While we wait nothing is read, and the broker keeps the rest.
    broker.changed_.wait(*broker.lock_,
                         [&] { return broker.waiting_ < kMaxWaiting || broker.ending_; });
    if (broker.ending_) return;
    ++broker.waiting_;
    broker.Post([&broker, packet = PacketOf(*message, properties)] {
      {
        const std::lock_guard lock(broker.mutex_);
        --broker.waiting_;
      }
      broker.changed_.notify_all();
      broker.events_.on_packet(packet);
    });
  }

  static void OnPublish(mosquitto*, void* self, int number, int code, const mosquitto_property*) {
    auto& broker = *static_cast<MosquittoBroker*>(self);
    if (broker.unacknowledged_ > 0) --broker.unacknowledged_;
    Events::Receipt receipt{number, code == MQTT_RC_NO_MATCHING_SUBSCRIBERS, ""};
    if (code >= 128) receipt.refusal = mosquitto_reason_string(code);
    broker.Post([&broker, receipt] { broker.events_.on_receipt(receipt); });
  }

  boost::asio::io_context& io_;
  const MqttConfig config_;
  const Packet will_;
  const Broker::Events events_;
  vm::Endpoint endpoint_;
  std::string password_;
  const std::string id_ = "galatea-" + config_.agent + "-" + vm::MakeNonce().substr(0, 8);
  int wake_fd_ = -1;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);  // the context's thread only

  std::mutex mutex_;
  std::condition_variable changed_;
  mosquitto* client_ = nullptr;
  bool connected_ = false;
  bool ending_ = false;
  std::string rest_;                // why the connection is to be ended
  std::size_t waiting_ = 0;         // packets on their way to the context's thread
  std::size_t unacknowledged_ = 0;  // published, no receipt yet
  unsigned long connection_ = 0;    // how many there have been
  unsigned long told_ = 0;          // the last one its owner has heard of
  int last_refused_ = 0;            // numbers of what never left: below zero

  // The thread's own.
  std::string fault_, last_reason_;
  std::unique_lock<std::mutex>* lock_ = nullptr;  // held while the library is called
  std::thread thread_;                            // last: it uses all the others
};

}  // namespace

std::unique_ptr<Broker> ConnectToBroker(boost::asio::io_context& io, const MqttConfig& config,
                                        const Packet& will, Broker::Events events) {
  return std::make_unique<MosquittoBroker>(io, config, will, std::move(events));
}

}  // namespace am::mqtt
