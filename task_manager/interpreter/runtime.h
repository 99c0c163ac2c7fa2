#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "task_manager/interpreter/budget.h"
#include "task_manager/interpreter/position.h"
#include "task_manager/interpreter/properties.h"
#include "task_manager/interpreter/scopes.h"
#include "task_manager/interpreter/session_options.h"
#include "task_manager/platform/platform.h"

namespace vxml {

/// The line to the user. Once closed it stays so: nothing is heard or said any more.
class Connection {
 public:
  bool is_open() const { return open_; }
  void Close() { open_ = false; }
  /// The user hung up.
  [[noreturn]] void HangUp() {
    Close();
    ThrowEvent("connection.disconnect.hangup");
  }
  /// Who waits for input on a closed line ends the session.
  void RequireOpen() const {
    if (!open_) throw ExitSession{"hangup"};
  }

 private:
  bool open_ = true;
};

/// What every part of an interpreter stands on; rules of the standard are in the parts.
struct Runtime {
  Runtime(SessionOptions given, Platform& its_platform);

  const SessionOptions options;
  Platform& platform;
  script::Engine engine;
  Connection connection;
  Budget budget;
  Position position;
  Properties properties;
  Scopes scopes;

  void Trace(std::string_view kind, const JsonLine& fields) const;
  /// A line of the trace that says what is wrong with the element.
  void Warn(const std::string& text, std::size_t line) const;
  /// Throws error.unsupported.language unless there is a voice and an ear for it.
  void RequireLanguage(const std::string& language) const;
  /// <foreach>: a copy of the array, so that changes inside do not change the turns. Throws
  /// error.semantic if it is none, error.noresource if it is too long.
  script::Value ArrayOf(const vm::xml::Node& foreach);
};

/// A recording as a script sees it; <audio>, <value> and submitting take it.
script::Value MakeRecording(script::Engine& engine, const std::string& uri, const std::string& type,
                            Millis duration);
bool IsRecording(script::Engine& engine, const script::Value& value);

}  // namespace vxml
