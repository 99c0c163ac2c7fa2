#pragma once

#include <spawn.h>
#include <sys/types.h>

#include <string>
#include <vector>

namespace vm {

/// Starts a program with descriptors of ours as its own; others that close themselves on exec it
/// does not get. It has a process group of its own, so that Ctrl-C at the terminal reaches us alone
/// and we can end it properly, and signals as a new program expects them, whatever ours are set to.
/// No shell is involved. Thread: one.
class Spawn {
 public:
  Spawn();
  ~Spawn();
  Spawn(const Spawn&) = delete;

  /// `as`: the program's descriptor; `flags` as of open(2).
  void Give(int fd, int as);
  void Open(const std::string& path, int flags, int as);
  /// Starts argv[0], found along PATH. 0, or the system's error. REQUIRES: argv is not empty.
  int Start(const std::vector<std::string>& argv, pid_t& pid);

 private:
  posix_spawn_file_actions_t files_;
  posix_spawnattr_t attributes_;
};

/// The path of a program that lies in the folder of this one; the name alone, to be found along
/// PATH, where that folder is not known.
std::string ProgramBeside(const std::string& name);

}  // namespace vm
