#include "task_manager/interpreter/prompt_builder.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "task_manager/document/values.h"
#include "task_manager/fetch/uri.h"
#include "task_manager/grammar/text.h"
#include "task_manager/interpreter/choices.h"
#include "task_manager/interpreter/prompt_writer.h"
#include "vm_protocol/core/utf8.h"

namespace vxml {

using script::Value;

void PromptBuilder::Add(const vm::xml::Node& node) {
  if (node.IsText()) return Words(node.text);
  if (!node.IsElement()) return;
  rt_.budget.Step();
  const std::string& name = node.name;
  if (name == "prompt") return AddChildren(node);
  if (name == "value") {
    const Value value = rt_.scopes.Evaluate(node, node.Get("expr"));
    return IsRecording(rt_.engine, value) ? Audio(node, value) : Words(rt_.engine.ToString(value));
  }
  if (name == "audio") return Audio(node);
  if (name == "enumerate") return Enumerate(node);
  if (name == "foreach") return Foreach(node);
  if (name == "break") return Pause(node);
  if (name == "mark" || name == "sync") return Mark(node);
  if (name == "emotion") return Emotion(node);
  if (name == "native") {
    for (const std::string& line : NativeLines(rt_, node)) {
      Command(line, Millis(0), false);
      prompt_.segments.back().native = true;
    }
    return;
  }
  if (name == "media") return Media(node);
  if (IsBehaviour(name)) return Behaviour(node);
  if (name == "desc" || name == "meta" || name == "metadata" || name == "lexicon" ||
      name == "category" || name == "dimension" || name == "intensity" || name == "lookup") {
    return;
  }
  if (const std::string* language = node.Find("xml:lang")) rt_.RequireLanguage(*language);
  Speech(node);
}

void PromptBuilder::Finish() {
  EndWords();
  PlaceDeferred();
  prompt_.text = vm::xml::Collapse(prompt_.text);
  std::string head = "<speak version=\"1.0\" xmlns=\"http://www.w3.org/2001/10/synthesis\"";
  if (!prompt_.language.empty()) head += " xml:lang=\"" + vm::xml::Escape(prompt_.language) + "\"";
  prompt_.ssml = head + ">" + ssml_ + "</speak>";
}

void PromptBuilder::AddChildren(const vm::xml::Node& node) {
  for (const auto& child : node.children) Add(*child);
}

void PromptBuilder::Words(const std::string& text) {
  if (text.empty()) return;
  rt_.budget.StepForBytes(text.size());
  if (std::exchange(at_edge_, false)) PartWords(text);
  words_ += text;
  prompt_.text += text;
  ssml_ += vm::xml::Escape(text);
}

void PromptBuilder::PartWords(const std::string& next) {
  const auto is_word = [](std::string_view text, std::size_t at) {
    const char32_t sign = vm::SignAt(text, at).value;
    return sign < 0x80 ? std::isalnum(static_cast<int>(sign)) != 0 : !srgs::IsUnspaced(sign);
  };
  if (prompt_.text.empty() || next.empty()) return;
  std::size_t last = prompt_.text.size() - 1;
  while (last > 0 && !vm::BeginsSign(prompt_.text[last])) --last;
  if (!is_word(prompt_.text, last) || !is_word(next, 0)) return;
  words_ += ' ';
  prompt_.text += ' ';
}

void PromptBuilder::EndWords() {
  const std::string text = vm::xml::Collapse(words_);
  words_.clear();
  if (text.empty()) return;
  Segment segment;
  segment.text = text;
  segment.language = prompt_.language;
  if (rt_.properties.Is("emotionspeak", "true")) {
    const auto felt = std::find_if(feelings_.rbegin(), feelings_.rend(),
                                   [](const Feeling& it) { return it.in_voice; });
    if (felt != feelings_.rend()) segment.emotion = felt->type;
  }
  prompt_.segments.push_back(std::move(segment));
}

void PromptBuilder::Command(const std::string& line, Millis wait, bool parallel) {
  EndWords();
  prompt_.segments.push_back({Segment::Kind::kCommand, line, wait, "", parallel, ""});
}

/// SSML passes through; of <sub> the words are its alias.
void PromptBuilder::Speech(const vm::xml::Node& node) {
  std::string open = "<" + node.name;
  for (const vm::xml::Attribute& attribute : node.attributes) {
    open += " " + attribute.name + "=\"" + vm::xml::Escape(attribute.value) + "\"";
  }
  ssml_ += open + ">";
  at_edge_ = true;
  const std::string id = node.Get("id");
  if (!id.empty()) Anchor(id + ":start");
  const bool block =
      node.name == "p" || node.name == "s" || node.name == "sentence" || node.name == "paragraph";
  if (block) prompt_.text += " ";
  if (node.name == "sub" && node.Has("alias")) {
    const std::string before = ssml_;
    Words(node.Get("alias"));
    ssml_ = before + vm::xml::Escape(node.Text());
  } else {
    const std::string outer = std::exchange(speech_, id.empty() ? speech_ : id);
    AddChildren(node);
    speech_ = outer;
  }
  if (block) {
    EndWords();
    prompt_.text += " ";
  }
  ssml_ += "</" + node.name + ">";
  at_edge_ = true;
  if (!id.empty()) Anchor(id + ":end");
}

void PromptBuilder::Audio(const vm::xml::Node& node) {
  if (const std::string* expression = node.Find("expr")) {
    const Value value = rt_.scopes.Evaluate(node, *expression);
    if (rt_.engine.IsUndefined(value)) return;  // section 4.1.3: nothing at all
    return Audio(node, value);
  }
  Audio(node, node.Get("src"));
}

void PromptBuilder::Audio(const vm::xml::Node& node, const Value& value) {
  if (!rt_.engine.IsObject(value)) return Audio(node, rt_.engine.ToString(value));
  const std::string uri = rt_.engine.ToString(rt_.engine.Get(value, "uri"));
  Audio(node, uri.empty() ? "recording:" : uri);
}

void PromptBuilder::Audio(const vm::xml::Node& node, const std::string& source) {
  if (source.empty()) return AddChildren(node);
  const std::string uri =
      source.starts_with("recording:") ? source : fetch::Resolve(rt_.position.BaseOf(node), source);
  std::shared_ptr<const std::string> sound;
  if (!Exists(node, uri, sound)) return AddChildren(node);
  EndWords();
  prompt_.segments.push_back({Segment::Kind::kAudio, uri, Millis(0), "", false, "", sound});
  ssml_ += "<audio src=\"" + vm::xml::Escape(uri) + "\"/>";
}

bool PromptBuilder::Exists(const vm::xml::Node& node, const std::string& uri,
                           std::shared_ptr<const std::string>& sound) {
  if (uri.starts_with("recording:") || uri.starts_with("builtin:")) return true;
  fetch::Request request = documents_.RequestFor(node, "audio");
  request.uri = uri;
  auto got = documents_.FetchSilently(request, "audio");
  if (got && !uri.starts_with("file:")) {
    sound = std::make_shared<const std::string>(std::move(got->body));
  }
  return got.has_value();
}

/// The choices of the menu or the options of the field, with their keys.
void PromptBuilder::Enumerate(const vm::xml::Node& node) {
  const vm::xml::Node* owner = rt_.position.item ? rt_.position.item->node : nullptr;
  const bool known =
      owner && (owner->name == "menu" || (owner->name == "field" && owner->FirstElement("option")));
  if (!known) rt_.position.ThrowSemantic(node, "<enumerate> without choices or options");
  const bool own_template = std::ranges::any_of(node.children, [](const auto& child) {
    return child->IsElement() || !vm::xml::IsBlank(child->text);
  });
  for (const Choice& choice : ChoicesOf(*owner)) {
    if (!own_template) {
      Words(" " + choice.phrase + (choice.keys.empty() ? "" : ", " + choice.keys) + ";");
      continue;
    }
    Scopes::Block block(rt_.scopes);
    block.Set("_prompt", rt_.engine.String(choice.phrase));
    block.Set("_dtmf", rt_.engine.String(choice.keys));
    AddChildren(node);
  }
}

void PromptBuilder::Foreach(const vm::xml::Node& node) {
  const Value array = rt_.ArrayOf(node);
  const std::string item = node.Get("item");
  const std::size_t length = rt_.engine.Length(array);
  const Scopes::Block block(rt_.scopes);
  for (std::size_t i = 0; i < length; ++i) {
    rt_.budget.Step();
    if (!item.empty()) {
      rt_.scopes.Declare(node, item, rt_.engine.Get(array, std::to_string(i)));
    }
    AddChildren(node);
  }
}

void PromptBuilder::Pause(const vm::xml::Node& node) {
  static const std::map<std::string, int> kStrengths = {
      {"none", 0},     {"x-weak", 100},    {"weak", 200},  {"medium", 400},
      {"strong", 700}, {"x-strong", 1000}, {"small", 200}, {"large", 1000}};
  Millis time(500);
  const std::string strength = node.Get("strength", node.Get("size"));
  if (const auto found = kStrengths.find(strength); found != kStrengths.end()) {
    time = Millis(found->second);
  }
  if (const auto given = ParseTime(node.Get("time"))) time = *given;
  EndWords();
  prompt_.segments.push_back({Segment::Kind::kPause, "", time, "", false, ""});
  prompt_.text += " ";
  ssml_ += "<break time=\"" + std::to_string(time.count()) + "ms\"/>";
}

void PromptBuilder::Mark(const vm::xml::Node& node) {
  const std::string name = rt_.scopes.Text(node, node.Has("name") ? "name" : "id", "nameexpr");
  Anchor(name);
  if (!speech_.empty()) Anchor(speech_ + ":" + name);
  prompt_.segments.push_back({Segment::Kind::kMark, name, Millis(0), "", false, ""});
  ssml_ += "<mark name=\"" + vm::xml::Escape(name) + "\"/>";
}

}  // namespace vxml
