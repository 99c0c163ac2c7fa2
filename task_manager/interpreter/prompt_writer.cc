#include "task_manager/interpreter/prompt_writer.h"

#include <algorithm>
#include <ranges>

#include "task_manager/document/schema.h"
#include "task_manager/document/values.h"
#include "task_manager/interpreter/prompt_builder.h"

namespace vxml {

void PromptWriter::Write(Prompt prompt, const std::vector<const vm::xml::Node*>& nodes) {
  rt_.RequireLanguage(prompt.language);
  PromptBuilder builder(rt_, documents_, prompt);
  for (const vm::xml::Node* node : nodes) builder.Add(*node);
  builder.Finish();
  queue_.Add(std::move(prompt));
}

void PromptWriter::Queue(const vm::xml::Node& node) {
  if (!rt_.connection.is_open()) return;
  Prompt prompt;
  prompt.language = rt_.position.LanguageAt(node);
  prompt.bargein = node.Get("bargein", rt_.properties.Get("bargein", &node)) != "false";
  prompt.hotword = node.Get("bargeintype", rt_.properties.Get("bargeintype", &node)) == "hotword";
  if (const std::string* timeout = node.Find("timeout")) {
    prompt.timeout = ParseTime(*timeout);
    if (!prompt.timeout) {
      rt_.position.ThrowSemantic(node, "timeout '" + *timeout + "' is no time");
    }
  }
  Write(std::move(prompt), {&node});
}

void PromptWriter::QueueLoose(const std::vector<const vm::xml::Node*>& nodes) {
  const bool silent = std::ranges::all_of(nodes, [](const vm::xml::Node* node) {
    return !node->IsElement() && vm::xml::IsBlank(node->text);
  });
  if (silent || !rt_.connection.is_open()) return;
  Prompt prompt;
  prompt.language = rt_.position.LanguageAt(*nodes.front()->parent);
  prompt.bargein = !rt_.properties.Is("bargein", "false");
  prompt.hotword = rt_.properties.Is("bargeintype", "hotword");
  Write(std::move(prompt), nodes);
}

void PromptWriter::QueueNative(const vm::xml::Node& native) {
  Prompt prompt;
  for (const std::string& line : NativeLines(rt_, native)) {
    prompt.segments.push_back({Segment::Kind::kCommand, line, Millis(0), "", false, ""});
    prompt.segments.back().native = true;
  }
  prompt.language = rt_.position.LanguageAt(native);
  prompt.ssml = "<speak version=\"1.0\"/>";
  queue_.AddCommands(std::move(prompt));
}

void PromptWriter::QueueWords(const std::string& text, const std::string& language) {
  Prompt prompt;
  prompt.language = language;
  prompt.text = text;
  prompt.segments.push_back({Segment::Kind::kText, text, Millis(0), language, false, ""});
  prompt.ssml = "<speak version=\"1.0\">" + vm::xml::Escape(text) + "</speak>";
  queue_.Add(std::move(prompt));
}

bool IsLooseSpeech(const vm::xml::Node& node) {
  static const ElementRule* const kPrompt = FindElementRule("prompt");
  return node.IsText() || (node.IsElement() && Allows(*kPrompt, node.name));
}

std::vector<std::string> NativeLines(Runtime& runtime, const vm::xml::Node& native) {
  runtime.position.RequireLocal(native);
  const std::string* expression = native.Find("expr");
  const std::string text =
      expression ? runtime.scopes.Text(native, *expression) : runtime.scopes.ContentText(native);
  runtime.budget.StepForBytes(text.size());
  std::vector<std::string> lines;
  for (const auto& line : std::views::split(text, '\n')) {
    std::string plain = vm::xml::Collapse(std::string_view(line.begin(), line.end()));
    if (!plain.empty()) lines.push_back(std::move(plain));
  }
  return lines;
}

}  // namespace vxml
