#pragma once

#include <functional>
#include <vector>

#include "task_manager/interpreter/process_phase.h"

namespace vxml {

/// Visits a form item: the collect phase of the form interpretation algorithm (VoiceXML 2.0 section
/// 2.1.6.2.2) for each kind of item, and on to the process phase with what came of it.
/// Thread: the session's; it blocks in the platform.
class CollectPhase {
 public:
  /// Runs a subdialog until it returns, which it does by throwing ReturnToCaller.
  using RunSubdialog = std::function<void(Transition start)>;

  CollectPhase(Runtime& runtime, DocumentSet& documents, GrammarSet& grammars, PromptQueue& queue,
               Recognition& recognition, ExecutableContent& content, ProcessPhase& process,
               RunSubdialog run_subdialog)
      : rt_(runtime),
        documents_(documents),
        grammars_(grammars),
        queue_(queue),
        recognition_(recognition),
        content_(content),
        process_(process),
        run_subdialog_(std::move(run_subdialog)) {}

  void Visit(FormItem& item);

 private:
  void VisitBlock(FormItem& item);
  void VisitInput(FormItem& item);
  void VisitObject(FormItem& item);
  void VisitRecord(FormItem& item);
  void VisitSubdialog(FormItem& item);
  void VisitTransfer(FormItem& item);

  std::vector<ActiveGrammar> GrammarsOf(const FormItem& item, bool modal) {
    return ActiveGrammars(rt_, grammars_).Of(item, modal);
  }
  /// The values of its <param> elements.
  NamedValues ParametersOf(const vm::xml::Node& node);
  TalkRequest MakeTalkRequest(const FormItem& item);
  RecordRequest MakeRecordRequest(const FormItem& item, const std::vector<ActiveGrammar>& active);
  TransferRequest MakeTransferRequest(const FormItem& item);
  /// Sets the shadow variable; the recording is returned.
  script::Value KeepRecording(const FormItem& item, const RecordResult& result,
                              const std::string& type, const std::string& termchar);

  Runtime& rt_;
  DocumentSet& documents_;
  GrammarSet& grammars_;
  PromptQueue& queue_;
  Recognition& recognition_;
  ExecutableContent& content_;
  ProcessPhase& process_;
  RunSubdialog run_subdialog_;
};

}  // namespace vxml
