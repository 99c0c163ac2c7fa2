#pragma once

#include <sys/types.h>

#include <string>

#include "agent_manager/config/config.h"
#include "vm_protocol/core/result.h"

namespace am {

/// A program that has been started, with the hub's ends of its three pipes.
/// Ownership: the caller closes the descriptors and reaps the process.
struct Spawned {
  pid_t pid = -1;
  int to_input = -1;     ///< write: its stdin
  int from_output = -1;  ///< read: its stdout
  int from_errors = -1;  ///< read: its stderr
};

/// Starts the module's command in its own process group, with its folder, environment and resource
/// limits; it is killed when the hub dies. Blocks until exec has succeeded or failed.
/// Errors: kUnavailable if the program cannot be run, kBusy if the system lacks the means for now
/// (descriptors, processes, memory).
vm::Result<Spawned> SpawnProcess(const ModuleConfig& module);

/// "ended with code 3", "killed by signal 9, Killed": for people.
std::string DescribeEnding(int status);

}  // namespace am
