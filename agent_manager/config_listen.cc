// The places where others come in, in the configuration.

#include "agent_manager/config_json.h"
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
    Readers readers{{"at", [&](const json& v, const std::string& k) { listen.at = Text(v, k); }}};
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

}  // namespace am
