#pragma once

#include <optional>
#include <string>
#include <vector>

#include "task_manager/interpreter/active_grammars.h"
#include "task_manager/interpreter/prompt_queue.h"

namespace vxml {

/// From what came in to what it means: matches it against the active grammars, sets
/// application.lastresult$. Thread: the session's.
class Recognition {
 public:
  Recognition(Runtime& runtime, const PromptQueue& queue) : rt_(runtime), queue_(queue) {}

  /// What the platform has to know while it waits. `active` outlives the result.
  Listen MakeListen(const FormItem& item, const std::vector<ActiveGrammar>& active) const;
  /// Before input is waited for: application.lastresult$ becomes undefined (VoiceXML 2.0 section
  /// 5.1.5).
  void Forget() { rt_.scopes.SetLastResult(rt_.engine.Undefined()); }
  /// The best match of what came in; everything else is thrown as its event (noinput, nomatch,
  /// maxspeechtimeout, connection.disconnect.hangup).
  Match Interpret(const Input& input, const std::vector<ActiveGrammar>& active);
  /// Sets utterance, confidence, inputmode and interpretation (VoiceXML 2.0 sections 2.3.1, 5.1.5).
  void Describe(const script::Value& into, const Match& match) const;

 private:
  /// What was heard but not understood, as matches without an owner; at least one.
  std::vector<Match> HeardIn(const Input& input) const;
  std::vector<Match> MatchesOf(const Input& input, const std::vector<ActiveGrammar>& active,
                               bool& below_confidence);
  std::optional<Match> MatchText(const std::string& text, bool dtmf,
                                 const std::vector<ActiveGrammar>& active);
  /// REQUIRES: at least one match.
  void SetLastResult(const std::vector<Match>& matches, const Input& input);

  Runtime& rt_;
  const PromptQueue& queue_;
};

}  // namespace vxml
