#include "agent_manager/mqtt/mosquitto_client.h"

#include <mosquitto.h>
#include <mqtt_protocol.h>
#include <openssl/ssl.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "vm_protocol/core/guarded.h"
#include "vm_protocol/core/limits.h"

namespace am::mqtt {
namespace {

constexpr int kQos = 1;

/// The library's, freed by it.
class Properties {
 public:
  explicit Properties(const Packet& packet) {
    if (!packet.response_topic.empty())
      mosquitto_property_add_string(&list_, MQTT_PROP_RESPONSE_TOPIC,
                                    packet.response_topic.c_str());
    if (!packet.correlation.empty())
      mosquitto_property_add_binary(&list_, MQTT_PROP_CORRELATION_DATA, packet.correlation.data(),
                                    static_cast<std::uint16_t>(packet.correlation.size()));
  }
  ~Properties() { mosquitto_property_free_all(&list_); }
  Properties(const Properties&) = delete;
  const mosquitto_property* get() const { return list_; }

 private:
  mosquitto_property* list_ = nullptr;
};

Packet PacketOf(const mosquitto_message& message, const mosquitto_property* properties) {
  Packet packet;
  packet.topic = message.topic;
  // What is longer than a line is refused later, for which a byte more is enough.
  packet.payload.assign(
      static_cast<const char*>(message.payload),
      std::min(static_cast<std::size_t>(message.payloadlen), vm::kMaxLineBytes + 1));
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

/// Empty: it has not failed.
std::string TextOf(int failed) {
  if (failed == MOSQ_ERR_SUCCESS) return "";
  return failed == MOSQ_ERR_ERRNO ? std::strerror(errno) : mosquitto_strerror(failed);
}

}  // namespace

/// What the library calls. It is C: what is thrown here ends the connection instead.
struct MosquittoClient::Callbacks {
  template <typename Act>
  static void Do(void* self, const Act& act) {
    auto& client = *static_cast<MosquittoClient*>(self);
    if (auto done = vm::Guarded([&] { act(client); }); !done)
      client.fault_ = std::move(done.error().text);
  }
  static void OnConnect(mosquitto*, void* self, int code, int, const mosquitto_property*) {
    Do(self, [code](MosquittoClient& client) {
      if (code == MQTT_RC_SUCCESS) return client.events_.on_connected();
      client.fault_ = "refused: " + std::string(mosquitto_reason_string(code));
    });
  }
  static void OnDisconnect(mosquitto*, void* self, int code, const mosquitto_property*) {
    Do(self, [code](MosquittoClient& client) {
      if (code >= 128) client.fault_ = mosquitto_reason_string(code);
    });
  }
  static void OnMessage(mosquitto*, void* self, const mosquitto_message* message,
                        const mosquitto_property* properties) {
    Do(self,
       [=](MosquittoClient& client) { client.events_.on_packet(PacketOf(*message, properties)); });
  }
  static void OnPublish(mosquitto*, void* self, int number, int code, const mosquitto_property*) {
    Do(self, [=](MosquittoClient& client) {
      Broker::Events::Receipt receipt{number, code == MQTT_RC_NO_MATCHING_SUBSCRIBERS, ""};
      if (code >= 128) receipt.refusal = mosquitto_reason_string(code);
      client.events_.on_receipt(receipt);
    });
  }
};

MosquittoClient::Library::Library() { mosquitto_lib_init(); }
MosquittoClient::Library::~Library() { mosquitto_lib_cleanup(); }

MosquittoClient::MosquittoClient(const Settings& settings, Events events)
    : settings_(settings),
      events_(std::move(events)),
      client_(mosquitto_new(settings.id.c_str(), true, static_cast<void*>(this))) {}

MosquittoClient::~MosquittoClient() { mosquitto_destroy(client_); }

std::string MosquittoClient::Connect() {
  if (client_ == nullptr) return "no memory";
  mosquitto_int_option(client_, MOSQ_OPT_PROTOCOL_VERSION, MQTT_PROTOCOL_V5);
  mosquitto_int_option(client_, MOSQ_OPT_TCP_NODELAY, 1);
  mosquitto_int_option(client_, MOSQ_OPT_SEND_MAXIMUM, kWindow);
  mosquitto_int_option(client_, MOSQ_OPT_RECEIVE_MAXIMUM, kWindow);
  const auto& [config, endpoint, password, id, will] = settings_;
  if (!config.user.empty())
    mosquitto_username_pw_set(client_, config.user.c_str(),
                              password.empty() ? nullptr : password.c_str());
  if (endpoint.kind == vm::Endpoint::Kind::kTls) {
    if (const std::string failed = UseTls(); !failed.empty()) return failed;
  }
  mosquitto_will_set_v5(client_, will.topic.c_str(), static_cast<int>(will.payload.size()),
                        will.payload.data(), kQos, will.retain, nullptr);
  mosquitto_connect_v5_callback_set(client_, &Callbacks::OnConnect);
  mosquitto_disconnect_v5_callback_set(client_, &Callbacks::OnDisconnect);
  mosquitto_message_v5_callback_set(client_, &Callbacks::OnMessage);
  mosquitto_publish_v5_callback_set(client_, &Callbacks::OnPublish);
  return TextOf(mosquitto_connect_async(client_, endpoint.host.c_str(), endpoint.port,
                                        static_cast<int>(config.keep_alive.count())));
}

std::string MosquittoClient::UseTls() {
  const vm::Credentials& files = settings_.config.credentials;
  const auto name = [](const std::string& file) { return file.empty() ? nullptr : file.c_str(); };
  const int failed = mosquitto_tls_set(client_, name(files.authority),
                                       files.authority.empty() ? "/etc/ssl/certs" : nullptr,
                                       name(files.certificate), name(files.key), nullptr);
  return failed == MOSQ_ERR_SUCCESS ? "" : mosquitto_strerror(failed);
}

int MosquittoClient::socket() const { return mosquitto_socket(client_); }
bool MosquittoClient::wants_write() const { return mosquitto_want_write(client_); }

std::string MosquittoClient::Move(short ready) {
  int failed = MOSQ_ERR_SUCCESS;
  // Reading first: a broker that closes says why before it does.
  if ((ready & (POLLIN | POLLERR | POLLHUP)) != 0) {
    // Decrypted bytes wait in the TLS layer, where poll does not see them.
    do {
      failed = mosquitto_loop_read(client_, 1);
    } while (failed == MOSQ_ERR_SUCCESS && mosquitto_ssl_get(client_) != nullptr &&
             SSL_pending(static_cast<SSL*>(mosquitto_ssl_get(client_))) > 0);
  }
  if (failed == MOSQ_ERR_SUCCESS && ((ready & POLLOUT) != 0 || wants_write()))
    failed = mosquitto_loop_write(client_, 1);
  if (failed == MOSQ_ERR_SUCCESS) failed = mosquitto_loop_misc(client_);
  return fault_.empty() ? TextOf(failed) : fault_;
}

MosquittoClient::Published MosquittoClient::Publish(const Packet& packet) {
  const Properties properties(packet);
  int number = 0;
  const int failed = mosquitto_publish_v5(
      client_, &number, packet.topic.c_str(), static_cast<int>(packet.payload.size()),
      packet.payload.data(), kQos, packet.retain, properties.get());
  if (failed == MOSQ_ERR_SUCCESS) return {.number = number};
  if (failed == MOSQ_ERR_NO_CONN || failed == MOSQ_ERR_CONN_LOST) return {};
  return {.refusal = mosquitto_strerror(failed)};
}

void MosquittoClient::Subscribe(const std::string& filter, bool retained) {
  mosquitto_subscribe_v5(
      client_, nullptr, filter.c_str(), kQos,
      retained ? MQTT_SUB_OPT_SEND_RETAIN_ALWAYS : MQTT_SUB_OPT_SEND_RETAIN_NEVER, nullptr);
}

void MosquittoClient::Unsubscribe(const std::string& filter) {
  mosquitto_unsubscribe(client_, nullptr, filter.c_str());
}

void MosquittoClient::Disconnect() {
  mosquitto_disconnect_v5(client_, MQTT_RC_NORMAL_DISCONNECTION, nullptr);
}

}  // namespace am::mqtt
