#pragma once

#include <map>
#include <string>

#include "task_manager/grammar/store.h"
#include "task_manager/interpreter/document_set.h"
#include "task_manager/interpreter/phrase_grammar.h"
#include "task_manager/interpreter/runtime.h"

namespace vxml {

/// The grammars a session has compiled, each once. A grammar that cannot be had is thrown as the
/// event VoiceXML 2.0 section 5.2.6 names: error.badfetch, error.noauthorization,
/// error.unsupported.format, .builtin or .language. Rules live as long as the set.
/// Thread: the session's.
class GrammarSet {
 public:
  GrammarSet(Runtime& runtime, DocumentSet& documents);

  /// The rule of a <grammar> element of the document.
  const srgs::Rule* Compile(const vm::xml::Node& grammar, const VxmlDocument& document);
  const srgs::Rule* Compile(const Phrase& phrase);
  /// A built-in type ("digits?length=4") in the language of the element.
  const srgs::Rule* Builtin(const std::string& type, const vm::xml::Node& node, srgs::Mode mode);

 private:
  const srgs::Rule* CompileInline(const vm::xml::Node& grammar, const VxmlDocument& document);
  const srgs::Rule* CompileExternal(const vm::xml::Node& grammar, const VxmlDocument& document,
                                    const std::string& reference);
  /// The grammar, linked; `event` is thrown if that fails.
  const srgs::Grammar& Add(std::unique_ptr<srgs::Grammar> grammar, const char* event);

  Runtime& rt_;
  srgs::GrammarStore store_;
  std::map<const vm::xml::Node*, const srgs::Rule*> of_elements_;
  std::map<std::string, const srgs::Rule*> of_phrases_;  ///< by Phrase::Key
  std::map<std::string, const srgs::Rule*> of_types_;
};

}  // namespace vxml
