#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vm_protocol/core/module.h"

namespace CLI {
class App;
}

namespace vm {

/// What a module's program tells the runtime about itself.
struct ProgramInfo {
  std::string name{};         ///< "ssm"
  std::string description{};  ///< first line of --help
  std::string
      module_name{};  ///< "SSM": what it is called in the protocol when nothing else is said
  unsigned short original_port =
      0;  ///< what `-p` listens on by default in the original's socket mode
  bool virtual_by_default = false;  ///< --clock auto may choose the virtual clock for a piped batch
  /// Adds the program's own options.
  std::function<void(CLI::App&)> add_options{};
  /// Called after the options are read; may return -1 to go on, else the process exits with it
  /// (for things like --sheet which need no protocol).
  std::function<int()> before_start{};
  /// True if the options read make the module wait for real devices or windows: the clock is real.
  std::function<bool()> needs_real_clock{};
  /// Builds the core. Throws std::runtime_error with a sentence when the world refuses.
  std::function<std::unique_ptr<Module>(Scheduler&, boost::asio::io_context&)> make{};
};

/// The whole life of a module program: options, streams, clock, end. Gives every module
///   (no options)                 lines on stdin and stdout
///   --listen unix:PATH|tcp:H:P|tls:H:P   clients come to it (several; answers go to who asked)
///   --connect unix:PATH|tcp:H:P|tls:H:P [--name NAME]   it goes to a hub
///   --token-file FILE, --certificate, --key, --authority   what is shown and asked for there
///   -p PORT                      the original's socket mode ("./" framing, one client)
///   --framing lf|mmi|auto, --encoding utf-8|euc-jp|shift_jis
///   --clock auto|real|virtual    auto: virtual for a batch piped into a module that allows it
///   --strict                     exit code 1 if any error was seen
///   --slots-markdown, --help, --version
/// and the slots Clock, Clock.mode and Wait (docs/protocol.md). Returns the exit code.
int RunModule(int argc, char** argv, const ProgramInfo& info);

}  // namespace vm
