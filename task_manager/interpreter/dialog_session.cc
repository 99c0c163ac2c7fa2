#include "task_manager/interpreter/dialog_session.h"

#include "task_manager/interpreter/scope_guard.h"

namespace vxml {

using script::Value;

DialogSession::DialogSession(SessionOptions options, Platform& platform)
    : options_(std::move(options)),
      platform_(platform),
      fetcher_(options_.fetch),
      engine_(options_.script),
      budget_(options_.max_steps_between_inputs, options_.max_time_between_inputs) {
  grammars_ = std::make_unique<srgs::GrammarStore>(
      [this](const std::string& uri) -> vm::Result<std::string> {
        fetch::Request request = FetchOptions(Here(), "grammar");
        request.uri = uri;
        request.from.clear();  // the store has judged who asks
        auto got = fetcher_.Fetch(request);
        if (!got) return std::unexpected(static_cast<vm::Error>(got.error()));
        return std::move(got->body);
      });
}

DialogSession::~DialogSession() = default;

SessionResult DialogSession::Run() {
  SessionResult result;
  Context nowhere;
  nowhere.document = std::make_shared<VxmlDocument>();
  nowhere.document->root = std::make_unique<vm::xml::Node>();
  nowhere.document->uri = nowhere.document->base = options_.uri;
  nowhere.root = nowhere.document;
  nowhere.application = nowhere.variables = engine_.NewScope();
  nowhere.names = engine_.NewScope();
  try {
    context_ = &nowhere;
    budget_.Renew();
    MakeSessionScope();
    Transition start = Locate(*nowhere.document->root, options_.uri, "document");
    start.same_document = false;
    RunContext(std::move(start));
    FinishPrompts();
    result.reason = "end";
  } catch (const ExitSession& exit) {
    context_ = context_ ? context_ : &nowhere;
    FinishPrompts();
    result.reason = exit.reason;
    result.value_json = exit.value_json;
    result.failed = exit.reason.starts_with("error");
  } catch (const EventThrown& event) {  // before any document ran
    result.reason = event.name;
    result.failed = true;
    JsonLine line;
    line.Text("name", event.name).Text("message", event.message);
    platform_.Report("event", line);
  }
  JsonLine line;
  line.Text("reason", result.reason).Raw("value", result.value_json);
  platform_.Report("exit", line);
  return result;
}

/// At the end what is still queued is played (VoiceXML 2.0 section 4.1.8).
void DialogSession::FinishPrompts() {
  try {
    if (!hung_up_ && !disconnected_) Flush();
  } catch (const EventThrown&) {
    queue_.clear();
  }
}

void DialogSession::MakeSessionScope() {
  session_scope_ = engine_.NewScope();
  std::map<std::string, std::string> variables = {{"connection.local.uri", "galatea:agent"},
                                                  {"connection.remote.uri", "galatea:user"},
                                                  {"connection.protocol.name", "galatea"},
                                                  {"connection.protocol.version", "1.0"},
                                                  {"connection.originator", "connection.remote"},
                                                  {"connection.aai", ""},
                                                  {"connection.redirect", ""}};
  for (const auto& [name, value] : options_.session_variables) variables[name] = value;
  for (const auto& [path, text] : variables) {
    Value at = session_scope_;
    std::size_t from = 0;
    for (std::size_t dot; (dot = path.find('.', from)) != std::string::npos; from = dot + 1) {
      const std::string part = path.substr(from, dot - from);
      if (!engine_.Has(at, part)) engine_.Set(at, part, engine_.Object());
      at = engine_.Get(at, part);
    }
    engine_.Set(at, path.substr(from), engine_.String(text));
  }
  const Value connection = engine_.Get(session_scope_, "connection");
  if (engine_.ToString(engine_.Get(connection, "originator")) == "connection.remote") {
    engine_.Set(connection, "originator", engine_.Get(connection, "remote"));
  }
  if (engine_.ToString(engine_.Get(connection, "redirect")).empty()) {
    engine_.Set(connection, "redirect", engine_.Undefined());
  }
  engine_.Freeze(connection);
  engine_.Freeze(session_scope_);
}

/// Runs dialogs until one ends without naming the next.
void DialogSession::RunContext(Transition start) {
  Context context;
  Context* outer = context_;
  if (outer) {
    context.is_subdialog = subdialogs_ > 0;
    if (context.is_subdialog) context.parameters = std::move(outer->parameters);
  }
  Dialog* outer_dialog = std::exchange(dialog_, nullptr);
  Item* outer_item = std::exchange(scope_item_, nullptr);
  const vm::xml::Node* outer_node = std::exchange(active_node_, nullptr);
  auto outer_anonymous = std::exchange(anonymous_, {});
  const bool outer_in_handler = std::exchange(in_handler_, false);
  struct Restore {
    std::function<void()> back;
    ~Restore() { back(); }
  } restore{[&] {
    context_ = outer;
    dialog_ = outer_dialog;
    scope_item_ = outer_item;
    active_node_ = outer_node;
    anonymous_ = std::move(outer_anonymous);
    in_handler_ = outer_in_handler;
  }};
  context_ = &context;
  Transition next = std::move(start);
  while (true) {
    try {
      dialog_ = nullptr;
      scope_item_ = nullptr;
      active_node_ = nullptr;
      anonymous_.clear();
      try {
        Enter(next);
      } catch (const EventThrown& event) {
        HandleEvent(event, nullptr);
      }
      if (!next.dialog) return;
      RunDialog(*next.dialog, next.carried);
      return;
    } catch (Transition& transition) {
      next = std::move(transition);
    } catch (const EventThrown& event) {
      // Out of a handler of the document: nobody is left to handle it.
      throw ExitSession{event.name};
    }
  }
}

void DialogSession::Enter(Transition& transition) {
  JsonLine line;
  line.Text("document", transition.document->uri)
      .Text("dialog", transition.dialog ? transition.dialog->Get("id") : "")
      .Bool("same_document", transition.same_document);
  Trace("enter", line);
  if (transition.same_document && context_->document == transition.document) return;
  EnterApplication(transition);
  const bool is_root = transition.document == transition.root;
  context_->document = transition.document;
  if (is_root) {
    context_->variables = context_->application;
    engine_.Set(context_->names, "document", context_->variables);
    return;
  }
  context_->variables = engine_.NewScope();
  engine_.Set(context_->names, "document", context_->variables);
  InitDocument(*context_->document, context_->variables);
}

/// The application's variables stay while its root stays (VoiceXML 2.0 section 1.5.2).
void DialogSession::EnterApplication(const Transition& transition) {
  const bool stays =
      context_->root && context_->root->uri == transition.root->uri &&
      context_->application.valid() && !transition.fresh_application &&
      (context_->document != context_->root || transition.document != transition.root);
  if (stays) {
    return;
  }
  context_->root = transition.root;
  context_->document = transition.root;
  context_->names = engine_.NewScope();
  context_->application = engine_.NewScope();
  context_->variables = context_->application;
  engine_.SetReadOnly(context_->names, "session", session_scope_);
  engine_.SetReadOnly(context_->names, "application", context_->application);
  engine_.Set(context_->names, "document", context_->application);
  InitDocument(*transition.root, context_->application);
}

void DialogSession::InitDocument(const VxmlDocument& document, const Value& scope) {
  static_cast<void>(scope);  // the innermost scope while no dialog runs
  for (const auto& child : document.root->children) {
    if (!child->IsElement()) continue;
    if (child->name == "var" || child->name == "script" || child->name == "data") {
      active_node_ = child.get();
      RunElement(*child);
    }
  }
  active_node_ = nullptr;
}

}  // namespace vxml
