#pragma once

#include <string>

#include "task_manager/interpreter/form_interpreter.h"

namespace vxml {

struct SessionResult {
  std::string reason;  ///< exit, end, hangup, error.<...>, limit
  std::string value_json = "undefined";
  bool failed = false;  ///< the document could not be started, or an error ended it
};

/// One dialogue: runs documents from the first dialog to the end, and subdialogs in execution
/// contexts of their own. Owns the parts of the interpreter; each uses those before it:
///
///     Runtime <- PromptQueue <- DocumentSet <- GrammarSet, PromptWriter <- Recognition,
///     ExecutableContent <- EventHandling, ProcessPhase <- CollectPhase <- FormInterpreter
///
/// Thread: one; Run blocks in the platform. The platform outlives the session.
class DialogSession {
 public:
  DialogSession(SessionOptions options, Platform& platform);
  DialogSession(const DialogSession&) = delete;
  DialogSession& operator=(const DialogSession&) = delete;

  SessionResult Run();
  /// True once the first document was loaded.
  bool started() const { return !documents_.empty(); }

 private:
  void Start();
  /// Runs dialogs until one ends without naming the next.
  void RunDialogs(Transition next);
  void RunSubdialog(Transition start);
  void Enter(const Transition& to);
  void EnterDocument(const Transition& to);
  /// Runs the <var>, <script> and <data> of a document.
  void InitDocument(const VxmlDocument& document);

  Runtime rt_;
  PromptQueue queue_;
  DocumentSet documents_;
  GrammarSet grammars_;
  PromptWriter prompts_;
  Recognition recognition_;
  ExecutableContent content_;
  EventHandling events_;
  ProcessPhase process_;
  CollectPhase collect_;
  FormInterpreter forms_;
  std::size_t subdialogs_ = 0;  ///< one inside the other
};

}  // namespace vxml
