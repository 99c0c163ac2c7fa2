#include <ranges>

#include "task_manager/document/schema.h"
#include "task_manager/fetch/uri.h"
#include "task_manager/interpreter/dialog_session.h"
#include "task_manager/interpreter/scope_guard.h"
#include "vm_protocol/core/charset.h"
#include "vm_protocol/core/utf8.h"
#include "vm_protocol/xml/parser.h"

namespace vxml {

using script::Value;

namespace {

constexpr std::size_t kMaxLogBytes = 8192;

/// Prompt markup that stands in executable content without its <prompt>.
bool IsSpeech(const vm::xml::Node& node) {
  static const ElementRule* const kPrompt = FindElementRule("prompt");
  return node.IsElement() && node.name != "foreach" && node.name != "native" &&
         Allows(*kPrompt, node.name);
}

}  // namespace

void DialogSession::RunContent(const vm::xml::Node& parent) {
  std::vector<const vm::xml::Node*> speech;
  const auto end_speech = [&] {
    bool something = false;
    for (const vm::xml::Node* node : speech) {
      something = something || node->IsElement() || !vm::xml::IsBlank(node->text);
    }
    if (something) QueueImplicit(speech);
    speech.clear();
  };
  for (const auto& child : parent.children) {
    if (child->IsText() || IsSpeech(*child)) {
      speech.push_back(child.get());
    } else if (child->IsElement()) {
      end_speech();
      RunElement(*child);
    }
  }
  end_speech();
}

void DialogSession::RunElement(const vm::xml::Node& node) {
  using Action = void (DialogSession::*)(const vm::xml::Node&);
  static const std::map<std::string_view, Action> kTable = {
      {"assign", &DialogSession::RunAssign}, {"clear", &DialogSession::RunClear},
      {"data", &DialogSession::RunData},     {"disconnect", &DialogSession::RunDisconnect},
      {"exit", &DialogSession::RunExit},     {"foreach", &DialogSession::RunForeach},
      {"goto", &DialogSession::RunGoto},     {"if", &DialogSession::RunIf},
      {"log", &DialogSession::RunLog},       {"native", &DialogSession::RunNative},
      {"return", &DialogSession::RunReturn}, {"script", &DialogSession::RunScript},
      {"submit", &DialogSession::RunSubmit}, {"throw", &DialogSession::RunThrow},
      {"var", &DialogSession::RunVar},
  };
  Step();
  const vm::xml::Node* before = std::exchange(active_node_, &node);
  if (node.name == "prompt") {
    if (Condition(node)) QueuePrompt(node);
  } else if (node.name == "reprompt") {
    if (in_handler_) reprompt_ = true;
  } else if (const auto found = kTable.find(node.name); found != kTable.end()) {
    (this->*found->second)(node);
  }
  active_node_ = before;
}

void DialogSession::RunIf(const vm::xml::Node& node) {
  bool done = false;
  bool active = Condition(node);
  done = active;
  std::vector<const vm::xml::Node*> speech;
  const auto end_speech = [&] {
    bool something = false;
    for (const vm::xml::Node* part : speech) {
      something = something || part->IsElement() || !vm::xml::IsBlank(part->text);
    }
    if (something) QueueImplicit(speech);
    speech.clear();
  };
  for (const auto& child : node.children) {
    if (child->IsElement("elseif") || child->IsElement("else")) {
      end_speech();
      active = !done && (child->name == "else" || Condition(*child));
      done = done || active;
    } else if (!active) {
      continue;
    } else if (child->IsText() || IsSpeech(*child)) {
      speech.push_back(child.get());
    } else if (child->IsElement()) {
      end_speech();
      RunElement(*child);
    }
  }
  end_speech();
}

void DialogSession::RunForeach(const vm::xml::Node& node) {
  const Value array = Evaluate(node, node.Get("array"));
  if (!engine_.IsArray(array)) {
    ThrowSemantic(*context_->document, node, "'" + node.Get("array") + "' is not an array");
  }
  if (engine_.Length(array) > options_.max_steps_between_inputs) {
    ThrowEvent("error.noresource",
               "<foreach> over " + std::to_string(engine_.Length(array)) + " elements");
  }
  const Value copy = engine_.Copy(array);  // changes inside do not change the turns
  const std::size_t length = engine_.Length(copy);
  const std::string item = node.Get("item");
  for (std::size_t i = 0; i < length; ++i) {
    Step();
    const Value element = engine_.Get(copy, std::to_string(i));
    if (!item.empty()) Declare(node, item, element);
    RunContent(node);
  }
}

void DialogSession::RunVar(const vm::xml::Node& node) {
  const std::string* expression = node.Find("expr");
  // Declared again in the same scope without a value it keeps the one it has (section 5.3.1).
  if (!expression && engine_.Has(CurrentChain().back(), node.Get("name"))) return;
  Declare(node, node.Get("name"), expression ? Evaluate(node, *expression) : engine_.Undefined());
}

void DialogSession::RunAssign(const vm::xml::Node& node) {
  const std::string name(vm::xml::Trim(node.Get("name")));
  const std::string* expression = node.Find("expr");
  const Value value = expression ? Evaluate(node, *expression) : engine_.Undefined();
  if (!IsDeclared(name)) {
    ThrowSemantic(*context_->document, node, "'" + name + "' was never declared");
  }
  if (name.starts_with("session.") ||
      (engine_.Has(session_scope_, name.substr(0, name.find_first_of(".["))) &&
       !IsDeclaredBeforeSession(name.substr(0, name.find_first_of(".["))))) {
    ThrowSemantic(*context_->document, node, "'" + name + "' of the session is read-only");
  }
  auto assigned = engine_.Assign(CurrentChain(), name, value);
  if (!assigned) {
    ThrowScript(node, "'" + name + "'", assigned.error());
  }
}

bool DialogSession::IsDeclaredBeforeSession(const std::string& base) {
  const script::Chain chain = CurrentChain();
  for (std::size_t i = chain.size(); i-- > 2;) {
    if (engine_.Has(chain[i], base)) return true;
  }
  return false;
}

void DialogSession::RunClear(const vm::xml::Node& node) {
  const std::string namelist = node.Get("namelist");
  const auto names = SplitWords(namelist);
  if (names.empty()) {
    for (Item& item : dialog_->items) {
      Store(item.name, engine_.Undefined());
      item.prompt_count = 1;
      item.events.clear();
      item.over = false;
    }
  }
  for (const std::string_view word : names) {
    const std::string name(word);
    if (!IsDeclared(name)) {
      ThrowSemantic(*context_->document, node, "'" + name + "' was never declared");
    }
    static_cast<void>(engine_.Assign(CurrentChain(), name, engine_.Undefined()));
    for (Item& item : dialog_->items) {
      if (item.name != name && "dialog." + item.name != name) continue;
      item.prompt_count = 1;
      item.events.clear();
    }
  }
}

void DialogSession::RunScript(const vm::xml::Node& node) {
  std::string source = node.Get("src");
  if (const std::string* expression = node.Find("srcexpr")) source = TextOf(node, *expression);
  std::string text = node.Text();
  if (!source.empty()) {
    fetch::Request request = FetchOptions(node, "script");
    request.uri = fetch::Resolve(BaseOf(node), source);
    const fetch::Response got = FetchFor(node, request, "script");
    text = got.body;
    std::string charset = got.charset.empty() ? node.Get("charset") : got.charset;
    for (char& c : charset) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
    if (!charset.empty() && charset != "utf-8") {
      auto utf8 = vm::DecodeCharset(text, charset);
      if (!utf8) ThrowEvent("error.badfetch", request.uri + ": " + utf8.error().text);
      text = *utf8;
    }
  }
  auto ran = engine_.Run(CurrentChain(), text);
  if (!ran) ThrowScript(node, "script", ran.error());
}

void DialogSession::RunLog(const vm::xml::Node& node) {
  std::string text;
  for (const auto& child : node.children) {
    if (child->IsText()) text += child->text;
    if (child->IsElement("value")) text += TextOf(*child, child->Get("expr"));
  }
  text = vm::xml::Collapse(text);
  if (const std::string* expression = node.Find("expr")) {
    const std::string value = TextOf(node, *expression);
    text += (text.empty() || value.empty() ? "" : " ") + value;
  }
  text = vm::CutUtf8(text, kMaxLogBytes);
  Step(text.size() / kBytesOfAStep);
  JsonLine line;
  line.Text("label", node.Get("label")).Text("text", text);
  platform_.Report("log", line);
}

void DialogSession::RunThrow(const vm::xml::Node& node) {
  EventThrown event;
  event.name = node.Get("event");
  if (const std::string* expression = node.Find("eventexpr"))
    event.name = TextOf(node, *expression);
  if (const std::string* message = node.Find("message")) {
    event.message = *message;
    event.has_message = true;
  }
  if (const std::string* expression = node.Find("messageexpr")) {
    event.message = TextOf(node, *expression);
    event.has_message = true;
  }
  throw event;
}

/// The lines of the module protocol that a <native> holds.
std::vector<std::string> DialogSession::NativeLines(const vm::xml::Node& node) {
  RequireLocal(node);
  std::string text;
  if (const std::string* expression = node.Find("expr")) {
    text = TextOf(node, *expression);
  } else {
    for (const auto& child : node.children) {
      if (child->IsText()) text += child->text;
      if (child->IsElement("value")) text += TextOf(*child, child->Get("expr"));
    }
  }
  Step(text.size() / kBytesOfAStep);
  std::vector<std::string> lines;
  for (const auto& line : std::views::split(text, '\n')) {
    std::string plain = vm::xml::Collapse(std::string_view(line.begin(), line.end()));
    if (!plain.empty()) lines.push_back(std::move(plain));
  }
  return lines;
}

/// <native>: commands of the author's own, in their place among the words.
void DialogSession::RunNative(const vm::xml::Node& node) {
  Prompt prompt;
  for (const std::string& line : NativeLines(node)) {
    prompt.segments.push_back({Segment::Kind::kCommand, line, Millis(0), "", false, ""});
    prompt.segments.back().native = true;
  }
  prompt.language = LanguageAt(node);
  prompt.ssml = "<speak version=\"1.0\"/>";
  queue_.push_back(std::move(prompt));
}

}  // namespace vxml
