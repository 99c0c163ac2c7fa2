#pragma once

#include <set>
#include <string>

#include "task_manager/interpreter/executable_content.h"
#include "task_manager/interpreter/recognition.h"

namespace vxml {

/// The process phase of the form interpretation algorithm (VoiceXML 2.0 section 2.1.6.2.3): what an
/// input leads to. Thread: the session's.
class ProcessPhase {
 public:
  ProcessPhase(Runtime& runtime, DocumentSet& documents, const Recognition& recognition,
               ExecutableContent& content)
      : rt_(runtime), documents_(documents), recognition_(recognition), content_(content) {}

  /// Fills variables and runs <filled>, or throws where a link, choice or another dialog's grammar
  /// leads. `current` is the item that waited, null if the match was carried into its dialog.
  void Process(const Match& match, FormItem* current);
  /// The item's variable gets a value that no grammar gave; its <filled> follow.
  void FillPlain(const FormItem& item, const script::Value& value);

 private:
  using Names = std::set<std::string>;
  [[noreturn]] void TransitTo(const Match& match, const vm::xml::Node* dialog);
  /// A link or choice that was chosen: on to its document, or its event.
  [[noreturn]] void FollowTarget(const vm::xml::Node& node, const VxmlDocument& document);
  /// The names of the items that got a value (VoiceXML 2.0 section 3.1.6).
  Names FillItem(const Match& match, const FormItem& item);
  Names FillForm(const Match& match);
  void Store(const FormItem& item, const script::Value& value, const Match& match);
  void Report(const FormItem& item);
  /// "a.b" of a result looked up part by part; invalid or undefined if it is not there.
  script::Value Slot(script::Value value, const std::string& path);
  void RunFilled(const Names& filled);
  bool FormFilledApplies(const vm::xml::Node& node, const Names& filled);

  Runtime& rt_;
  DocumentSet& documents_;
  const Recognition& recognition_;
  ExecutableContent& content_;
};

}  // namespace vxml
