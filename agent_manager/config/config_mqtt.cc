// Reads the MQTT broker from the configuration.

#include <algorithm>

#include "agent_manager/config/config_json.h"
#include "vm_protocol/core/message.h"
#include "vm_protocol/runtime/endpoint.h"

namespace am {
namespace {

bool IsRoot(const std::string& root) {
  std::size_t at = 0;
  while (at <= root.size()) {
    const std::size_t end = std::min(root.find('/', at), root.size());
    if (!vm::IsModuleName(std::string_view(root).substr(at, end - at))) return false;
    at = end + 1;
  }
  return true;
}

void CheckBroker(const MqttConfig& mqtt, const std::string& key) {
  const auto endpoint = vm::ParseEndpoint(mqtt.broker);
  if (!endpoint) throw ConfigFault{key + ".broker", endpoint.error().text};
  if (endpoint->kind == vm::Endpoint::Kind::kUnix)
    throw ConfigFault{key + ".broker",
                      "found '" + mqtt.broker + "', expected tcp:HOST:PORT or tls:HOST:PORT"};
  const bool tls = endpoint->kind == vm::Endpoint::Kind::kTls;
  const vm::Credentials& shown = mqtt.credentials;
  if (shown.certificate.empty() != shown.key.empty())
    throw ConfigFault{key, "certificate and key come together"};
  if (!tls && (!shown.certificate.empty() || !shown.authority.empty()))
    throw ConfigFault{key + ".broker", "certificates are for tls:HOST:PORT"};
  if (!vm::IsLoopback(*endpoint) && mqtt.password_file.empty() && shown.certificate.empty())
    throw ConfigFault{key + ".broker",
                      "other machines reach this broker: it needs user and password_file, or tls: "
                      "with a certificate"};
}

}  // namespace

MqttConfig ReadMqtt(const json& value, const std::string& key) {
  MqttConfig mqtt;
  Readers readers{{"broker", Into(mqtt.broker, Text)},
                  {"agent",
                   [&](const json& v, const std::string& k) {
                     mqtt.agent = Text(v, k);
                     if (!vm::IsModuleName(mqtt.agent)) Wrong(k, v, "letters, digits, '_' or '-'");
                   }},
                  {"root",
                   [&](const json& v, const std::string& k) {
                     mqtt.root = Text(v, k);
                     if (!IsRoot(mqtt.root)) Wrong(k, v, "names with '/' between them");
                   }},
                  {"user", Into(mqtt.user, Text)},
                  {"password_file", Into(mqtt.password_file, Text)},
                  {"role", Into(mqtt.role, ReadRole)},
                  {"modules", Into(mqtt.modules, Texts)},
                  {"keep_alive_s", [&](const json& v, const std::string& k) {
                     mqtt.keep_alive = std::chrono::seconds(Whole(v, k, 5, 3600));
                   }}};
  AddCredentialReaders(readers, mqtt.credentials);
  readers.erase("token_file");
  ReadObject(value, key, readers);
  if (mqtt.broker.empty()) throw ConfigFault{key, "broker is missing"};
  if (mqtt.agent.empty()) throw ConfigFault{key, "agent is missing: what this hub is called there"};
  if (!mqtt.password_file.empty() && mqtt.user.empty())
    throw ConfigFault{key + ".password_file", "user is missing"};
  CheckBroker(mqtt, key);
  return mqtt;
}

}  // namespace am
