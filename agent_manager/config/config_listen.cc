// The places where others come in, in the configuration.

#include "agent_manager/config/config_json.h"
#include "vm_protocol/runtime/endpoint.h"

namespace am {

void AddCredentialReaders(Readers& readers, vm::Credentials& credentials) {
  const auto into = [](std::string& target) {
    return [&target](const json& v, const std::string& k) { target = Text(v, k); };
  };
  readers["token_file"] = into(credentials.token_file);
  readers["certificate"] = into(credentials.certificate);
  readers["key"] = into(credentials.key);
  readers["authority"] = into(credentials.authority);
}

ListenConfig ReadListen(const json& value, const std::string& key) {
  ListenConfig listen;
  std::string at_key = key;
  if (value.is_object()) {
    at_key += ".at";
    Readers readers{
        {"at", [&](const json& v, const std::string& k) { listen.at = Text(v, k); }},
        {"role", [&](const json& v, const std::string& k) { listen.role = ReadRole(v, k); }}};
    AddCredentialReaders(readers, listen.credentials);
    ReadObject(value, key, readers);
  } else {
    listen.at = Text(value, key);
  }
  const auto endpoint = vm::ParseEndpoint(listen.at);
  if (!endpoint) throw ConfigFault{at_key, endpoint.error().text};
  if (const auto checked = vm::CheckListening(*endpoint, listen.credentials); !checked)
    throw ConfigFault{at_key, checked.error().text};
  return listen;
}

WebConfig ReadWeb(const json& value, const std::string& key) {
  WebConfig web;
  std::string at_key = key;
  if (value.is_object()) {
    at_key += ".at";
    ReadObject(value, key,
               {{"at", [&](const json& v, const std::string& k) { web.at = Text(v, k); }},
                {"role", [&](const json& v, const std::string& k) { web.role = ReadRole(v, k); }},
                {"token_file",
                 [&](const json& v, const std::string& k) { web.token_file = Text(v, k); }}});
  } else {
    web.at = Text(value, key);
  }
  const auto endpoint = vm::ParseEndpoint(web.at);
  if (!endpoint) throw ConfigFault{at_key, endpoint.error().text};
  if (endpoint->kind != vm::Endpoint::Kind::kTcp || !vm::IsLoopback(*endpoint))
    throw ConfigFault{
        at_key, "found '" + web.at + "', expected tcp:127.0.0.1:PORT (others come by a tunnel)"};
  return web;
}

LogConfig ReadLogConfig(const json& value, const std::string& key) {
  LogConfig log;
  if (!value.is_object()) {
    log.file = Text(value, key);
    return log;
  }
  ReadObject(value, key,
             {{"file", [&](const json& v, const std::string& k) { log.file = Text(v, k); }},
              {"rotate_mb",
               [&](const json& v, const std::string& k) {
                 log.rotate_mb = static_cast<std::uint64_t>(Whole(v, k, 1, 1000000));
               }},
              {"keep", [&](const json& v, const std::string& k) {
                 log.keep = static_cast<unsigned>(Whole(v, k, 0, 1000));
               }}});
  return log;
}

}  // namespace am
