#include "task_manager/interpreter/scopes.h"

#include <algorithm>
#include <ranges>

namespace vxml {

using script::Value;

void Scopes::MakeSession(const std::map<std::string, std::string>& variables) {
  session_ = engine_.NewScope();
  for (const auto& [path, text] : variables) {
    Value at = session_;
    std::size_t from = 0;
    for (std::size_t dot; (dot = path.find('.', from)) != std::string::npos; from = dot + 1) {
      const std::string part = path.substr(from, dot - from);
      if (!engine_.Has(at, part)) engine_.Set(at, part, engine_.Object());
      at = engine_.Get(at, part);
    }
    engine_.Set(at, path.substr(from), engine_.String(text));
  }
  const Value connection = engine_.Get(session_, "connection");
  if (engine_.ToString(engine_.Get(connection, "originator")) == "connection.remote") {
    engine_.Set(connection, "originator", engine_.Get(connection, "remote"));
  }
  if (engine_.ToString(engine_.Get(connection, "redirect")).empty()) {
    engine_.Set(connection, "redirect", engine_.Undefined());
  }
  engine_.Freeze(connection);
  engine_.Freeze(session_);
}

void Scopes::EnterApplication() {
  frame_.names = engine_.NewScope();
  frame_.application = engine_.NewScope();
  engine_.SetReadOnly(frame_.names, "session", session_);
  engine_.SetReadOnly(frame_.names, "application", frame_.application);
  EnterDocument(true);
}

void Scopes::EnterDocument(bool is_root) {
  frame_.document = is_root ? frame_.application : engine_.NewScope();
  engine_.Set(frame_.names, "document", frame_.document);
}

void Scopes::EnterDialog() {
  frame_.dialog = engine_.NewScope();
  engine_.Set(frame_.names, "dialog", frame_.dialog);
}

void Scopes::LeaveDialog() {
  frame_.dialog = Value();
  LeaveBlocks();
}

script::Chain Scopes::Chain() const {
  script::Chain chain{frame_.names, session_, frame_.application, frame_.document};
  if (frame_.dialog.valid()) chain.push_back(frame_.dialog);
  chain.insert(chain.end(), frame_.blocks.begin(), frame_.blocks.end());
  return chain;
}

void Scopes::Throw(const vm::xml::Node& node, const std::string& what,
                   const vm::Error& error) const {
  if (error.code == vm::Errc::kLimit) ThrowEvent("error.noresource", what + ": " + error.text);
  position_.ThrowSemantic(node, what + ": " + error.text);
}

Value Scopes::Evaluate(const vm::xml::Node& node, const std::string& expression) {
  budget_.Step(0);
  auto value = engine_.Evaluate(Chain(), expression);
  if (!value) Throw(node, "'" + expression + "'", value.error());
  return *value;
}

bool Scopes::Condition(const vm::xml::Node& node, const std::string& attribute) {
  const std::string* expression = node.Find(attribute);
  return !expression || engine_.ToBoolean(Evaluate(node, *expression));
}

std::string Scopes::Text(const vm::xml::Node& node, const std::string& expression) {
  auto text = engine_.Text(Evaluate(node, expression));
  if (!text) Throw(node, "'" + expression + "'", text.error());
  return *text;
}

std::string Scopes::Text(const vm::xml::Node& node, const char* attribute, const char* twin) {
  const std::string* expression = node.Find(twin);
  return expression ? Text(node, *expression) : node.Get(attribute);
}

std::string Scopes::ContentText(const vm::xml::Node& node) {
  std::string text;
  for (const auto& child : node.children) {
    if (child->IsText()) text += child->text;
    if (child->IsElement("value")) text += Text(*child, child->Get("expr"));
  }
  return text;
}

EventThrown Scopes::Event(const vm::xml::Node& node) {
  EventThrown event{Text(node, "event", "eventexpr"), "", false};
  if (event.name.size() > kMaxEventName) {
    position_.ThrowSemantic(node, "an event's name of " + std::to_string(event.name.size()) +
                                      " bytes, at most " + std::to_string(kMaxEventName));
  }
  event.has_message = node.Has("message") || node.Has("messageexpr");
  // Of these two the plain one wins.
  event.message = node.Has("message") ? node.Get("message") : Text(node, "message", "messageexpr");
  return event;
}

void Scopes::Run(const vm::xml::Node& node, const std::string& script) {
  auto ran = engine_.Run(Chain(), script);
  if (!ran) Throw(node, "script", ran.error());
}

void Scopes::RequireIdentifier(const vm::xml::Node& node, const std::string& name) {
  if (engine_.IsIdentifier(name)) return;
  position_.ThrowSemantic(node, "'" + name + "' cannot be declared");
}

void Scopes::Declare(const vm::xml::Node& node, const std::string& name, const Value& value) {
  RequireIdentifier(node, name);
  engine_.Set(Chain().back(), name, value);
}

bool Scopes::IsDeclaredInnermost(const std::string& name) {
  return engine_.Has(Chain().back(), name);
}

/// Whether a plain or scope-prefixed variable exists; of longer paths the base is what counts.
bool Scopes::IsDeclared(const std::string& name) {
  const std::size_t dot = name.find_first_of(".[ ");
  const std::string base = name.substr(0, dot);
  const script::Chain chain = Chain();
  for (const Value& scope : chain | std::views::drop(1)) {
    if (engine_.Has(scope, base)) return true;
  }
  if (!engine_.Has(frame_.names, base)) return engine_.IsDeclared(chain, base);
  if (dot == std::string::npos) return true;
  const std::string rest = name.substr(dot + 1);
  return engine_.Has(engine_.Get(frame_.names, base), rest.substr(0, rest.find_first_of(".[ ")));
}

void Scopes::RequireDeclared(const vm::xml::Node& node, const std::string& name) {
  if (!IsDeclared(name)) position_.ThrowSemantic(node, "'" + name + "' was never declared");
}

/// Whether the name means a variable of the session that no inner scope hides.
bool Scopes::IsOfSession(const std::string& name) {
  if (name.starts_with("session.")) return true;
  const std::string base = name.substr(0, name.find_first_of(".["));
  const script::Chain chain = Chain();
  return engine_.Has(session_, base) &&
         std::ranges::none_of(chain | std::views::drop(2),
                              [&](const Value& scope) { return engine_.Has(scope, base); });
}

void Scopes::Assign(const vm::xml::Node& node, const std::string& name, const Value& value) {
  RequireDeclared(node, name);
  if (IsOfSession(name)) {
    position_.ThrowSemantic(node, "'" + name + "' of the session is read-only");
  }
  auto assigned = engine_.Assign(Chain(), name, value);
  if (!assigned) Throw(node, "'" + name + "'", assigned.error());
}

void Scopes::Clear(const vm::xml::Node& node, const std::string& name) {
  RequireDeclared(node, name);
  static_cast<void>(engine_.Assign(Chain(), name, engine_.Undefined()));
}

void Scopes::DeclareItem(const vm::xml::Node& node, const std::string& name, const Value& value) {
  RequireIdentifier(node, name);
  engine_.SetWatched(frame_.dialog, name, value);
}

void Scopes::Store(const std::string& name, const Value& value) {
  engine_.Set(frame_.dialog, name, value);
}

Value Scopes::Get(const std::string& name) const { return engine_.Get(frame_.dialog, name); }

void Scopes::SetLastResult(const Value& result) {
  engine_.Set(frame_.application, "lastresult$", result);
}

Value Scopes::last_result() const { return engine_.Get(frame_.application, "lastresult$"); }

}  // namespace vxml
