#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "task_manager/document/vxml_document.h"
#include "task_manager/fetch/fetcher.h"
#include "task_manager/grammar/store.h"
#include "task_manager/interpreter/budget.h"
#include "task_manager/interpreter/signals.h"
#include "task_manager/platform/platform.h"
#include "task_manager/script/engine.h"

namespace vxml {

struct SessionOptions {
  std::string uri;
  fetch::Options fetch{};
  script::Limits script{};
  std::map<std::string, std::string> properties{};          ///< platform defaults to change
  std::map<std::string, std::string> session_variables{};   ///< "connection.remote.uri" -> value
  std::size_t max_steps_between_inputs = 100'000;           ///< elements and items executed
  std::chrono::milliseconds max_time_between_inputs{2500};  ///< of the processor
  std::size_t max_subdialogs = 40;                          ///< one inside the other
  bool strict_markup = false;  ///< unknown emotions are error.unsupported.emotion
  /// Languages (en, ja-JP, ...) there is a voice and an ear for; empty = every language there is.
  std::vector<std::string> languages{};
  /// Explains what the interpreter does; null = nobody wants to know.
  std::function<void(std::string_view kind, const JsonLine& fields)> trace{};
};

struct SessionResult {
  std::string reason;  ///< exit, end, hangup, error.<...>, limit
  std::string value_json = "undefined";
  bool failed = false;  ///< the document could not be started, or an error ended it
};

/// An execution context: documents and their scopes. A subdialog has its own.
struct Context {
  std::shared_ptr<VxmlDocument> document;
  std::shared_ptr<VxmlDocument> root;
  script::Value names;  ///< the scopes by their names
  script::Value application;
  script::Value variables;  ///< document scope
  bool is_subdialog = false;
  std::vector<std::pair<std::string, script::Value>> parameters;
};

enum class ItemKind { kBlock, kInitial, kField, kRecord, kTransfer, kSubdialog, kObject, kMenu };

struct Item {
  const vm::xml::Node* node = nullptr;
  ItemKind kind = ItemKind::kBlock;
  std::string name;  ///< generated if the document gives none
  int prompt_count = 1;
  std::map<std::string, int> events;
  bool over = false;  ///< a block that only <clear/> of all items lets run again
  bool IsInput() const { return kind != ItemKind::kBlock && kind != ItemKind::kInitial; }
};

struct Dialog {
  const vm::xml::Node* node = nullptr;
  script::Value scope;
  std::vector<Item> items;
  std::map<std::string, int> events;
  std::string next_item;
  /// While no script has run since, the items before this one are not to be visited.
  std::size_t first_open = 0;
  std::uint64_t first_open_at = 0;  ///< Engine::changes() then
};

/// A grammar that listens, and what its match means.
struct ActiveGrammar {
  const srgs::Rule* rule = nullptr;
  Match::Owner owner = Match::Owner::kForm;
  const vm::xml::Node* node = nullptr;
  const VxmlDocument* document = nullptr;
};

/// One dialogue: the form interpretation algorithm (VoiceXML 2.0 appendix C) over a document, from
/// its first dialog to its end. Owns its script engine, variables and grammars.
/// Thread: one; Run blocks in the platform. The platform outlives the session.
class DialogSession {
 public:
  DialogSession(SessionOptions options, Platform& platform);
  ~DialogSession();
  DialogSession(const DialogSession&) = delete;
  DialogSession& operator=(const DialogSession&) = delete;

  SessionResult Run();
  /// True once the first document was loaded.
  bool started() const { return !parsed_.empty(); }

 private:
  friend class PromptBuilder;
  class ScopeGuard;

  // session.cc: the life of documents
  void MakeSessionScope();
  void RunContext(Transition start);
  void Enter(Transition& transition);
  void EnterApplication(const Transition& transition);
  void InitDocument(const VxmlDocument& document, const script::Value& scope);
  void FinishPrompts();

  // loading.cc
  std::shared_ptr<VxmlDocument> Load(const fetch::Request& request);
  std::shared_ptr<VxmlDocument> LoadRoot(const VxmlDocument& document);
  fetch::Response FetchFor(const vm::xml::Node& node, fetch::Request request, const char* kind);
  [[noreturn]] void ThrowFetch(const fetch::Failure& failure);
  Transition Locate(const vm::xml::Node& node, const std::string& uri, const char* kind,
                    std::vector<fetch::Field> fields = {}, bool post = false,
                    bool multipart = false, bool is_submit = false);
  fetch::Request FetchOptions(const vm::xml::Node& node, const char* kind);
  std::string BaseOf(const vm::xml::Node& node) const;
  /// The document the element was written in: its origin decides what the element may do.
  const VxmlDocument& OriginOf(const vm::xml::Node& node) const;
  void RequireLocal(const vm::xml::Node& node) const;

  // form.cc: the form interpretation algorithm
  void RunDialog(const vm::xml::Node& node, std::shared_ptr<Match> carried);
  void InitForm(Dialog& dialog);
  void InitItem(Dialog& dialog, const vm::xml::Node& node);
  Item* Select();
  /// Its variable has a value, or it is a block that has run.
  bool IsDone(const Item& item);
  void QueuePrompts(Item& item);
  void Visit(Item& item);
  void VisitInput(Item& item);
  void Fill(const Match& match, Item* current, std::set<std::string>& filled);
  void SetShadow(const std::string& name, const Match& match);
  void RunFilled(const std::set<std::string>& filled);
  bool FormFilledApplies(const vm::xml::Node& node, const std::set<std::string>& filled);
  void TakeMatch(const Match& match, Item* current);
  void FollowTarget(const vm::xml::Node& node, const VxmlDocument& document);
  void TransitTo(const Match& match, const vm::xml::Node* dialog);

  // items.cc
  void VisitSubdialog(Item& item);
  void VisitRecord(Item& item);
  script::Value RecordingObject(const std::string& uri, const std::string& type, Millis duration);
  bool IsRecording(const script::Value& value);
  void VisitTransfer(Item& item);
  void VisitObject(Item& item);
  void FillPlain(Item& item, const script::Value& value);

  // input.cc: listening and recognising
  Listen MakeListen(const Item& item, const std::vector<ActiveGrammar>& active);
  std::vector<Match> Recognize(const Input& input, const std::vector<ActiveGrammar>& active,
                               bool& below_confidence);
  std::optional<Match> MatchText(const std::string& text, bool dtmf,
                                 const std::vector<ActiveGrammar>& active);
  void SetLastResult(const std::vector<Match>& matches, const Input& input);
  Match HandleInput(const Input& input, const std::vector<ActiveGrammar>& active);

  // grammars.cc: which grammars listen
  std::vector<ActiveGrammar> ActiveGrammars(const Item& item, bool modal);
  void AddItemGrammars(const Item& item, std::vector<ActiveGrammar>& active);
  void AddDialogGrammars(const vm::xml::Node& dialog, const VxmlDocument& document,
                         bool only_document, std::vector<ActiveGrammar>& active);
  void AddLinks(const vm::xml::Node& parent, const VxmlDocument& document,
                std::vector<ActiveGrammar>& active);
  void AddGrammar(const vm::xml::Node& grammar, const VxmlDocument& document, Match::Owner owner,
                  const vm::xml::Node& target, std::vector<ActiveGrammar>& active);
  void AddChoices(const vm::xml::Node& menu, const VxmlDocument& document,
                  std::vector<ActiveGrammar>& active);
  void AddOptions(const vm::xml::Node& field, const VxmlDocument& document,
                  std::vector<ActiveGrammar>& active);
  void AddUniversals(std::vector<ActiveGrammar>& active);
  void AddBuiltin(const std::string& name, const vm::xml::Node& node, const VxmlDocument& document,
                  std::vector<ActiveGrammar>& active);
  const srgs::Rule* CompileGrammar(const vm::xml::Node& node, const VxmlDocument& document);
  const srgs::Rule* CompileExternal(const vm::xml::Node& node, const VxmlDocument& document,
                                    const std::string& reference);
  const srgs::Rule* MakePhrase(const std::string& key, const std::string& text, bool approximate,
                               bool dtmf, const std::string& value, bool has_value);

  // events.cc
  bool HandleEvent(EventThrown event, Item* item);
  void CountEvent(const std::string& name, Item* item);
  struct Handler {
    const vm::xml::Node* node = nullptr;
    int count = 1;
    int counter = 1;
    std::string default_action;  ///< of the platform's own handlers
  };
  std::optional<Handler> FindHandler(const EventThrown& event, Item* item);
  void CollectHandlers(const vm::xml::Node& scope, const EventThrown& event, Item* item,
                       std::vector<Handler>& into);
  int CounterOf(const std::string& prefix, Item* item) const;
  bool RunHandler(const Handler& handler, const EventThrown& event);
  void RunDefault(const std::string& action, const EventThrown& event);

  // content.cc: executable content
  void RunContent(const vm::xml::Node& parent);
  void RunElement(const vm::xml::Node& node);
  void RunIf(const vm::xml::Node& node);
  void RunForeach(const vm::xml::Node& node);
  void RunVar(const vm::xml::Node& node);
  void RunAssign(const vm::xml::Node& node);
  void RunClear(const vm::xml::Node& node);
  void RunScript(const vm::xml::Node& node);
  void RunLog(const vm::xml::Node& node);
  void RunThrow(const vm::xml::Node& node);
  void RunNative(const vm::xml::Node& node);
  std::vector<std::string> NativeLines(const vm::xml::Node& node);

  // transfer_of_control.cc
  void RunGoto(const vm::xml::Node& node);
  void RunSubmit(const vm::xml::Node& node);
  void RunExit(const vm::xml::Node& node);
  void RunReturn(const vm::xml::Node& node);
  void RunDisconnect(const vm::xml::Node& node);
  void RunData(const vm::xml::Node& node);
  std::vector<fetch::Field> SubmitFields(const vm::xml::Node& node, const std::string& namelist);
  void Flatten(const std::string& name, const script::Value& value,
               std::vector<fetch::Field>& fields, int depth);

  // evaluation.cc
  script::Chain CurrentChain() const;
  /// error.noresource for what went over a limit, else error.semantic.
  [[noreturn]] void ThrowScript(const vm::xml::Node& node, const std::string& code,
                                const vm::Error& error);
  script::Value Evaluate(const vm::xml::Node& node, const std::string& expression);
  bool Condition(const vm::xml::Node& node, const std::string& attribute = "cond");
  std::string TextOf(const vm::xml::Node& node, const std::string& expression);
  void Declare(const vm::xml::Node& node, const std::string& name, const script::Value& value);
  void Store(const std::string& name, const script::Value& value);  ///< dialog scope
  script::Value Variable(const std::string& name);
  bool IsDeclared(const std::string& name);
  bool IsDeclaredBeforeSession(const std::string& base);
  std::string Property(const std::string& name, const vm::xml::Node* from = nullptr);
  Millis TimeProperty(const std::string& name, Millis otherwise);
  std::string LanguageAt(const vm::xml::Node& node) const;
  void RequireLanguage(const std::string& language);
  const vm::xml::Node& Here() const;
  /// Counts against the budget: an element is one, what it writes or says is more.
  void Step(std::size_t cost = 1);
  static constexpr std::size_t kBytesOfAStep = 256;
  void Trace(std::string_view kind, const JsonLine& fields);

  // prompts.cc
  void QueuePrompt(const vm::xml::Node& node);
  void QueueImplicit(const std::vector<const vm::xml::Node*>& nodes);
  void Flush();

  SessionOptions options_;
  Platform& platform_;
  fetch::Fetcher fetcher_;
  script::Engine engine_;
  std::unique_ptr<srgs::GrammarStore> grammars_;
  std::map<const vm::xml::Node*, const srgs::Rule*> compiled_;
  std::map<std::string, const srgs::Rule*> phrases_;
  /// By URI and hash of the bytes; kept, since compiled_ names their nodes.
  std::vector<std::pair<std::pair<std::string, std::size_t>, std::shared_ptr<VxmlDocument>>>
      parsed_;

  script::Value session_scope_;
  Context* context_ = nullptr;
  Dialog* dialog_ = nullptr;
  Item* scope_item_ = nullptr;  ///< whose handlers come first
  const vm::xml::Node* active_node_ = nullptr;
  std::vector<script::Value> anonymous_;
  std::vector<Prompt> queue_;
  Budget budget_;
  std::size_t subdialogs_ = 0;
  int handler_depth_ = 0;
  bool in_handler_ = false;
  bool reprompt_ = false;
  bool hung_up_ = false;
  bool disconnected_ = false;
  unsigned generated_names_ = 0;
  std::map<std::string, int> document_events_;  ///< counters while no dialog runs
};

/// "5s", "250ms", "1.5s", "+2s"; none if it is no time designation.
std::optional<Millis> ParseTime(std::string_view text);

}  // namespace vxml
