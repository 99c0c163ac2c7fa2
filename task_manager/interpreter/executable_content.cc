#include "task_manager/interpreter/executable_content.h"

#include <map>
#include <string_view>
#include <utility>

#include "task_manager/document/schema.h"
#include "vm_protocol/core/charset.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/utf8.h"

namespace vxml {

using script::Value;

namespace {

constexpr std::size_t kMaxLogBytes = 8192;

/// Prompt markup; <foreach> and <native> are executable content themselves.
bool IsSpeech(const vm::xml::Node& node) {
  return !node.IsElement("foreach") && !node.IsElement("native") && IsLooseSpeech(node);
}

}  // namespace

void ExecutableContent::RunInside(const vm::xml::Node& parent) {
  Nodes nodes;
  for (const auto& child : parent.children) nodes.push_back(child.get());
  Run(nodes);
}

void ExecutableContent::RunBlock(const vm::xml::Node& parent) {
  rt_.position.element = &parent;
  const Scopes::Block block(rt_.scopes);
  RunInside(parent);
}

bool ExecutableContent::RunHandler(const vm::xml::Node& handler) {
  struct Restore {
    bool& flag;
    bool outer;
    ~Restore() { flag = outer; }
  } const restore{in_handler_, std::exchange(in_handler_, true)};
  reprompt_ = false;
  rt_.position.element = &handler;
  try {
    RunInside(handler);
  } catch (const GoToItem& to) {
    rt_.position.dialog->next_item = to.name;
  }
  return std::exchange(reprompt_, false);
}

void ExecutableContent::Run(const Nodes& nodes) {
  Nodes speech;
  for (const vm::xml::Node* node : nodes) {
    if (IsSpeech(*node)) {
      speech.push_back(node);
    } else if (node->IsElement()) {
      prompts_.QueueLoose(std::exchange(speech, {}));
      RunElement(*node);
    }
  }
  prompts_.QueueLoose(speech);
}

void ExecutableContent::RunElement(const vm::xml::Node& node) {
  using Self = ExecutableContent;
  static const std::map<std::string_view, void (Self::*)(const vm::xml::Node&)> kTable = {
      {"assign", &Self::RunAssign}, {"clear", &Self::RunClear},
      {"data", &Self::RunData},     {"disconnect", &Self::RunDisconnect},
      {"exit", &Self::RunExit},     {"foreach", &Self::RunForeach},
      {"goto", &Self::RunGoto},     {"if", &Self::RunIf},
      {"log", &Self::RunLog},       {"native", &Self::RunNative},
      {"prompt", &Self::RunPrompt}, {"reprompt", &Self::RunReprompt},
      {"return", &Self::RunReturn}, {"script", &Self::RunScript},
      {"submit", &Self::RunSubmit}, {"throw", &Self::RunThrow},
      {"var", &Self::RunVar},
  };
  rt_.budget.Step();
  const vm::xml::Node* outer = std::exchange(rt_.position.element, &node);
  if (const auto found = kTable.find(node.name); found != kTable.end()) {
    (this->*found->second)(node);
  }
  rt_.position.element = outer;
}

void ExecutableContent::RunPrompt(const vm::xml::Node& node) {
  if (rt_.scopes.Condition(node)) prompts_.Queue(node);
}

void ExecutableContent::RunReprompt(const vm::xml::Node&) { reprompt_ = in_handler_; }

void ExecutableContent::RunNative(const vm::xml::Node& node) { prompts_.QueueNative(node); }

void ExecutableContent::RunIf(const vm::xml::Node& node) {
  bool taken = rt_.scopes.Condition(node);
  Nodes branch;
  for (const auto& child : node.children) {
    if (child->IsElement("elseif") || child->IsElement("else")) {
      if (taken) break;
      taken = child->name == "else" || rt_.scopes.Condition(*child);
    } else if (taken) {
      branch.push_back(child.get());
    }
  }
  Run(branch);
}

void ExecutableContent::RunForeach(const vm::xml::Node& node) {
  const Value array = rt_.ArrayOf(node);
  const std::size_t length = rt_.engine.Length(array);
  const std::string item = node.Get("item");
  for (std::size_t i = 0; i < length; ++i) {
    rt_.budget.Step();
    if (!item.empty()) {
      rt_.scopes.Declare(node, item, rt_.engine.Get(array, std::to_string(i)));
    }
    RunInside(node);
  }
}

void ExecutableContent::RunVar(const vm::xml::Node& node) {
  const std::string name = node.Get("name");
  const std::string* expression = node.Find("expr");
  // Declared again in the same scope without a value it keeps the one it has (section 5.3.1).
  if (!expression && rt_.scopes.IsDeclaredInnermost(name)) return;
  rt_.scopes.Declare(node, name,
                     expression ? rt_.scopes.Evaluate(node, *expression) : rt_.engine.Undefined());
}

void ExecutableContent::RunAssign(const vm::xml::Node& node) {
  const std::string* expression = node.Find("expr");
  const Value value = expression ? rt_.scopes.Evaluate(node, *expression) : rt_.engine.Undefined();
  rt_.scopes.Assign(node, std::string(vm::xml::Trim(node.Get("name"))), value);
}

void ExecutableContent::RunClear(const vm::xml::Node& node) {
  std::vector<FormItem> none;  // while a document is initialised
  auto& items = rt_.position.dialog ? rt_.position.dialog->items : none;
  const std::string namelist = node.Get("namelist");
  const auto names = SplitWords(namelist);
  if (names.empty()) {
    for (FormItem& item : items) {
      rt_.scopes.Store(item.name, rt_.engine.Undefined());
      item.ResetCounters();
      item.over = false;
    }
  }
  for (const std::string_view word : names) {
    const std::string name(word);
    rt_.budget.Step();
    rt_.scopes.Clear(node, name);
    for (FormItem& item : items) {
      if (item.name == name || "dialog." + item.name == name) item.ResetCounters();
    }
  }
}

void ExecutableContent::RunScript(const vm::xml::Node& node) {
  const std::string source = rt_.scopes.Text(node, "src", "srcexpr");
  if (source.empty()) return rt_.scopes.Run(node, node.Text());
  fetch::Request request = documents_.RequestFor(node, "script");
  request.uri = fetch::Resolve(rt_.position.BaseOf(node), source);
  const fetch::Response got = documents_.Fetch(node, request, "script");
  const std::string charset =
      vm::LowerCase(got.charset.empty() ? node.Get("charset") : got.charset);
  if (charset.empty() || charset == "utf-8") return rt_.scopes.Run(node, got.body);
  auto text = vm::DecodeCharset(got.body, charset);
  if (!text) ThrowEvent("error.badfetch", request.uri + ": " + text.error().text);
  rt_.scopes.Run(node, *text);
}

void ExecutableContent::RunLog(const vm::xml::Node& node) {
  std::string text = vm::xml::Collapse(rt_.scopes.ContentText(node));
  if (const std::string* expression = node.Find("expr")) {
    const std::string value = rt_.scopes.Text(node, *expression);
    text += (text.empty() || value.empty() ? "" : " ") + value;
  }
  text = vm::CutUtf8(text, kMaxLogBytes);
  rt_.budget.StepForBytes(text.size());
  JsonLine line;
  line.Text("label", node.Get("label")).Text("text", text);
  rt_.platform.Report("log", line);
}

}  // namespace vxml
