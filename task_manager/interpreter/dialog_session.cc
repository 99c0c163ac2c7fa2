#include "task_manager/interpreter/dialog_session.h"

#include <map>
#include <utility>

namespace vxml {

DialogSession::DialogSession(SessionOptions options, Platform& platform)
    : rt_(std::move(options), platform),
      queue_(rt_),
      documents_(rt_, queue_),
      grammars_(rt_, documents_),
      prompts_(rt_, documents_, queue_),
      recognition_(rt_, queue_),
      content_(rt_, documents_, queue_, prompts_),
      events_(rt_, content_, prompts_),
      process_(rt_, documents_, recognition_, content_),
      collect_(rt_, documents_, grammars_, queue_, recognition_, content_, process_,
               [this](Transition start) { RunSubdialog(std::move(start)); }),
      forms_(rt_, prompts_, content_, events_, collect_, process_) {}

SessionResult DialogSession::Run() {
  SessionResult result;
  try {
    Start();
    queue_.Finish();
    result.reason = "end";
  } catch (const ExitSession& exit) {
    queue_.Finish();
    result.reason = exit.reason;
    result.value_json = exit.value_json;
    result.failed = exit.reason.starts_with("error");
  } catch (const EventThrown& event) {  // before any document ran
    result.reason = event.name;
    result.failed = true;
    JsonLine line;
    line.Text("name", event.name).Text("message", event.message);
    rt_.platform.Report("event", line);
  }
  JsonLine line;
  line.Text("reason", result.reason).Raw("value", result.value_json);
  rt_.platform.Report("exit", line);
  return result;
}

void DialogSession::Start() {
  std::map<std::string, std::string> variables = {{"connection.local.uri", "galatea:agent"},
                                                  {"connection.remote.uri", "galatea:user"},
                                                  {"connection.protocol.name", "galatea"},
                                                  {"connection.protocol.version", "1.0"},
                                                  {"connection.originator", "connection.remote"},
                                                  {"connection.aai", ""},
                                                  {"connection.redirect", ""}};
  for (const auto& [name, value] : rt_.options.session_variables) variables[name] = value;
  rt_.budget.Renew();
  rt_.scopes.MakeSession(variables);
  // The first document is referred to from an empty one that stands at its place.
  auto nowhere = std::make_shared<VxmlDocument>();
  nowhere->root = std::make_unique<vm::xml::Node>();
  nowhere->uri = nowhere->base = rt_.options.uri;
  rt_.position.document = rt_.position.root = nowhere;
  Transition start = documents_.Locate(*nowhere->root, rt_.options.uri);
  start.same_document = false;
  RunDialogs(std::move(start));
}

void DialogSession::RunSubdialog(Transition start) {
  if (subdialogs_ >= rt_.options.max_subdialogs) {
    ThrowEvent("error.noresource",
               "subdialogs nested deeper than " + std::to_string(rt_.options.max_subdialogs));
  }
  struct Context {
    DialogSession& session;
    Position position = std::exchange(session.rt_.position, {});
    Scopes::Frame scopes = session.rt_.scopes.Exchange({});
    explicit Context(DialogSession& its) : session(its) { ++session.subdialogs_; }
    ~Context() {
      session.rt_.position = std::move(position);
      session.rt_.scopes.Exchange(std::move(scopes));
      --session.subdialogs_;
    }
  } const context(*this);
  rt_.position.in_subdialog = true;
  RunDialogs(std::move(start));
}

void DialogSession::RunDialogs(Transition next) {
  while (true) {
    try {
      rt_.position.dialog = nullptr;
      rt_.position.item = nullptr;
      rt_.position.element = nullptr;
      rt_.scopes.LeaveDialog();
      Enter(next);
      if (next.dialog) forms_.Run(next);
      return;
    } catch (Transition& transition) {
      next = std::move(transition);
    } catch (const EventThrown& event) {
      // Out of a handler of the document: nobody is left to handle it.
      throw ExitSession{event.name};
    }
  }
}

void DialogSession::Enter(const Transition& to) {
  JsonLine line;
  line.Text("document", to.document->uri)
      .Text("dialog", to.dialog ? to.dialog->Get("id") : "")
      .Bool("same_document", to.same_document);
  rt_.Trace("enter", line);
  if (!to.same_document || rt_.position.document != to.document) EnterDocument(to);
}

void DialogSession::EnterDocument(const Transition& to) {
  Position& at = rt_.position;
  // The application's variables stay while its root stays (VoiceXML 2.0 section 1.5.2).
  const bool stays = at.root && at.root->uri == to.root->uri && rt_.scopes.HasApplication() &&
                     !to.fresh_application && (at.document != at.root || to.document != to.root);
  if (!stays) {
    at.root = at.document = to.root;
    rt_.scopes.EnterApplication();
    InitDocument(*to.root);
  }
  at.document = to.document;
  const bool is_root = to.document == to.root;
  rt_.scopes.EnterDocument(is_root);
  if (!is_root) InitDocument(*to.document);
}

/// An event ends the initialisation, not the entering: the document's handler may go on from there.
void DialogSession::InitDocument(const VxmlDocument& document) {
  try {
    for (const auto& child : document.root->children) {
      if (ExecutableContent::IsInitial(*child)) content_.RunElement(*child);
    }
  } catch (const EventThrown& event) {
    events_.Handle(event, nullptr);
  }
}

}  // namespace vxml
