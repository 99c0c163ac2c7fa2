#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "agent_manager/access/file_slots.h"
#include "agent_manager/access/role.h"
#include "vm_protocol/core/message.h"

namespace am {

/// What only some roles may do to the hub and its modules beside saying things to them.
enum class Permission {
  kDefine,  ///< define macros at the hub, and change or delete what others have defined
  kRemove,  ///< delete files by the macro step "remove"
  kStop,    ///< start, stop and restart modules, and end programs (Run = EXIT)
  kReload,  ///< have the configuration read again
  kLimits,  ///< change the hub's limits
  kWatch,   ///< be shown every message (Flow)
  kClock,   ///< set the clock and the input of a module, which all who speak to it share
  kMute,    ///< have a module no longer report a slot, which all hear (NoAutoOutput)
};
struct PermissionName {
  Permission permission;
  std::string_view name;  ///< in the configuration
};
inline constexpr std::array<PermissionName, 8> kPermissionNames{{{Permission::kDefine, "define"},
                                                                 {Permission::kRemove, "remove"},
                                                                 {Permission::kStop, "stop"},
                                                                 {Permission::kReload, "reload"},
                                                                 {Permission::kLimits, "limits"},
                                                                 {Permission::kWatch, "watch"},
                                                                 {Permission::kClock, "clock"},
                                                                 {Permission::kMute, "mute"}}};

/// One row of the table: what the peers of one role may do. In patterns `*` stands for any text.
struct Rights {
  std::vector<std::string> commands{"*"};  ///< set inq prop save rest del def do rep tell
  std::vector<std::string> to{"*"};        ///< names of modules
  std::vector<std::string> slots{"*"};
  std::vector<std::string> names{"*"};  ///< which a client may take
  std::vector<std::string> files;       ///< folders; "/" is every file
  std::vector<Permission> may;
  bool operator==(const Rights&) const = default;

  bool May(Permission permission) const;
  bool AllFiles() const;
};

/// The table, by Role. What the configuration does not say is as Default() has it.
struct RightsTable {
  std::array<Rights, kRoles.size()> rows;
  static RightsTable Default();
  Rights& operator[](Role role) { return rows[static_cast<std::size_t>(role)]; }
  const Rights& operator[](Role role) const { return rows[static_cast<std::size_t>(role)]; }
  bool operator==(const RightsTable&) const = default;
};

/// Decides what a message may do, by the role of whoever it is said for. Pure but for looking up
/// where links of the file system lead. Thread: one.
/// Errors: kAccess with a sentence that names the role and the member of the table that forbids it.
class AccessControl {
 public:
  AccessControl() { set_table(RightsTable::Default()); }
  void set_table(RightsTable table) {
    table_ = std::move(table);
    for (const Role role : kRoles)
      all_files_[static_cast<std::size_t>(role)] = table_[role].AllFiles();
  }
  const RightsTable& table() const { return table_; }

  /// May it be said at all? `receiver`: the name it reaches, not an alias; empty for a report.
  vm::Result<void> CheckMessage(Role role, std::string_view receiver,
                                const vm::Message& message) const;
  /// May it say something to this peer of its own accord?
  vm::Result<void> CheckReceiver(Role role, std::string_view receiver) const;
  /// May it name the files it names? `folder`: where the receiver runs.
  vm::Result<void> CheckFiles(Role role, const vm::Message& message, const FileSlots& slots,
                              const std::string& folder) const;
  /// May it have a module run lines that the hub does not see, or no more?
  vm::Result<void> CheckUnseenLines(Role role, const std::string& receiver) const;
  vm::Result<void> CheckFile(Role role, const std::string& file, const std::string& folder) const;
  vm::Result<void> CheckName(Role role, std::string_view name) const;
  vm::Result<void> CheckPermission(Role role, Permission permission, std::string_view deed) const;
  /// True if CheckFiles can refuse nothing.
  bool AllFiles(Role role) const { return all_files_[static_cast<std::size_t>(role)]; }

 private:
  vm::Result<void> CheckMessage(Role role, std::string_view receiver, const vm::Message& message,
                                int depth) const;

  RightsTable table_;
  std::array<bool, kRoles.size()> all_files_{};
};

/// True if `file` (relative to `folder`) lies in one of `folders` (relative to where the hub runs),
/// compared name by name after `..` and links are followed. What is no plain path (unix:...,
/// tcp:...) lies in none but "/".
bool LiesWithin(const std::string& file, const std::string& folder,
                const std::vector<std::string>& folders);

}  // namespace am
