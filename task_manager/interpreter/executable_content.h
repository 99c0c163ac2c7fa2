#pragma once

#include <string>
#include <vector>

#include "task_manager/interpreter/document_set.h"
#include "task_manager/interpreter/prompt_writer.h"

namespace vxml {

/// Runs the elements of blocks, handlers and <filled> (VoiceXML 2.0 section 5.3). What leads away
/// from them is thrown (signals.h). Thread: the session's.
class ExecutableContent {
 public:
  ExecutableContent(Runtime& runtime, DocumentSet& documents, PromptQueue& queue,
                    PromptWriter& prompts)
      : rt_(runtime), documents_(documents), queue_(queue), prompts_(prompts) {}

  /// What stands in the element, in order.
  void RunInside(const vm::xml::Node& parent);
  /// The same in an anonymous scope of its own.
  void RunBlock(const vm::xml::Node& parent);
  void RunElement(const vm::xml::Node& node);
  /// The <var>, <script> and <data> of a document or form, one of them at a time.
  static bool IsInitial(const vm::xml::Node& node) {
    return node.IsElement("var") || node.IsElement("script") || node.IsElement("data");
  }
  /// Like RunInside, for a handler: <reprompt> counts there alone. True if there was one.
  bool RunHandler(const vm::xml::Node& handler);

 private:
  using Nodes = std::vector<const vm::xml::Node*>;
  void Run(const Nodes& nodes);

  void RunAssign(const vm::xml::Node& node);
  void RunClear(const vm::xml::Node& node);
  void RunForeach(const vm::xml::Node& node);
  void RunIf(const vm::xml::Node& node);
  void RunLog(const vm::xml::Node& node);
  void RunNative(const vm::xml::Node& node);
  void RunPrompt(const vm::xml::Node& node);
  void RunReprompt(const vm::xml::Node& node);
  void RunScript(const vm::xml::Node& node);
  void RunVar(const vm::xml::Node& node);
  // data_element.cc
  void RunData(const vm::xml::Node& node);
  // transfer_of_control.cc
  void RunDisconnect(const vm::xml::Node& node);
  void RunExit(const vm::xml::Node& node);
  void RunGoto(const vm::xml::Node& node);
  void RunReturn(const vm::xml::Node& node);
  void RunSubmit(const vm::xml::Node& node);
  void RunThrow(const vm::xml::Node& node);
  /// The variables of a namelist as the JSON of an object.
  std::string JsonOf(const vm::xml::Node& node, const std::string& namelist);

  Runtime& rt_;
  DocumentSet& documents_;
  PromptQueue& queue_;
  PromptWriter& prompts_;
  bool in_handler_ = false;
  bool reprompt_ = false;
};

}  // namespace vxml
