// Reads endpoints to listen on, the page and credentials from the configuration.

#include "agent_manager/config/config_json.h"
#include "vm_protocol/runtime/endpoint.h"

namespace am {

void AddCredentialReaders(Readers& readers, vm::Credentials& credentials) {
  readers["token_file"] = Into(credentials.token_file, Text);
  readers["certificate"] = Into(credentials.certificate, Text);
  readers["key"] = Into(credentials.key, Text);
  readers["authority"] = Into(credentials.authority, Text);
}

ListenConfig ReadListen(const json& value, const std::string& key) {
  ListenConfig listen;
  std::string at_key = key;
  if (value.is_object()) {
    at_key += ".at";
    Readers readers{{"at", Into(listen.at, Text)}, {"role", Into(listen.role, ReadRole)}};
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
               {{"at", Into(web.at, Text)},
                {"role", Into(web.role, ReadRole)},
                {"token_file", Into(web.token_file, Text)}});
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
             {{"file", Into(log.file, Text)},
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
