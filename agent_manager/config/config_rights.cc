// Reads roles and the table of their rights from the configuration.

#include "agent_manager/config/config_json.h"
#include "vm_protocol/core/message.h"

namespace am {
namespace {

std::vector<std::string> Folders(const json& value, const std::string& key) {
  std::vector<std::string> folders = Texts(value, key);
  for (std::size_t i = 0; i < folders.size(); ++i) {
    if (folders[i].empty())
      Wrong(key + "[" + std::to_string(i) + "]", value[i], "a folder, or \"/\" for all files");
  }
  return folders;
}

void ReadRow(const json& value, const std::string& key, Rights& rights) {
  const auto into = [](std::vector<std::string>& target) -> Readers::mapped_type {
    return [&target](const json& v, const std::string& k) { target = Texts(v, k); };
  };
  std::vector<std::pair<std::string, Permission>> words;
  for (const auto& known : kPermissionNames)
    words.emplace_back(std::string(known.name), known.permission);
  ReadObject(value, key,
             {{"commands", into(rights.commands)},
              {"to", into(rights.to)},
              {"slots", into(rights.slots)},
              {"names", into(rights.names)},
              {"files", Into(rights.files, Folders)},
              {"may", [&](const json& v, const std::string& k) {
                 rights.may.clear();
                 ReadList(v, k, "a list of permissions",
                          [&](const json& word, const std::string& at) {
                            rights.may.push_back(OneOf<Permission>(word, at, words));
                          });
               }}});
}

}  // namespace

Role ReadRole(const json& value, const std::string& key) {
  std::vector<std::pair<std::string, Role>> words;
  for (const Role role : kRoles) words.emplace_back(std::string(RoleName(role)), role);
  return OneOf<Role>(value, key, words);
}

RightsTable ReadRights(const json& value, const std::string& key) {
  RightsTable table = RightsTable::Default();
  Readers readers;
  for (const Role role : kRoles) {
    if (role == Role::kOwner)
      continue;  // the owner can end the hub anyway: its rights have no limits
    readers[std::string(RoleName(role))] = [&table, role](const json& v, const std::string& k) {
      ReadRow(v, k, table[role]);
    };
  }
  ReadObject(value, key, readers);
  return table;
}

}  // namespace am
