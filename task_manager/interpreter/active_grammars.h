#pragma once

#include <map>
#include <string>
#include <vector>

#include "task_manager/interpreter/grammar_set.h"
#include "task_manager/interpreter/runtime.h"

namespace vxml {

/// A grammar that listens, and what its match means.
struct ActiveGrammar {
  const srgs::Rule* rule = nullptr;
  Match::Owner owner = Match::Owner::kForm;
  const vm::xml::Node* node = nullptr;
  const VxmlDocument* document = nullptr;

  bool IsDtmf() const { return rule->grammar && rule->grammar->mode == srgs::Mode::kDtmf; }
};

/// Finds the grammars that are active while an item waits for input, in order of precedence
/// (VoiceXML 2.0 section 3.1.4): the item's own, its dialog's, its document's, the application
/// root's, the platform's. Events as of GrammarSet. Use it once.
class ActiveGrammars {
 public:
  ActiveGrammars(Runtime& runtime, GrammarSet& grammars) : rt_(runtime), grammars_(grammars) {}

  /// Those of the item alone if it is modal.
  std::vector<ActiveGrammar> Of(const FormItem& item, bool modal);

 private:
  void AddItem(const FormItem& item);
  /// A form's or menu's own grammars; of other dialogs only those with document scope.
  void AddDialog(const vm::xml::Node& dialog, bool only_document_scope);
  void AddDocument(const VxmlDocument& document);
  void AddLinks(const vm::xml::Node& parent);
  void AddChoices(const vm::xml::Node& menu);
  void AddOptions(const vm::xml::Node& field);
  /// help, cancel and exit as words of the platform (property universals).
  void AddUniversals();
  /// The <grammar>s inside the element. False: there are none.
  bool AddInside(const vm::xml::Node& element, Match::Owner owner);
  void Add(const srgs::Rule* rule, Match::Owner owner, const vm::xml::Node* node) {
    active_.push_back({rule, owner, node, document_});
  }

  Runtime& rt_;
  GrammarSet& grammars_;
  const VxmlDocument* document_ = nullptr;  ///< whose grammars are added
  std::vector<ActiveGrammar> active_;
};

}  // namespace vxml
