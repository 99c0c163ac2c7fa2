#pragma once

#include <functional>
#include <string>
#include <vector>

#include "task_manager/interpreter/dialog_session.h"
#include "task_manager/platform/input_script.h"
#include "vm_protocol/runtime/credentials.h"

namespace vxml {

/// What the command line says.
struct Options {
  std::string document;
  std::string platform = "text";
  std::vector<std::string> scripts;
  std::string transcript = "auto";  ///< json, text, none
  std::string transcript_file;
  std::string trace;  ///< file, "-" = stderr, "" = none
  std::string connect;
  vm::Credentials credentials;
  std::string name = "DM";
  std::string out;  ///< film of the dialogue, .mp4
  bool check = false;
  bool graph = false;
  bool strict = false;
  int sessions = 1;
  std::vector<std::string> allow;
  std::vector<std::string> languages;   ///< empty = every one
  std::vector<std::string> properties;  ///< NAME=VALUE
  std::vector<std::string> variables;   ///< session variables, NAME=VALUE
  int fetch_timeout_ms = 10'000;
};

/// Exit codes of the program (docs/dialogs.md).
enum ExitCode {
  kEnded = 0,       ///< exit, end or hang-up
  kFailed = 1,      ///< an error event ended it
  kNotStarted = 2,  ///< the document could not be loaded, or --check found errors
  kUsage = 3,
  kRanOut = 4,  ///< the script had no more input for the dialogue
};

SessionOptions MakeSessionOptions(const Options& options);
/// The exit code of a session; `ran_out` of input.
int CodeOf(const SessionResult& result, bool started, bool ran_out);

/// Takes a line of the transcript (JSON).
using WriteLine = std::function<void(const std::string& line)>;
/// One session in text, or with voice, ear and face at a hub; without a source the user types.
/// Errors: std::runtime_error.
int RunTextSession(const Options& options, const CommandSource& source, const WriteLine& write);
int RunAgentSession(const Options& options, int number, const CommandSource& source,
                    const WriteLine& write);
/// All sessions, each in a process of its own.
int RunSessions(const Options& options);
int RunCheck(const Options& options);
int RunGraph(const Options& options);

}  // namespace vxml
