#include <charconv>

#include "task_manager/document/schema.h"
#include "task_manager/interpreter/dialog_session.h"
#include "task_manager/interpreter/languages.h"
#include "task_manager/interpreter/properties.h"

namespace vxml {

using script::Value;

std::optional<Millis> ParseTime(std::string_view text) {
  text = vm::xml::Trim(text);
  if (text.starts_with("+")) text.remove_prefix(1);
  double number = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  if (read.ec != std::errc() || number < 0 || number > 1e9) return {};
  const std::string_view unit(read.ptr,
                              static_cast<std::size_t>(text.data() + text.size() - read.ptr));
  if (unit == "s") return Millis(static_cast<long long>(number * 1000 + 0.5));
  if (unit == "ms") return Millis(static_cast<long long>(number + 0.5));
  return {};
}

void ThrowSemantic(const VxmlDocument& document, const vm::xml::Node& node,
                   const std::string& what) {
  ThrowEvent("error.semantic", document.uri + ":" + std::to_string(node.line) + ":" +
                                   std::to_string(node.column) + ": " + what);
}

void DialogSession::ThrowScript(const vm::xml::Node& node, const std::string& code,
                                const vm::Error& error) {
  if (error.code == vm::Errc::kLimit) ThrowEvent("error.noresource", code + ": " + error.text);
  ThrowSemantic(*context_->document, node, code + ": " + error.text);
}

script::Chain DialogSession::CurrentChain() const {
  script::Chain chain{context_->names, session_scope_, context_->application, context_->variables};
  if (dialog_) chain.push_back(dialog_->scope);
  chain.insert(chain.end(), anonymous_.begin(), anonymous_.end());
  return chain;
}

Value DialogSession::Evaluate(const vm::xml::Node& node, const std::string& expression) {
  auto value = engine_.Evaluate(CurrentChain(), expression);
  if (!value) ThrowScript(node, "'" + expression + "'", value.error());
  return *value;
}

bool DialogSession::Condition(const vm::xml::Node& node, const std::string& attribute) {
  const std::string* expression = node.Find(attribute);
  return !expression || engine_.ToBoolean(Evaluate(node, *expression));
}

std::string DialogSession::TextOf(const vm::xml::Node& node, const std::string& expression) {
  return engine_.ToString(Evaluate(node, expression));
}

/// Into the innermost scope, or the one named in front of a dot, which is not allowed.
void DialogSession::Declare(const vm::xml::Node& node, const std::string& name,
                            const Value& value) {
  if (!engine_.IsIdentifier(name)) {
    ThrowSemantic(*context_->document, node, "'" + name + "' cannot be declared");
  }
  const script::Chain chain = CurrentChain();
  engine_.Set(chain.back(), name, value);
}

void DialogSession::Store(const std::string& name, const Value& value) {
  engine_.Set(dialog_->scope, name, value);
}
Value DialogSession::Variable(const std::string& name) { return engine_.Get(dialog_->scope, name); }

/// Whether a plain or scope-prefixed variable exists; of longer paths the base is what counts.
bool DialogSession::IsDeclared(const std::string& name) {
  const std::size_t dot = name.find_first_of(".[ ");
  const std::string base = name.substr(0, dot);
  const script::Chain chain = CurrentChain();
  for (std::size_t i = chain.size(); i-- > 1;) {
    if (engine_.Has(chain[i], base)) return true;
  }
  if (!engine_.Has(chain[0], base)) return engine_.IsDeclared(chain, base);
  if (dot == std::string::npos) return true;
  const std::string rest = name.substr(dot + 1);
  return engine_.Has(engine_.Get(chain[0], base), rest.substr(0, rest.find_first_of(".[ ")));
}

const vm::xml::Node& DialogSession::Here() const {
  if (active_node_) return *active_node_;
  if (dialog_) return *dialog_->node;
  return *context_->document->root;
}

std::string DialogSession::Property(const std::string& name, const vm::xml::Node* from) {
  // Handlers act as if copied into the active item: its properties count, not those around them.
  const vm::xml::Node* node = scope_item_ ? scope_item_->node : dialog_ ? dialog_->node : nullptr;
  if (!node) node = from ? from : &Here();
  for (; node && context_; node = node->parent) {
    for (const auto& document : {context_->document, context_->root}) {
      const std::string* value = document ? document->FindProperty(*node, name) : nullptr;
      if (value) return *value;
    }
  }
  if (context_ && context_->root) {
    const std::string* value = context_->root->FindProperty(*context_->root->root, name);
    if (value) return *value;
  }
  const auto given = options_.properties.find(name);
  return given != options_.properties.end() ? given->second : DefaultProperty(name);
}

Millis DialogSession::TimeProperty(const std::string& name, Millis otherwise) {
  const std::string text = Property(name);
  if (text.empty()) return otherwise;
  const auto time = ParseTime(text);
  if (!time) {
    ThrowSemantic(*context_->document, Here(),
                  "property " + name + " '" + text + "', expected a time as 5s or 300ms");
  }
  return *time;
}

std::string DialogSession::LanguageAt(const vm::xml::Node& node) const {
  const std::string language = node.Inherited("xml:lang");
  if (!language.empty()) return language;
  if (context_->root) return context_->root->language;
  return "";
}

void DialogSession::RequireLanguage(const std::string& language) {
  if (language.empty() || IsSupported(language, options_.languages)) return;
  ThrowEvent("error.unsupported.language", "the language '" + language + "'");
}

void DialogSession::Step(std::size_t cost) {
  switch (budget_.Spend(cost)) {
    case Budget::Left::kEnough:
      return;
    case Budget::Left::kUsedUp:
      ThrowEvent("error.noresource", "more than " +
                                         std::to_string(options_.max_steps_between_inputs) +
                                         " elements executed or more than " +
                                         std::to_string(options_.max_time_between_inputs.count()) +
                                         " ms of the processor used without waiting for input");
    case Budget::Left::kNothing:
      throw ExitSession{"error.noresource"};  // its handlers run on and on as well
  }
}

void DialogSession::Trace(std::string_view kind, const JsonLine& fields) {
  if (options_.trace) options_.trace(kind, fields);
}

}  // namespace vxml
