#include "agent_manager/access/rights.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "agent_manager/access/pattern.h"
#include "agent_manager/routing/own_names.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/utf8.h"

namespace am {

using vm::Command;
using vm::Errc;
using vm::Message;
using vm::Relation;
using vm::Result;

namespace {

constexpr std::string_view kHubName = own_name::kHub;

std::unexpected<vm::Error> Refuse(Role role, std::string_view member, std::string_view deed) {
  return vm::Fail(Errc::kAccess, "a " + std::string(RoleName(role)) + " may not " +
                                     std::string(deed) + " (rights." + std::string(RoleName(role)) +
                                     "." + std::string(member) + ")");
}

bool IsWord(const std::string& value, std::string_view word) {
  return vm::EqualsIgnoringCase(std::string_view(value).substr(0, word.size()), word) &&
         value.find_first_not_of(" \t", word.size()) == std::string::npos;
}

/// What a message does beside being heard, if it is one of the things that need a permission.
struct Deed {
  Permission permission;
  std::string_view name;
};
std::optional<Deed> DeedOf(std::string_view receiver, const Message& message) {
  const std::string_view slot = message.slot;
  const bool at_hub = receiver == kHubName;
  const bool sets = message.command == Command::kSet;
  // Where the value is not in the message, it may be any.
  const bool unseen = message.relation != Relation::kAssign;
  if (sets && slot == "Run" &&
      (unseen || IsWord(message.value, "EXIT") || IsWord(message.value, "CLOSE")))
    return Deed{Permission::kStop, "end programs"};
  if (message.command == Command::kProp && message.value != "AutoOutput")
    return Deed{Permission::kMute, "have a module no longer report"};
  if (at_hub) {
    if (sets && (slot == "Start" || slot == "Stop" || slot == "Restart"))
      return Deed{Permission::kStop, "start and stop modules"};
    if (sets && slot == "Reload") return Deed{Permission::kReload, "have the configuration read"};
    if (sets && slot == "Flow") return Deed{Permission::kWatch, "watch what others say"};
    if ((sets && slot.starts_with("Limit.")) || message.command == Command::kRest)
      return Deed{Permission::kLimits, "change the hub's limits"};
    return std::nullopt;
  }
  if (sets && (slot == "Clock" || slot == "Clock.mode" || slot == "Wait"))
    return Deed{Permission::kClock, "hold or set the clock and input of a module"};
  return std::nullopt;
}

/// `..` and links followed as far as the path exists; no slash at the end.
std::filesystem::path Resolved(const std::filesystem::path& path) {
  constexpr int kMaxLinks = 40;
  std::error_code error;
  auto resolved = std::filesystem::absolute(path, error);
  for (int links = 0; links < kMaxLinks; ++links) {
    const auto canonical = std::filesystem::weakly_canonical(resolved, error);
    resolved = error ? resolved.lexically_normal() : canonical;
    // What it leads to need not exist yet: whoever writes there makes it.
    if (!std::filesystem::is_symlink(resolved, error)) break;
    resolved = resolved.parent_path() / std::filesystem::read_symlink(resolved, error);
  }
  return resolved.has_filename() ? resolved : resolved.parent_path();
}

}  // namespace

std::string_view RoleName(Role role) {
  static constexpr std::array<std::string_view, kRoles.size()> kNames{"owner", "module", "client",
                                                                      "guest"};
  return kNames[static_cast<std::size_t>(role)];
}

bool Rights::May(Permission permission) const {
  return std::ranges::find(may, permission) != may.end();
}

bool Rights::AllFiles() const { return std::ranges::find(files, "/") != files.end(); }

RightsTable RightsTable::Default() {
  RightsTable table;
  for (const auto& known : kPermissionNames) table[Role::kOwner].may.push_back(known.permission);
  table[Role::kOwner].files = {"/"};
  table[Role::kModule].files = {"/"};
  table[Role::kModule].may = {Permission::kDefine,  // dialogues drive the agent by their own macros
                              Permission::kMute};
  table[Role::kClient].files = {"."};
  table[Role::kGuest].commands = {"set", "inq", "prop", "do", "rep", "tell"};
  return table;
}

bool LiesWithin(const std::string& file, const std::string& folder,
                const std::vector<std::string>& folders) {
  if (std::ranges::find(folders, "/") != folders.end()) return true;
  if (folders.empty() || file.empty()) return false;
  const std::size_t colon = file.find(':');
  if (file.front() == '-' || (colon != std::string::npos && colon < file.find('/'))) return false;
  const auto path =
      Resolved(folder.empty() || file.front() == '/' ? std::filesystem::path(file)
                                                     : std::filesystem::path(folder) / file);
  return std::ranges::any_of(folders, [&](const std::string& allowed) {
    const auto within = Resolved(allowed);
    if (within.empty()) return false;  // no path, and so not the beginning of every one
    return std::ranges::mismatch(within, path).in1 == within.end();
  });
}

Result<void> AccessControl::CheckPermission(Role role, Permission permission,
                                            std::string_view deed) const {
  if (table_[role].May(permission)) return {};
  const auto known = std::ranges::find(kPermissionNames, permission, &PermissionName::permission);
  return Refuse(role, "may: " + std::string(known->name), deed);
}

Result<void> AccessControl::CheckReceiver(Role role, std::string_view receiver) const {
  if (AnyMatches(table_[role].to, receiver)) return {};
  return Refuse(role, "to", "speak to @" + std::string(receiver));
}

Result<void> AccessControl::CheckMessage(Role role, std::string_view receiver,
                                         const Message& message) const {
  return CheckMessage(role, receiver, message, 0);
}

Result<void> AccessControl::CheckMessage(Role role, std::string_view receiver,
                                         const Message& message, int depth) const {
  constexpr int kMaxDepth = 4;
  if (depth > kMaxDepth) return Refuse(role, "files", "have lines kept within lines");
  const Rights& rights = table_[role];
  const std::string_view command = vm::CommandName(message.command);
  if (!AnyMatches(rights.commands, command))
    return Refuse(role, "commands", "say " + std::string(command));
  if (!receiver.empty()) {
    if (const auto checked = CheckReceiver(role, receiver); !checked) return checked;
  }
  if (!message.slot.empty() && !AnyMatches(rights.slots, message.slot))
    return Refuse(role, "slots", "name the slot " + message.slot);
  if (const auto deed = DeedOf(receiver, message))
    return CheckPermission(role, deed->permission, deed->name);
  // A line that a module keeps is never seen again.
  if (receiver != kHubName && message.command == Command::kDef &&
      message.relation == Relation::kAppend) {
    if (const auto kept = vm::ParseMessage(message.value))
      return CheckMessage(role, receiver, *kept, depth + 1);
  }
  return {};
}

Result<void> AccessControl::CheckUnseenLines(Role role, const std::string& receiver) const {
  if (AllFiles(role)) return {};
  return Refuse(role, "files", "have @" + receiver + " run lines of a file or that it keeps");
}

Result<void> AccessControl::CheckFile(Role role, const std::string& file,
                                      const std::string& folder) const {
  if (LiesWithin(file, folder, table_[role].files)) return {};
  return Refuse(role, "files", "name the file '" + std::string(vm::CutUtf8(file, 200)) + "'");
}

Result<void> AccessControl::CheckFiles(Role role, const Message& message, const FileSlots& slots,
                                       const std::string& folder) const {
  if (AllFiles(role)) return {};
  // What the file holds is not known here.
  if (message.command == Command::kSet && message.relation == Relation::kFromFile &&
      slots.Takes(message.slot))
    return Refuse(role, "files", "read from a file what names files, in " + message.slot);
  const bool writes_or_reads =
      message.relation == Relation::kFromFile ||
      (message.relation == Relation::kAppend && message.command == Command::kSave);
  if (writes_or_reads) return CheckFile(role, message.value, folder);
  if (message.command == Command::kDo)  // a macro, or a file of that name
    return CheckFile(role, message.slot.empty() ? message.value : message.slot, folder);
  if (message.command != Command::kSet) return {};
  // Appended to what is there, which is not known here, any value can make a file's name.
  if (message.relation == Relation::kAppend && slots.Takes(message.slot))
    return Refuse(role, "files", "append to the file name in " + message.slot);
  for (const std::string& file : slots.FilesIn(message.slot, message.value)) {
    if (const auto checked = CheckFile(role, file, folder); !checked) return checked;
  }
  return {};
}

Result<void> AccessControl::CheckName(Role role, std::string_view name) const {
  if (AnyMatches(table_[role].names, name)) return {};
  return Refuse(role, "names", "be called @" + std::string(name));
}

}  // namespace am
